#include "tools/exact/vessels.h"

#include <array>
#include <numbers>

#include "engine/body/mass.h"
#include "engine/load/surface_load.h"
#include "kernels/core/parallel.h"
#include "kernels/core/random.h"

namespace sherd::exact {
namespace {

constexpr Real kPi = std::numbers::pi;

ProfileCurve straight(ProfilePoint a, ProfilePoint b) {
  return [=](Real s) { return ProfilePoint{a.r + s * (b.r - a.r), a.y + s * (b.y - a.y)}; };
}

ProfileCurve arc(ProfilePoint c, Real radius, Real from, Real to) {
  return [=](Real s) {
    const Real a = from + s * (to - from);
    return ProfilePoint{c.r + radius * std::cos(a), c.y + radius * std::sin(a)};
  };
}

ProfileCurve parabola(ProfilePoint a, ProfilePoint b, ProfilePoint c) {
  return [=](Real s) {
    const Real u = (1 - s) * (1 - s), v = 2 * s * (1 - s), w = s * s;
    return ProfilePoint{u * a.r + v * b.r + w * c.r, u * a.y + v * b.y + w * c.y};
  };
}

void add(Vessel& v, Profile& profile, ProfileCurve curve, Real edge, int least = 1) {
  profile.add(curve, edge, least);
  v.sections.push_back(std::move(curve));
}

ProfilePoint tangent(const ProfileCurve& curve, Real s) {
  constexpr Real kStep = 1e-5;
  const ProfilePoint a = curve(std::max(s - kStep, 0.0)), b = curve(std::min(s + kStep, 1.0));
  const Real l = std::hypot(b.r - a.r, b.y - a.y);
  return {(b.r - a.r) / l, (b.y - a.y) / l};
}

// Where sections meet at an angle: circles about the axis.
std::vector<ProfilePoint> creases(const Vessel& v) {
  std::vector<ProfilePoint> out;
  for (std::size_t i = 0; i + 1 < v.sections.size(); ++i) {
    const ProfilePoint a = tangent(v.sections[i], 1), b = tangent(v.sections[i + 1], 0);
    if (a.r * b.r + a.y * b.y < 0.95) out.push_back(v.sections[i](1));
  }
  return out;
}

}  // namespace

Vessel dinner_plate(Real edge) {
  constexpr Real kRadius = 0.1, kWall = 0.006, kFlat = 0.055, kBend = 0.025, kRise = kPi / 6, kDown = -0.5 * kPi;
  const Real half = 0.5 * kWall;
  const ProfilePoint centre{kFlat, half + kBend};  // of the bend, whose mid-surface starts on the base's
  const Real start_r = kFlat + kBend * std::sin(kRise), start_y = half + kBend * (1 - std::cos(kRise));
  const Real flange = (kRadius - start_r) / std::cos(kRise);
  const ProfilePoint n{-std::sin(kRise) * half, std::cos(kRise) * half};
  const ProfilePoint tip{start_r + flange * std::cos(kRise), start_y + flange * std::sin(kRise)};
  Vessel v;
  Profile p;
  add(v, p, straight({0, 0}, {kFlat, 0}), edge);
  add(v, p, arc(centre, kBend + half, kDown, kDown + kRise), edge, 2);
  add(v, p, straight({start_r - n.r, start_y - n.y}, {tip.r - n.r, tip.y - n.y}), edge);
  add(v, p, straight({tip.r - n.r, tip.y - n.y}, {tip.r + n.r, tip.y + n.y}), edge);
  add(v, p, straight({tip.r + n.r, tip.y + n.y}, {start_r + n.r, start_y + n.y}), edge);
  add(v, p, arc(centre, kBend - half, kDown + kRise, kDown), edge, 2);
  add(v, p, straight({kFlat, kWall}, {0, kWall}), edge);
  p.points.back().r = 0;
  v.mesh = revolve(p, 12), v.thickness = kWall;
  v.hit = {0.5 * (start_r + tip.r) + n.r, 0.5 * (start_y + tip.y) + n.y, 0};
  v.force = {-50, -80, 0}, v.patch_radius = 0.013;
  return v;
}

Vessel goblet(Real edge) {
  constexpr Real kHeight = 0.13, kBowl = 0.036, kWall = 0.005, kStem = 0.007, kFoot = 0.03, kDepth = 0.06;
  const Real half = 0.5 * kWall, a = kBowl - half, b = kDepth - half;  // mid-surface: half axes along r and y
  const auto bowl = [=](Real angle, Real offset) {                     // angle 0 = bottom
    const Real c = std::cos(angle), s = std::sin(angle), nr = b * s, ny = -a * c, l = std::hypot(nr, ny);
    return ProfilePoint{a * s + offset * nr / l, kHeight - b * c + offset * ny / l};
  };
  // The outer bowl starts where its radius is twice the stem's; from there a parabola leads tangentially into the stem.
  Real low = 0, high = 0.5 * kPi;
  for (int i = 0; i < 60; ++i) (bowl(0.5 * (low + high), half).r < 2 * kStem ? low : high) = 0.5 * (low + high);
  const Real start = low, slope = b * std::sin(start) / (a * std::cos(start));
  const ProfilePoint join = bowl(start, half), corner{kStem, join.y - slope * (join.r - kStem)};
  const ProfilePoint stem_top{kStem, corner.y - (join.r - kStem)}, stem_bottom{kStem, kWall + 0.5 * kFoot};
  const Real stem_edge = 0.3 * edge;
  Vessel v;
  Profile p;
  add(v, p, straight({0, 0}, {kFoot, 0}), edge);
  add(v, p, straight({kFoot, 0}, {kFoot, kWall}), edge);
  add(v, p, parabola({kFoot, kWall}, {kStem, kWall}, stem_bottom), 0.6 * edge, 3);
  add(v, p, straight(stem_bottom, stem_top), stem_edge);
  add(v, p, parabola(stem_top, corner, join), stem_edge, 3);
  add(
      v, p, [=](Real s) { return bowl(start + s * (0.5 * kPi - start), half); }, edge, 2);
  add(v, p, straight({kBowl, kHeight}, {kBowl - kWall, kHeight}), edge);
  add(
      v, p, [=](Real s) { return bowl((1 - s) * 0.5 * kPi, -half); }, edge, 2);
  p.points.back().r = 0;
  v.mesh = revolve(p, 12), v.thickness = kWall;
  const ProfilePoint side = bowl(std::acos(0.45), half);
  v.hit = {side.r, side.y, 0}, v.force = {-50, 0, 0}, v.patch_radius = 0.013;
  return v;
}

Load vessel_load(const Vessel& vessel) {
  const TriangleBvh bvh(vessel.mesh);
  const std::array<BodyContact, 1> contacts{{{vessel.hit, vessel.force, 0, vessel.patch_radius}}};
  return make_load(vessel.mesh, mass_properties(vessel.mesh, 2400), contacts, build_twins(vessel.mesh), bvh, {});
}

std::vector<VesselPoint> vessel_points(const Vessel& vessel, std::size_t count) {
  // Area of a band of the profile ~ length * radius; points are drawn from bands by rejection.
  constexpr int kBands = 256;
  struct Band {
    const ProfileCurve* curve;
    Real s, area;
  };
  std::vector<Band> bands;
  Real largest = 0;
  for (const ProfileCurve& c : vessel.sections)
    for (int i = 0; i < kBands; ++i) {
      const ProfilePoint a = c(static_cast<Real>(i) / kBands), b = c(static_cast<Real>(i + 1) / kBands);
      bands.push_back({&c, (i + 0.5) / kBands, std::hypot(b.r - a.r, b.y - a.y) * 0.5 * (a.r + b.r)});
      largest = std::max(largest, bands.back().area);
    }
  const std::vector<ProfilePoint> sharp = creases(vessel);
  std::vector<VesselPoint> out;
  Random random(7);
  while (out.size() < count) {
    const Band& band = bands[random.next() % bands.size()];
    const Real angle = random.uniform(0, 2 * kPi);
    if (random.uniform() * largest > band.area) continue;
    const ProfilePoint p = (*band.curve)(band.s), t = tangent(*band.curve, band.s);
    Real crease = 1e300;
    for (const ProfilePoint& q : sharp) crease = std::min(crease, std::hypot(p.r - q.r, p.y - q.y) / vessel.thickness);
    const Vec3 x{p.r * std::cos(angle), p.y, p.r * std::sin(angle)};
    if (crease < 0.2 || distance(x, vessel.hit) < 1.5 * vessel.patch_radius) continue;
    out.push_back({x, {t.y * std::cos(angle), -t.r, t.y * std::sin(angle)}, crease});
  }
  return out;
}

std::vector<Sym3> vessel_stress(const Vessel& vessel, const Solved& solved, const std::vector<VesselPoint>& points) {
  std::vector<Sym3> out(points.size());
  parallel_for(points.size(), 1, [&](std::size_t i) {
    // From a little above, so that the right side of a crease answers.
    const TriangleBvh::Closest c =
        solved.bvh->closest(points[i].position + points[i].normal * (0.1 * vessel.thickness));
    out[i] = solved.field->on_face(c.face, c.point);
  });
  return out;
}

}  // namespace sherd::exact
