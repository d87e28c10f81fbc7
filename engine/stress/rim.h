// Stress at convex sharp edges. Two faces with known traction meet there, which fixes every component but one; the fits
// on either side, one-sided and at their least accurate, are asked for that one alone: the strain along the edge.
#pragma once
#include "engine/mesh/surface_corners.h"
#include "kernels/core/symmetric.h"
#include "kernels/fundamental/elastic.h"

namespace sherd {

// The corners of one vertex all of whose sharp edges are convex: indices into SurfaceCorners::corner, two or more.
using Rim = std::vector<std::uint32_t>;
// Re-entrant edges are left out: the stress there grows without bound, and the conditions would hide it.
std::vector<Rim> convex_rims(const SurfaceMesh& mesh, const SurfaceCorners& corners);

// What one corner knows: its unit normal, the traction there and the surface gradient (g n = 0) of the displacement.
struct RimSide {
  Vec3 normal, traction;
  Mat3 gradient;
};
// Least squares over sigma n_k = t_k and the mean strain along each edge direction n_i x n_j. Returns false when the
// sides are too nearly parallel (under 20 degrees) to say anything.
bool rim_stress(const std::vector<RimSide>& sides, const Elastic& material, Sym3& out);

}  // namespace sherd
