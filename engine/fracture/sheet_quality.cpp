#include "engine/fracture/sheet_quality.h"

#include <algorithm>
#include <limits>
#include <numbers>

namespace sherd {
namespace {

constexpr int kPasses = 3;
constexpr Real kFlatCosine = 0.87;  // edges are flipped where the sheet bends by less than 30 degrees

// Radians.
Real least_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto angle = [](const Vec3& at, const Vec3& p, const Vec3& q) {
    return std::atan2(norm(cross(p - at, q - at)), dot(p - at, q - at));
  };
  return std::min({angle(a, b, c), angle(b, c, a), angle(c, a, b)});
}

// 2 r / R = 8 (s - a) (s - b) (s - c) / (a b c) with s half the perimeter.
Real radius_ratio(Real a, Real b, Real c) {
  return (b + c - a) * (c + a - b) * (a + b - c) / (a * b * c);
}

Vec3 unit_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  return normalized(cross(b - a, c - a));
}

std::uint32_t opposite(const Triangle& n, std::uint32_t a, std::uint32_t b) {
  return n[0] != a && n[0] != b ? n[0] : n[1] != a && n[1] != b ? n[1] : n[2];
}

// Flips a -> b of triangle t when the smaller of the two triangles' least angles grows.
bool flip(SheetMesh& sheet, std::uint32_t t, std::uint32_t a, std::uint32_t b) {
  const std::uint32_t u = sheet.triangle_at(b, a);
  if (u == kNone) return false;
  const std::uint32_t c = opposite(sheet.triangles[t], a, b), d = opposite(sheet.triangles[u], a, b);
  const Vec3 pa = sheet.position[a], pb = sheet.position[b], pc = sheet.position[c], pd = sheet.position[d];
  const Real before = std::min(least_angle(pa, pb, pc), least_angle(pb, pa, pd));
  const Real after = std::min(least_angle(pa, pd, pc), least_angle(pd, pb, pc));
  if (!(after > 1.05 * before) || sheet.has_edge(c, d)) return false;
  const Vec3 up = unit_normal(pa, pb, pc);
  for (const Vec3& n : {unit_normal(pb, pa, pd), unit_normal(pa, pd, pc), unit_normal(pd, pb, pc)})
    if (!(dot(n, up) > kFlatCosine)) return false;
  return sheet.apply({{t, u}, {{a, d, c}, {d, b, c}}, kNone, {}});
}

void flip_edges(SheetMesh& sheet) {
  const auto count = static_cast<std::uint32_t>(sheet.triangles.size());
  for (std::uint32_t t = 0; t < count; ++t)
    for (std::size_t k = 0; k < 3 && sheet.alive[t]; ++k)
      flip(sheet, t, sheet.triangles[t][k], sheet.triangles[t][(k + 1) % 3]);
}

void smooth(SheetMesh& sheet) {
  for (std::uint32_t v = 0; v < sheet.state.size(); ++v) {
    if (sheet.state[v] != NodeState::kInterior || sheet.incident[v].empty()) continue;
    Vec3 mean{};
    const std::vector<std::uint32_t> ring = sheet.neighbours(v);
    for (const std::uint32_t w : ring) mean += sheet.position[w];
    sheet.move(v, 0.5 * (sheet.position[v] + mean / static_cast<Real>(ring.size())));
  }
}

}  // namespace

SheetQuality sheet_quality(const CrackSheet& sheet) {
  constexpr Real kDegrees = 180 / std::numbers::pi;
  SheetQuality q;
  q.triangles = sheet.triangles.size();
  if (q.triangles == 0) return q;
  q.least_angle = 60;
  const Real share = 1 / static_cast<Real>(q.triangles);
  Real shortest = std::numeric_limits<Real>::infinity(), longest = 0;
  for (const Triangle& t : sheet.triangles) {
    const Vec3 u = sheet.position[t[0]], v = sheet.position[t[1]], w = sheet.position[t[2]];
    const Real angle = kDegrees * least_angle(u, v, w), a = distance(v, w), b = distance(w, u), c = distance(u, v);
    q.least_angle = std::min(q.least_angle, angle);
    q.mean_angle += share * angle, q.mean_radius_ratio += share * radius_ratio(a, b, c);
    q.below_10 += angle < 10;
    shortest = std::min({shortest, a, b, c}), longest = std::max({longest, a, b, c});
  }
  q.edge_ratio = longest / shortest;
  return q;
}

void improve_inside(SheetMesh& sheet) {
  for (int pass = 0; pass < kPasses; ++pass) {
    flip_edges(sheet);
    smooth(sheet);
  }
  flip_edges(sheet);
}

}  // namespace sherd
