// Kelvin single layer V_E[t] of the load at the vertices: the right-hand side of the direct formulation.
#pragma once
#include "engine/elastostatic/boundary.h"
#include "engine/elastostatic/particular.h"

namespace sherd {

// V_E[t - sigma_p n](x) at every vertex, m. Load panels are constant; the polynomial traction of the particular
// solution is integrated (four sub-panels near, Gauss points far), because one sample a triangle costs accuracy.
Vec3Column load_potential(const Boundary& boundary, const Load& load, const ParticularSolution& particular,
                          const Elastic& material, const QuadratureOptions& options);

}  // namespace sherd
