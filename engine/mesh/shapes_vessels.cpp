#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/mesh/shapes.h"
#include "engine/mesh/shapes_revolve.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

constexpr Real kPi = std::numbers::pi;

// The wall's middle, from the foot up to the lip, as a cubic Bezier curve: smooth, so that its offsets are.
struct Wall {
  std::array<ProfilePoint, 4> control;
  Real half;  // of the thickness

  ProfilePoint at(Real s) const {
    const Real u = 1 - s, w[4] = {u * u * u, 3 * u * u * s, 3 * u * s * s, s * s * s};
    ProfilePoint p{0, 0};
    for (std::size_t k = 0; k < 4; ++k) p.r += w[k] * control[k].r, p.y += w[k] * control[k].y;
    return p;
  }
  ProfilePoint tangent(Real s) const {  // of length 1
    const Real u = 1 - s, w[3] = {u * u, 2 * u * s, s * s};
    ProfilePoint d{0, 0};
    for (std::size_t k = 0; k < 3; ++k)
      d.r += w[k] * (control[k + 1].r - control[k].r), d.y += w[k] * (control[k + 1].y - control[k].y);
    const Real l = std::hypot(d.r, d.y);
    return {d.r / l, d.y / l};
  }
  // side 1: outside, -1: inside.
  ProfilePoint face(Real s, Real side) const {
    const ProfilePoint p = at(s), t = tangent(s);
    return {p.r + side * half * t.y, p.y - side * half * t.r};
  }
  // Smallest radius of curvature of the profile and of the rings.
  Real curvature_radius() const {
    constexpr int kSamples = 64;
    Real least = at(0).r;
    for (int i = 0; i < kSamples; ++i) {
      const Real a = static_cast<Real>(i) / kSamples, b = static_cast<Real>(i + 1) / kSamples;
      const ProfilePoint p = at(a), q = at(b), s = tangent(a), t = tangent(b);
      const Real turn = std::abs(std::asin(std::clamp(s.r * t.y - s.y * t.r, -1.0, 1.0)));
      least = std::min({least, q.r, std::hypot(q.r - p.r, q.y - p.y) / std::max(turn, 1e-9)});
    }
    return least;
  }
};

// An open vessel on y = 0: a flat bottom up to y = `floor`, the wall, a rounded lip.
SurfaceMesh make_vessel(const Wall& wall, Real floor, Real edge) {
  // Facets may depart from the wall by a fifth of it: chord^2 / (8 radius) <= thickness / 5.
  const Real e = std::min(edge, std::sqrt(3.2 * wall.half * wall.curvature_radius()));
  const ProfilePoint foot = wall.at(0), lip = wall.at(1), up = wall.tangent(0), end = wall.tangent(1);
  const Real low = std::atan2(-up.r, up.y), high = std::atan2(-end.r, end.y);  // of the outward normals
  Real bottom = 0, top = 1;                                                    // where the inner face meets the floor
  for (int i = 0; i < 60; ++i) {
    const Real middle = 0.5 * (bottom + top);
    (wall.face(middle, -1).y < floor ? bottom : top) = middle;
  }
  const Real start = top;
  const ProfilePoint corner = wall.face(start, -1);
  Profile p;
  p.add_line({0, 0}, {foot.r, 0}, e);
  p.add_arc(foot, wall.half, -0.5 * kPi, low, e, 2);
  p.add([&](Real s) { return wall.face(s, 1); }, e, 2);
  p.add_arc(lip, wall.half, high, high + kPi, e, 2);
  p.add([&](Real s) { return wall.face(1 + s * (start - 1), -1); }, e, 2);
  p.add_line(corner, {0, floor}, e);
  p.points.back().r = 0;
  return revolve(p, 10);
}

}  // namespace

SurfaceMesh make_tumbler(Real height, Real radius, Real wall, Real edge) {
  require_size("tumbler", "height", height), require_size("tumbler", "radius", radius);
  require_size("tumbler", "wall", wall), require_size("tumbler", "edge", edge);
  require_shape(
      wall <= 0.2 * std::min(radius, height),
      fmt::format("tumbler: wall {} must be at most a fifth of the radius {} and of the height", wall, radius));
  require_affordable("tumbler", 6 * kPi * radius * (radius + height), edge);
  const Real half = 0.5 * wall, r0 = 0.75 * radius - half, r1 = radius - half, rise = height - 2 * half;
  const auto between = [&](Real s) { return ProfilePoint{r0 + s * (r1 - r0), half + s * rise}; };
  return make_vessel({{between(0), between(1.0 / 3), between(2.0 / 3), between(1)}, half}, 2 * wall, edge);
}

SurfaceMesh make_vase(Real height, Real radius, Real wall, Real edge) {
  require_size("vase", "height", height), require_size("vase", "radius", radius);
  require_size("vase", "wall", wall), require_size("vase", "edge", edge);
  require_shape(radius <= height, fmt::format("vase: radius {} must be at most the height {}", radius, height));
  require_shape(wall <= 0.15 * radius,
                fmt::format("vase: wall {} must be at most 0.15 of the radius {}", wall, radius));
  require_affordable("vase", 8 * kPi * radius * (radius + height), edge);
  // Foot, belly, neck and lip from one cubic, scaled so that the belly is as wide as asked for.
  const Real half = 0.5 * wall, y1 = height - half;
  Wall w{{{{0.5, half}, {1.6, half + 0.28 * (y1 - half)}, {0.6, half + 0.72 * (y1 - half)}, {0.45, y1}}}, half};
  Real widest = 0;
  for (int i = 0; i <= 1000; ++i) widest = std::max(widest, w.at(i / 1000.0).r);
  for (ProfilePoint& c : w.control) c.r *= (radius - half) / widest;
  return make_vessel(w, 2 * wall, edge);
}

}  // namespace sherd
