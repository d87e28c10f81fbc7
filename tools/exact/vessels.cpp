#include "tools/exact/vessels.h"

#include <array>
#include <numbers>

#include "engine/body/mass.h"
#include "engine/load/contact_load.h"
#include "engine/mesh/shapes_revolve.h"

namespace sherd::exact {
namespace {

constexpr Real kPi = std::numbers::pi;

ProfilePoint quadratic_bezier(const ProfilePoint& a, const ProfilePoint& b, const ProfilePoint& c, Real s) {
  const Real u = (1 - s) * (1 - s), v = 2 * s * (1 - s), w = s * s;
  return {u * a.r + v * b.r + w * c.r, u * a.y + v * b.y + w * c.y};
}

}  // namespace

Vessel dinner_plate(Real edge) {
  constexpr Real kRadius = 0.12, kWall = 0.005, kFlat = 0.07, kBend = 0.03, kRise = kPi / 6, kDown = -0.5 * kPi;
  const Real half = 0.5 * kWall;
  const ProfilePoint centre{kFlat, half + kBend};  // of the bend, whose mid-surface starts on the base's
  const Real start_r = kFlat + kBend * std::sin(kRise), start_y = half + kBend * (1 - std::cos(kRise));
  const Real flange = (kRadius - start_r) / std::cos(kRise);
  const ProfilePoint n{-std::sin(kRise) * half, std::cos(kRise) * half};
  const ProfilePoint tip{start_r + flange * std::cos(kRise), start_y + flange * std::sin(kRise)};
  Profile p;
  p.add_line({0, 0}, {kFlat, 0}, edge);
  p.add_arc(centre, kBend + half, kDown, kDown + kRise, edge, 2);
  p.add_line({start_r - n.r, start_y - n.y}, {tip.r - n.r, tip.y - n.y}, edge);
  p.add_line({tip.r - n.r, tip.y - n.y}, {tip.r + n.r, tip.y + n.y}, edge);
  p.add_line({tip.r + n.r, tip.y + n.y}, {start_r + n.r, start_y + n.y}, edge);
  p.add_arc(centre, kBend - half, kDown + kRise, kDown, edge, 2);
  p.add_line({kFlat, kWall}, {0, kWall}, edge);
  p.points.back().r = 0;
  Vessel v;
  v.mesh = revolve(p, 12), v.thickness = kWall;
  v.hit = {tip.r, tip.y, 0}, v.force = {-100, 0, 0}, v.patch_radius = 0.02;
  return v;
}

Vessel goblet(Real edge) {
  constexpr Real kHeight = 0.14, kBowl = 0.04, kWall = 0.004, kStem = 0.006, kFoot = 0.032, kDepth = 0.07;
  const Real half = 0.5 * kWall, a = kBowl - half, b = kDepth - half;  // mid-surface: half axes along r and y
  const auto bowl = [=](Real angle, Real offset) {                     // angle 0 = bottom
    const Real c = std::cos(angle), s = std::sin(angle), nr = b * s, ny = -a * c, l = std::hypot(nr, ny);
    return ProfilePoint{a * s + offset * nr / l, kHeight - b * c + offset * ny / l};
  };
  // The outer bowl starts where its radius is 2.5 stems; from there a parabola leads tangentially into the stem.
  Real low = 0, high = 0.5 * kPi;
  for (int i = 0; i < 60; ++i) (bowl(0.5 * (low + high), half).r < 2.5 * kStem ? low : high) = 0.5 * (low + high);
  const Real start = low, slope = b * std::sin(start) / (a * std::cos(start));
  const ProfilePoint join = bowl(start, half), corner{kStem, join.y - slope * (join.r - kStem)};
  const ProfilePoint stem_top{kStem, corner.y - (join.r - kStem)}, stem_bottom{kStem, kWall + 0.5 * kFoot};
  const Real stem_edge = std::min(edge, 2 * kPi * kStem / 8);
  Profile p;
  p.add_line({0, 0}, {kFoot, 0}, edge);
  p.add_line({kFoot, 0}, {kFoot, kWall}, edge);
  p.add([=](Real s) { return quadratic_bezier({kFoot, kWall}, {kStem, kWall}, stem_bottom, s); }, edge, 3);
  p.add_line(stem_bottom, stem_top, stem_edge);
  p.add([=](Real s) { return quadratic_bezier(stem_top, corner, join, s); }, stem_edge, 3);
  p.add([=](Real s) { return bowl(start + s * (0.5 * kPi - start), half); }, edge, 2);
  p.add_line({kBowl, kHeight}, {kBowl - kWall, kHeight}, edge);
  p.add([=](Real s) { return bowl((1 - s) * 0.5 * kPi, -half); }, edge, 2);
  p.points.back().r = 0;
  Vessel v;
  v.mesh = revolve(p, 8), v.thickness = kWall;
  v.hit = {kBowl, kHeight - 0.01, 0}, v.force = {-50, 0, 0}, v.patch_radius = 0.012;
  return v;
}

Load vessel_load(const Vessel& vessel) {
  const TriangleBvh bvh(vessel.mesh);
  const std::array<BodyContact, 1> contacts{{{vessel.hit, vessel.force, 0, vessel.patch_radius}}};
  return make_load(vessel.mesh, mass_properties(vessel.mesh, 2400), contacts, build_twins(vessel.mesh), bvh, {});
}

}  // namespace sherd::exact
