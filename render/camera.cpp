#include "render/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sherd {
namespace {

using Rows = std::array<std::array<Real, 4>, 4>;

Matrix4 column_major(const Rows& rows) {
  Matrix4 m{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) m[4 * j + i] = static_cast<float>(rows[i][j]);
  return m;
}

Mat3 rows(const Vec3& a, const Vec3& b, const Vec3& c) {
  return transpose(Mat3::from_columns(a, b, c));
}

}  // namespace

Camera make_camera(const View& view) {
  Camera camera;
  camera.eye = view.eye - view.target;
  camera.distance = norm(camera.eye);
  const Vec3 back = camera.eye / camera.distance;
  Vec3 right = cross(normalized(view.up), back);
  // Below this sine the cross product of two unit vectors has lost half its digits.
  if (norm(right) < 1e-8) right = any_perpendicular(back);
  right = normalized(right);
  camera.axes = rows(right, cross(back, right), back);
  camera.tan_half = std::tan(0.5 * view.field_of_view * std::numbers::pi / 180);
  camera.near = 0.01 * camera.distance;
  camera.far = 100 * camera.distance;

  const Real f = 1 / camera.tan_half, aspect = static_cast<Real>(view.width) / view.height;
  const Real depth = camera.near - camera.far;
  const Vec3 shift = camera.axes * camera.eye;
  Rows m{};
  for (int j = 0; j < 4; ++j) {
    const auto r = [&](int i) { return j < 3 ? camera.axes[i][j] : -shift[i]; };
    const auto c = static_cast<std::size_t>(j);
    m[0][c] = f / aspect * r(0);
    m[1][c] = f * r(1);
    m[2][c] = (camera.near + camera.far) / depth * r(2) + (j == 3 ? 2 * camera.near * camera.far / depth : 0);
    m[3][c] = -r(2);
  }
  camera.view_projection = column_major(m);
  return camera;
}

Sun make_sun(const Vec3& light, const std::array<Vec3, 8>* casters, std::size_t count, Real largest, int texels) {
  Sun sun;
  sun.direction = normalized(light);
  const Vec3 right = any_perpendicular(sun.direction);
  sun.axes = rows(right, cross(sun.direction, right), sun.direction);
  Box box;
  for (std::size_t i = 0; i < count; ++i)
    for (const Vec3& corner : casters[i]) box.grow(sun.axes * corner);
  const Vec3 limit{largest, largest, largest};
  box.low = max(box.low, -limit), box.high = min(box.high, limit);

  const Vec3 size = max(box.high - box.low, Vec3{});
  // Powers of 2^(1/4): the map changes its scale rarely, and is at most 19 % wider than needed. One part in fifty is
  // margin for the filter.
  const Real needed = std::max({1.02 * size.x, 1.02 * size.y, 1e-6 * largest});
  sun.width = std::exp2(std::ceil(4 * std::log2(needed)) / 4);
  sun.depth = std::max(1.02 * size.z, 1e-3 * sun.width);
  const Real step = sun.width / texels;
  const Vec3 centre{std::round(box.centre().x / step) * step, std::round(box.centre().y / step) * step, box.centre().z};
  Rows m{};
  const Real scale[3] = {2 / sun.width, 2 / sun.width, -2 / sun.depth};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) m[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = scale[i] * sun.axes[i][j];
    m[static_cast<std::size_t>(i)][3] = -scale[i] * centre[i];
  }
  m[3][3] = 1;
  sun.clip = column_major(m);
  return sun;
}

}  // namespace sherd
