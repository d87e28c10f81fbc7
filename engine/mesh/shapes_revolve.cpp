#include "engine/mesh/shapes_revolve.h"

#include <algorithm>
#include <numbers>

#include "engine/mesh/shapes.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

constexpr Real kPi = std::numbers::pi;

Real distance_in_profile(const ProfilePoint& a, const ProfilePoint& b) {
  return std::hypot(a.r - b.r, a.y - b.y);
}

// Vertices first .. first + count, the k-th at angle 2 pi (k + shift) / count; a pole has count 1.
struct Ring {
  std::uint32_t first;
  int count;
  Real shift;
  std::uint32_t vertex(int k) const { return first + static_cast<std::uint32_t>(k % count); }
  Real angle(int k) const { return (static_cast<Real>(k) + shift) / static_cast<Real>(count); }  // in turns
};

// Zips two rings by angle: the side whose next vertex comes first advances.
void stitch(const Ring& a, const Ring& b, SurfaceMesh& mesh) {
  const int na = a.count == 1 ? 0 : a.count, nb = b.count == 1 ? 0 : b.count;
  int i = 0, j = 0;
  while (i < na || j < nb) {
    const bool step_a = j == nb || (i < na && a.angle(i + 1) <= b.angle(j + 1));
    if (step_a)
      mesh.add_triangle(a.vertex(i), b.vertex(j), a.vertex(i + 1)), ++i;
    else
      mesh.add_triangle(a.vertex(i), b.vertex(j), b.vertex(j + 1)), ++j;
  }
}

Ring add_ring(const ProfilePoint& p, Real edge, int least, bool shifted, SurfaceMesh& mesh) {
  Ring ring{static_cast<std::uint32_t>(mesh.vertex_count()), 1, 0.0};
  if (p.r <= 0) {
    mesh.vertices.push_back({0, p.y, 0});
    return ring;
  }
  const int around = static_cast<int>(std::lround(2 * kPi * p.r / edge));
  ring.count = std::max(around, p.r < 1.2 * edge ? std::min(least, 6) : least);
  ring.shift = shifted ? 0.5 : 0.0;
  for (int k = 0; k < ring.count; ++k) {
    const Real angle = 2 * kPi * ring.angle(k);
    mesh.vertices.push_back({p.r * std::cos(angle), p.y, p.r * std::sin(angle)});
  }
  return ring;
}

ProfilePoint quadratic_bezier(const ProfilePoint& a, const ProfilePoint& b, const ProfilePoint& c, Real s) {
  const Real u = (1 - s) * (1 - s), v = 2 * s * (1 - s), w = s * s;
  return {u * a.r + v * b.r + w * c.r, u * a.y + v * b.y + w * c.y};
}

}  // namespace

void Profile::add(const ProfileCurve& curve, Real target, int least) {
  constexpr int kSamples = 512;  // arc length by chords: relative error below 1e-5 for the quarter turns used here
  std::vector<ProfilePoint> fine;
  std::vector<Real> length{0.0};
  for (int i = 0; i <= kSamples; ++i) {
    fine.push_back(curve(static_cast<Real>(i) / kSamples));
    if (i > 0) length.push_back(length.back() + distance_in_profile(fine[fine.size() - 2], fine.back()));
  }
  const int pieces = std::max(least, static_cast<int>(std::lround(length.back() / target)));
  for (int i = points.empty() ? 0 : 1; i <= pieces; ++i) {
    const Real wanted = length.back() * static_cast<Real>(i) / static_cast<Real>(pieces);
    const auto above = std::lower_bound(length.begin() + 1, length.end() - 1, wanted) - length.begin();
    const auto k = static_cast<std::size_t>(above);
    const Real s = (static_cast<Real>(k - 1) + (wanted - length[k - 1]) / (length[k] - length[k - 1])) / kSamples;
    points.push_back(i == 0 ? fine.front() : (i == pieces ? fine.back() : curve(s)));
    edge.push_back(target);
  }
}

void Profile::add_line(ProfilePoint a, ProfilePoint b, Real target, int least) {
  add([=](Real s) { return ProfilePoint{a.r + s * (b.r - a.r), a.y + s * (b.y - a.y)}; }, target, least);
}

void Profile::add_arc(ProfilePoint c, Real radius, Real a0, Real a1, Real target, int least) {
  add(
      [=](Real s) {
        const Real a = a0 + s * (a1 - a0);
        return ProfilePoint{c.r + radius * std::cos(a), c.y + radius * std::sin(a)};
      },
      target, least);
}

SurfaceMesh revolve(const Profile& profile, int least) {
  SurfaceMesh mesh;
  std::vector<Ring> rings;
  for (std::size_t i = 0; i < profile.points.size(); ++i)
    rings.push_back(add_ring(profile.points[i], profile.edge[i], least, i % 2 == 1, mesh));
  for (std::size_t i = 0; i + 1 < rings.size(); ++i) stitch(rings[i], rings[i + 1], mesh);
  if (profile.closed) stitch(rings.back(), rings.front(), mesh);
  return mesh;
}

SurfaceMesh make_cylinder(Real radius, Real height, Real edge) {
  require_size("cylinder", "radius", radius), require_size("cylinder", "height", height);
  require_size("cylinder", "edge", edge);
  require_affordable("cylinder", 2 * kPi * radius * (radius + height), edge);
  Profile p;
  const Real around = std::min(edge, 2 * kPi * radius / 8);
  p.add_line({0, -0.5 * height}, {radius, -0.5 * height}, around);
  p.add_line({radius, -0.5 * height}, {radius, 0.5 * height}, around);
  p.add_line({radius, 0.5 * height}, {0, 0.5 * height}, around);
  p.points.back().r = 0;
  return revolve(p);
}

SurfaceMesh make_torus(Real major, Real minor, Real edge) {
  require_size("torus", "major radius", major), require_size("torus", "minor radius", minor);
  require_size("torus", "edge", edge);
  require_shape(minor < major, fmt::format("torus: minor radius {} must be below the major radius {}", minor, major));
  require_affordable("torus", 4 * kPi * kPi * major * minor, edge);
  Profile p;
  p.add_arc({major, 0}, minor, 0, 2 * kPi, std::min(edge, 2 * kPi * minor / 6), 6);
  p.points.pop_back(), p.edge.pop_back();  // the last point repeats the first
  p.closed = true;
  return revolve(p);
}

SurfaceMesh make_dinner_plate(Real radius, Real thickness, Real edge) {
  require_size("dinner plate", "radius", radius), require_size("dinner plate", "thickness", thickness);
  require_size("dinner plate", "edge", edge);
  require_shape(thickness <= 0.1 * radius,
                fmt::format("dinner plate: thickness {} must be at most a tenth of the radius {}", thickness, radius));
  require_affordable("dinner plate", 2.2 * kPi * radius * radius, edge);
  const Real half = 0.5 * thickness, flat = 0.6 * radius, bend = 0.2 * radius, rise = kPi / 6;
  // Facets may depart from the bend by a fifth of the wall: chord^2 / (8 radius) <= thickness / 5.
  const Real e = std::min(edge, std::sqrt(1.6 * thickness * bend));
  const ProfilePoint bend_centre{flat, half + bend};
  const ProfilePoint rim_start{flat + bend * std::sin(rise), half + bend * (1 - std::cos(rise))};
  const Real rim_end = radius - half;  // centre of the rounded end, on the mid-surface
  const ProfilePoint tip{rim_end, rim_start.y + (rim_end - rim_start.r) * std::tan(rise)};
  const ProfilePoint n{-std::sin(rise) * half, std::cos(rise) * half};  // from the mid-surface of the rim to its top
  const Real down = -0.5 * kPi;
  Profile p;
  p.add_line({0, 0}, {flat, 0}, e);
  p.add_arc(bend_centre, bend + half, down, down + rise, e, 2);
  p.add_line({rim_start.r - n.r, rim_start.y - n.y}, {tip.r - n.r, tip.y - n.y}, e);
  p.add_arc(tip, half, down + rise, down + rise + kPi, e, 2);
  p.add_line({tip.r + n.r, tip.y + n.y}, {rim_start.r + n.r, rim_start.y + n.y}, e);
  p.add_arc(bend_centre, bend - half, down + rise, down, e, 2);
  p.add_line({flat, thickness}, {0, thickness}, e);
  return revolve(p, 12);
}

SurfaceMesh make_goblet(Real height, Real bowl_radius, Real wall, Real edge) {
  require_size("goblet", "height", height), require_size("goblet", "bowl radius", bowl_radius);
  require_size("goblet", "wall", wall), require_size("goblet", "edge", edge);
  require_shape(bowl_radius <= height,
                fmt::format("goblet: bowl radius {} must be at most the height {}", bowl_radius, height));
  require_shape(wall <= 0.1 * std::min(bowl_radius, 0.5 * height),
                fmt::format("goblet: wall {} must be at most a tenth of the bowl radius {} and of half the height",
                            wall, bowl_radius));
  require_affordable("goblet", 8 * kPi * bowl_radius * (bowl_radius + height), edge);
  const Real half = 0.5 * wall, foot = 0.8 * bowl_radius, stem = std::max(0.1 * bowl_radius, wall);
  // Mid-surface of the bowl: quarter ellipse with half axes a (r) and b (y), from its bottom to the vertical lip.
  const Real a = bowl_radius - half, b = 0.5 * height - half, lip = height - half;
  const auto bowl = [=](Real angle, Real offset) {
    const Real c = std::cos(angle), s = std::sin(angle);  // angle 0 = bottom
    const Real nr = b * s, ny = -a * c, l = std::hypot(nr, ny);
    return ProfilePoint{a * s + offset * nr / l, lip - b * c + offset * ny / l};
  };
  const Real curvature_radius = std::min({a * a / b, b * b / a, a});
  const Real e = std::min(edge, std::sqrt(1.6 * wall * curvature_radius));
  const Real stem_edge = std::min(e, 2 * kPi * stem / 10);
  // The outer bowl starts where its radius is 2.5 stems; from there a parabola leads tangentially into the stem.
  Real low = 0, high = 0.5 * kPi;
  for (int i = 0; i < 60; ++i) (bowl(0.5 * (low + high), half).r < 2.5 * stem ? low : high) = 0.5 * (low + high);
  const Real start = low;
  const ProfilePoint join = bowl(start, half);
  const Real slope = b * std::sin(start) / (a * std::cos(start));  // dy/dr of the bowl there
  const ProfilePoint corner{stem, join.y - slope * (join.r - stem)};
  const ProfilePoint stem_top{stem, corner.y - (join.r - stem)};
  const ProfilePoint foot_top{foot - half, wall};
  const ProfilePoint stem_bottom{stem, wall + std::min(0.5 * foot, 0.5 * (stem_top.y - wall))};
  require_shape(stem_bottom.y < stem_top.y, "goblet: no room for the stem; raise the height or make the bowl narrower");
  Profile p;
  p.add_line({0, 0}, {foot - half, 0}, e);
  p.add_arc({foot - half, half}, half, -0.5 * kPi, 0.5 * kPi, e, 2);
  p.add([=](Real s) { return quadratic_bezier(foot_top, {stem, wall}, stem_bottom, s); }, e, 3);
  p.add_line(stem_bottom, stem_top, stem_edge);
  p.add([=](Real s) { return quadratic_bezier(stem_top, corner, join, s); }, stem_edge, 3);
  p.add([=](Real s) { return bowl(start + s * (0.5 * kPi - start), half); }, e, 2);
  p.add_arc({a, lip}, half, 0, kPi, e, 2);
  p.add([=](Real s) { return bowl((1 - s) * 0.5 * kPi, -half); }, e, 2);
  p.points.back().r = 0;
  return revolve(p, 10);
}

}  // namespace sherd
