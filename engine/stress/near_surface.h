// How stress at the surface and stress inside are joined, whichever formulation they come from.
#pragma once
#include <functional>

#include "engine/elastostatic/boundary.h"
#include "engine/mesh/bvh.h"
#include "engine/stress/stress_field.h"

namespace sherd {

// Linear interpolation of the corner stresses over a face; x beyond the face's edges is pulled onto it.
Sym3 interpolate_corners(const PanelFrame& panel, const SurfaceRecovery& recovery,
                         const std::vector<Sym3>& corner_stress, std::uint32_t face, const Vec3& x);

// Stress at x: `interior` from 0.03 local edge lengths below the surface on, above it a linear transition to
// field.on_face() at the closest surface point. Points outside get the value there.
Sym3 blend_near_surface(const StressField& field, const TriangleBvh& bvh, const Boundary& boundary, const Vec3& x,
                        const std::function<Sym3(const Vec3&)>& interior);

}  // namespace sherd
