#include "engine/fracture/seed.h"

#include <algorithm>
#include <numbers>

#include "engine/fracture/advance.h"

namespace sherd {
namespace {

constexpr int kFanSize = 8;
constexpr Real kFanRadius = 0.7;   // of h
constexpr Real kFanTurn = 0.37;    // of the fan's angle: never symmetric, so never along a mesh edge
constexpr Real kAtSeed = 0.05;     // of h: faces this near are the seed's own
constexpr Real kMinTilt = 0.1;     // sine of the least angle between crack plane and any of them
constexpr Real kMinInward = 0.35;  // sine of the least angle between crack plane and surface

// The coordinate axis farthest from e's direction.
Vec3 least_axis(const Vec3& e) {
  const Real x = std::abs(e.x), y = std::abs(e.y), z = std::abs(e.z);
  if (x <= y && x <= z) return {1, 0, 0};
  return y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
}

// At an edge of the body the mean normal hides that the plane lies within one of the faces.
bool runs_along_a_face(const TriangleBvh& body, const Vec3& seed, const Vec3& e, Real reach) {
  const Vec3 margin{reach, reach, reach};
  std::vector<std::uint32_t> faces;
  body.overlapping({seed - margin, seed + margin}, faces);
  return std::any_of(faces.begin(), faces.end(), [&](std::uint32_t f) {
    const auto& c = body.corners(f);
    if (distance2(closest_point_on_triangle(seed, c[0], c[1], c[2]), seed) > reach * reach) return false;
    return norm(cross(normalized(cross(c[1] - c[0], c[2] - c[0])), e)) < kMinTilt;
  });
}

}  // namespace

Vec3 canonical_sign(const Vec3& e) {
  const Real x = std::abs(e.x), y = std::abs(e.y), z = std::abs(e.z);
  const Real lead = x >= y && x >= z ? e.x : (y >= z ? e.y : e.z);
  return lead < 0 ? -e : e;
}

std::string open_seed(Growth& g, const CrackSeed& seed) {
  if (!is_finite(seed.position) || !is_finite(seed.normal) || !is_finite(seed.stress.direction) ||
      !std::isfinite(seed.stress.value))
    return "the seed is not finite";
  const Vec3 e = normalized(canonical_sign(seed.stress.direction));
  const Vec3 n = seed.interior ? least_axis(e) : normalized(seed.normal);
  if (norm2(e) == 0 || norm2(n) == 0) return "the seed has no direction";
  const Vec3 inward = -(n - dot(n, e) * e);
  if (norm(inward) < kMinInward) return "the crack plane is tangent to the surface";
  if (!seed.interior && runs_along_a_face(g.body, seed.position, e, kAtSeed * g.h))
    return "the crack plane runs along a face at the seed";
  g.seed_normal = e;
  g.reference_stress = seed.stress.value;
  const Vec3 d = normalized(inward), s = cross(e, d);
  const std::uint32_t centre = g.sheet.add_node(seed.position, e, NodeState::kInterior);
  FrontLoop ring;
  int inside = 0;
  for (int k = 0; k < kFanSize; ++k) {
    const Real angle = (k + kFanTurn) * 2 * std::numbers::pi / kFanSize;
    Vec3 p = seed.position + kFanRadius * g.h * (std::cos(angle) * d + std::sin(angle) * s);
    NodeState state = NodeState::kActive;
    if (g.body.inside(p))
      ++inside;
    else
      p = push_out(g, p, e), state = NodeState::kExited;
    ring.push_back(g.sheet.add_node(p, e, state));
  }
  if (seed.interior && inside < kFanSize) return "the first fan of an interior seed reaches the surface";
  if (inside < 2) return "fewer than two nodes of the first fan lie inside the body";
  for (std::size_t k = 0; k < ring.size(); ++k)
    if (!g.sheet.add({Triangle{centre, ring[k], ring[(k + 1) % ring.size()]}})) return "the first fan does not fit";
  g.loops = {ring};
  return {};
}

}  // namespace sherd
