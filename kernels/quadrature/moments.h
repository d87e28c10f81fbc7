// Closed-form integrals of polynomial densities over a flat triangle: what cubic displacements and polynomial tractions
// need near the target. Conventions of triangle.h: r = x - y, l = |r|. Monomials in the affine coordinates s, t of the
// panel (s = 1 at vertex[1], t = 1 at vertex[2], both 0 at vertex[0]), in the order
//   1; s, t; s^2, s t, t^2; s^3, s^2 t, s t^2, t^3.
// Within 1e-11 of the largest entry (angles: or 1e-13) at every distance and for triangles down to altitude / length
// 1e-4: beyond eight altitudes the closed forms would cancel and a Gauss rule replaces them, ten times slower; a fixed
// rule is cheaper there where less accuracy will do. Gradients are singular on the triangle's edges, as in triangle.h.
#pragma once
#include "kernels/core/symmetric.h"
#include "kernels/quadrature/triangle.h"

namespace sherd {

inline constexpr int kQuadraticMonomials = 6, kCubicMonomials = 10;

struct PanelMoments {
  Real inverse[kQuadraticMonomials];  // integral of m / l, m
  Sym3 dyad[kQuadraticMonomials];     // integral of m r r^T / l^3, m
  Real angle[kCubicMonomials];        // integral of m r.n / l^3, no unit; Side as in integrate_panel
};
void integrate_panel_moments(const PanelFrame& panel, const Vec3& x, Side side, PanelMoments& out);

// Gradients with respect to x of `inverse` and `dyad` (the density stays on the panel), no unit.
struct PanelMomentGradients {
  Vec3 inverse[kQuadraticMonomials];
  Sym3 dyad[3][kQuadraticMonomials];  // dyad[k] = d/dx_k
};
void integrate_panel_moment_gradients(const PanelFrame& panel, const Vec3& x, Side side, PanelMomentGradients& out);

}  // namespace sherd
