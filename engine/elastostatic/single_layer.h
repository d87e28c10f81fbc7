// Kelvin single layer V_E[t] of the load: the right-hand side of the direct formulation.
#pragma once
#include "engine/elastostatic/boundary.h"
#include "engine/elastostatic/particular.h"
#include "kernels/quadrature/moments.h"

namespace sherd {

// V_E[t - sigma_p n](x) at every point, m. Points may lie anywhere, on the surface too. Constant and quadratic
// tractions (the particular solution's is quadratic) are integrated in closed form near, by Gauss rules far: one sample
// a triangle costs accuracy.
Vec3Column load_potential(const Boundary& boundary, const Load& load, const ParticularSolution& particular,
                          const Elastic& material, const QuadratureOptions& options, const Vec3Column& points);

// Homogeneous traction t - sigma_p n of a mesh triangle as a polynomial: coefficients of the six monomials of
// moments.h.
std::array<Vec3, kQuadraticMonomials> traction_polynomial(const Boundary& boundary, const Load& load,
                                                          const ParticularSolution& particular, std::size_t triangle);

}  // namespace sherd
