// How stress at the surface and stress inside are joined, whichever formulation they come from.
#pragma once
#include "engine/elastostatic/boundary.h"
#include "engine/mesh/bvh.h"
#include "engine/stress/stress_field.h"

namespace sherd {

// Linear interpolation of the corner stresses over a face; x beyond the face's edges is pulled onto it.
Sym3 interpolate_corners(const PanelFrame& panel, const SurfaceRecovery& recovery,
                         const std::vector<Sym3>& corner_stress, std::uint32_t face, const Vec3& x);

// What stress at a point of the closed solid is made of: from 0.03 local edge lengths below the surface on that inside
// alone, above it a linear transition to that of the closest face; points outside get the face's.
struct SurfaceBlend {
  Real inside = 1;             // weight of the stress at `below`, the rest is that of `on`
  Vec3 below, on;              // m; `on` is a point of `face`
  std::uint32_t face = kNone;  // kNone where inside = 1
};
SurfaceBlend blend_near_surface(const TriangleBvh& bvh, const Boundary& boundary, const Vec3& x);

}  // namespace sherd
