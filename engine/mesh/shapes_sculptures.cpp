#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/mesh/shapes.h"
#include "engine/mesh/shapes_revolve.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

constexpr Real kPi = std::numbers::pi;

}  // namespace

SurfaceMesh make_figurine(Real height, Real edge) {
  require_size("figurine", "height", height), require_size("figurine", "edge", edge);
  require_affordable("figurine", 3 * height * height, edge);
  const Real h = height, e = std::min(edge, 0.06 * h);
  const ProfilePoint head{0, 0.84 * h};
  const Real radius = 0.16 * h, sleeve = 0.24 * h, neck = 0.07 * h;  // of head, collar and neck
  const Real under = -std::acos(neck / radius);                      // where the head leaves the neck
  Profile p;
  p.add_line({0, 0}, {0.27 * h, 0}, e);
  p.add_arc({0.27 * h, 0.035 * h}, 0.035 * h, -0.5 * kPi, 0.5 * kPi, e, 4);
  // The robe: from the plinth inwards, and up to the collar.
  p.add(
      [=](Real s) {
        const Real u = 1 - s;
        const ProfilePoint a{0.27 * h, 0.07 * h}, b{0.13 * h, 0.12 * h}, c{0.1 * h, 0.3 * h}, d{0.1 * h, 0.56 * h};
        const Real w[4] = {u * u * u, 3 * u * u * s, 3 * u * s * s, s * s * s};
        return ProfilePoint{w[0] * a.r + w[1] * b.r + w[2] * c.r + w[3] * d.r,
                            w[0] * a.y + w[1] * b.y + w[2] * c.y + w[3] * d.y};
      },
      e, 4);
  p.add_line({0.1 * h, 0.56 * h}, {sleeve - 0.02 * h, 0.59 * h}, e, 2);
  p.add_arc({sleeve - 0.02 * h, 0.61 * h}, 0.02 * h, -0.5 * kPi, 0.5 * kPi, e, 2);
  p.add_line({sleeve - 0.02 * h, 0.63 * h}, {neck, 0.66 * h}, e, 2);
  p.add_line({neck, 0.66 * h}, {neck, head.y + radius * std::sin(under)}, e);
  p.add_arc(head, radius, under, 0.5 * kPi, e, 6);
  p.points.back().r = 0;
  return revolve(p, 10);
}

SurfaceMesh make_twisted_column(Real width, Real height, Real turn, Real edge) {
  require_size("twisted column", "width", width), require_size("twisted column", "height", height);
  require_shape(std::isfinite(turn) && std::abs(turn) * width <= 2 * kPi * height,
                fmt::format("twisted column: a turn of {} rad is too much for a width {} and a height {}; at most "
                            "2 pi height / width",
                            turn, width, height));
  SurfaceMesh mesh = make_box({width, height, width}, edge);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3 p = mesh.vertices[v];
    const Real up = p.y / height + 0.5, angle = turn * up, c = std::cos(angle), s = std::sin(angle);
    mesh.vertices.set(v, {c * p.x + s * p.z, up * height, c * p.z - s * p.x});
  }
  return mesh;
}

}  // namespace sherd
