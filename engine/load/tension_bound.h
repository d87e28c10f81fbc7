// How much tension a load on a free body can cause, from above, without a solve: for loads far too light to break it.
// An estimate calibrated on full solves, not a theorem; tests/campaign/load_bounds_test.cpp holds it against a
// thousand random loads on bodies of all kinds.
#pragma once
#include "engine/mesh/bvh.h"

namespace sherd {

struct BoundedLoad {
  Real force = 0;     // sizes of all contact forces together, N
  Real pressure = 0;  // largest of force over the area of its patch and solidity(), Pa
  Real density = 0;   // kg/m^3
  Real spin = 0;      // rad/s
};

struct BoundedBody {
  Real thickness = 0;    // of the thinnest parts that matter, m: the least of twice volume over area and of its walls
  Real diagonal = 0;     // of the bounding box, m
  bool notched = false;  // has reentrant creases, which concentrate stress
};

// Pa. The worst of what bends a body and what pulls around a contact, times a margin. A free bar under a force in its
// middle or at its end bends with M up to 0.15 F L, so its stress goes like F L / T^3; a plate under a point like
// F / T^2; reentrant creases raise either three to four times (a body with a neck); around a contact the surface is
// pulled by up to its mean pressure, at edges and with friction. Of 2016 solves on 24 bodies and 6048 on their shards
// (tools/campaign/load_bounds.h) the largest stress over this is 0.74.
Real tension_bound(const BoundedBody& body, const BoundedLoad& load);

// How well the solid under a contact at `point` bears its pressure: s^1.5 where s is the solid's share of the half ball
// of the patch's radius (m), at least kLeastSolidity. A flat face has 1, the edge of a cube 0.35, its corner 0.12; the
// thin edge of a shard little: it bends like s^-2 and is torn by what a face would bear. Of 64 fixed points.
Real solidity(const TriangleBvh& body, const Vec3& point, Real radius);
inline constexpr Real kLeastSolidity = 0.0112;  // of s = 0.05

// Edges where the surface turns inward by more than 40 degrees; of meshes with twins (build_twins()).
bool has_reentrant_creases(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& twins);

}  // namespace sherd
