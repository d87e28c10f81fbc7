// Where two closed, embedded meshes cross: crossings of edges with faces, and the segments that join them. All
// decisions are exact signs; meshes in general position have no other kind of intersection.
#pragma once
#include <string>
#include <vector>

#include "engine/fragment/arrangement_point.h"
#include "engine/mesh/bvh.h"

namespace sherd {

// A mesh with what the cut asks of it.
struct CutOperand {
  explicit CutOperand(SurfaceMesh surface) : mesh(std::move(surface)), twin(build_twins(mesh)), bvh(mesh) {}
  // The same triangles with other vertices.
  CutOperand(SurfaceMesh surface, std::vector<std::uint32_t> twins)
      : mesh(std::move(surface)), twin(std::move(twins)), bvh(mesh) {}
  SurfaceMesh mesh;
  std::vector<std::uint32_t> twin;  // directed edge 3 t + k -> opposite
  TriangleBvh bvh;

  const std::array<Vec3, 3>& corners(std::uint32_t t) const { return bvh.corners(t); }
  // Both directions of an edge have this id.
  std::uint32_t edge_id(std::uint32_t directed) const { return std::min(directed, twin[directed]); }
};

// Six times the volume of the tetrahedron of a triangle and an origin; summed over a closed surface the origin is free.
inline Real corner_volume6(const std::array<Vec3, 3>& t, const Vec3& origin) {
  return dot(t[0] - origin, cross(t[1] - origin, t[2] - origin));
}

// Edge `edge` of operand `edge_operand` (0 body, 1 slab) through face `face` of the other.
struct Crossing {
  std::uint32_t edge_operand, edge, face;
  friend auto operator<=>(const Crossing&, const Crossing&) = default;
};

// Runs from crossing `start` to `end` along (normal of the body face) x (normal of the slab face): in the body face its
// left is inside the slab, in the slab face its left is outside the body.
struct CrossSegment {
  std::array<std::uint32_t, 2> face;  // of body, of slab
  std::uint32_t start, end;
};

enum class PierceStatus { kOk, kCoincidence, kInconsistent };

struct Piercing {
  PierceStatus status = PierceStatus::kOk;
  std::string reason;
  std::vector<Crossing> crossings;       // sorted
  std::vector<ArrangementPoint> points;  // one a crossing
  std::vector<CrossSegment> segments;    // each crossing starts one and ends one: closed loops
};

// kCoincidence: an exact zero (touching or coplanar simplices): move one operand. kInconsistent: an operand is not
// embedded.
Piercing pierce(const CutOperand& body, const CutOperand& slab);

// Is p inside the closed mesh? Exact parity along a random segment that leaves the mesh; p must not lie on the surface.
// False in `decided` when no tried direction was free of exact zeros.
bool inside_exact(const CutOperand& operand, const Vec3& p, bool& decided);

}  // namespace sherd
