// Keeps the volume: facets between points of a curved surface cut its corners, so vertices move along their normals
// until the new facets lie as much outside the input surface as inside.
#include <algorithm>

#include "engine/mesh/remesh_work.h"

namespace sherd {
namespace {

constexpr int kRounds = 3;
constexpr Real kNegligible = 1e-6;        // of the target length: flat places stay exactly flat
constexpr Real kMost = 0.1;               // of the target length: farther off is no matter of facets
constexpr Real kMostShift = 0.02;         // of the target length, a round: what walls may give to keep the volume
constexpr Real kMostShiftOfFlats = 3e-4;  // the same for flat places: three rounds stay below 1e-3
constexpr Real kVolumeMatters = 2e-4;     // of the target length cubed
constexpr Real kFlatCosine = 1 - 1e-7;

}  // namespace

// Mean height of a face over the input surface, metres, by the three-point rule of degree two and the centroid.
Real Remesher::height_over_input(std::uint32_t t) const {
  const auto c = mesh_.corners(t);
  const Vec3 n = normalized(cross(c[1] - c[0], c[2] - c[0]));
  const Vec3 centroid = (c[0] + c[1] + c[2]) / 3.0;
  Real sum = 0;
  int count = 0;
  for (const Vec3& p : {centroid, 0.5 * (centroid + c[0]), 0.5 * (centroid + c[1]), 0.5 * (centroid + c[2])}) {
    const auto found = project(p, n, mesh_.region[t]);
    if (found) sum += dot(p - found->point, n), ++count;
  }
  return count == 0 ? 0 : sum / count;
}

void Remesher::fit_heights() {
  std::vector<Real> height(mesh_.triangle.size());
  for (int round = 0; round < kRounds; ++round) {
    for (std::uint32_t t = 0; t < mesh_.triangle.size(); ++t) {
      height[t] = 0;
      if (!mesh_.alive(t)) continue;
      const Triangle& f = mesh_.triangle[t];
      if (std::any_of(f.begin(), f.end(), [&](std::uint32_t v) { return may_fit(v); }))
        height[t] = height_over_input(t);
    }
    for (std::uint32_t v = 0; v < mesh_.position.size(); ++v) {
      if (!may_fit(v)) continue;
      Real sum = 0, area = 0;
      mesh_.for_out(v, [&](std::uint32_t h) {
        const auto c = mesh_.corners(h / 3);
        const Real a = norm(cross(c[1] - c[0], c[2] - c[0]));
        sum += a * height[h / 3], area += a;
      });
      const Real limit = kMost * target(v), step = std::clamp(-sum / area, -limit, limit);
      if (std::abs(step) > kNegligible * target(v)) try_move(v, mesh_.position[v] + step * vertex_normal(v), 0.95);
    }
  }
}

Real Remesher::volume() const {
  const Vec3 o = mesh_.position[0];
  Real sum = 0;
  for (std::uint32_t t = 0; t < mesh_.triangle.size(); ++t) {
    if (!mesh_.alive(t)) continue;
    const auto c = mesh_.corners(t);
    sum += dot(c[0] - o, cross(c[1] - o, c[2] - o));
  }
  return sum / 6;
}

// A vertex whose faces may lie a little higher or lower without anybody seeing it: of a broken wall, or of a curved
// place. Flat original faces stay flat.
bool Remesher::may_give(std::uint32_t v) const {
  if (!may_fit(v)) return false;
  const Vec3 n = vertex_normal(v);
  bool gives = false;
  mesh_.for_out(v, [&](std::uint32_t h) {
    const auto c = mesh_.corners(h / 3);
    gives = gives || mesh_.faces.kind[h / 3] == FaceKind::kCrack ||
            dot(normalized(cross(c[1] - c[0], c[2] - c[0])), n) < kFlatCosine;
  });
  return gives;
}

// What feature lines and merged features have cost: a common step along the normals gives it back. Where walls and
// curved places cannot, flat ones take a step too small to see.
void Remesher::fit_volume() {
  const Real wanted = signed_volume(input_);
  std::vector<std::uint32_t> walls, all;
  for (std::uint32_t v = 0; v < mesh_.position.size(); ++v) {
    if (may_give(v)) walls.push_back(v);
    if (may_fit(v)) all.push_back(v);
  }
  shift(walls, wanted, kMostShift);
  if (std::abs(volume() - wanted) > kVolumeMatters * h_ * h_ * h_) shift(all, wanted, kMostShiftOfFlats);
}

void Remesher::shift(const std::vector<std::uint32_t>& givers, Real wanted, Real most) {
  for (int round = 0; round < kRounds; ++round) {
    const Real missing = wanted - volume();
    Real area = 0;  // volume gained per metre of common step
    for (const std::uint32_t v : givers) area += norm(area_around(v)) / 3;
    if (!(area > 0)) return;
    for (const std::uint32_t v : givers) {
      const Real limit = most * target(v), step = std::clamp(missing / area, -limit, limit);
      if (std::abs(step) > 1e-3 * kNegligible * target(v))
        try_move(v, mesh_.position[v] + step * vertex_normal(v), 0.95);
    }
  }
}

}  // namespace sherd
