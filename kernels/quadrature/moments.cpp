#include "kernels/quadrature/moments.h"

#include "kernels/quadrature/moments_terms.h"

namespace sherd {
namespace {

Sym3 symmetric(const Real (&t)[6]) {
  return {t[0], t[1], t[2], t[3], t[4], t[5]};
}

Sym3 tensor(const LocalBasis& basis, const Real (&c)[6]) {
  Real out[6];
  basis.tensor(c, out);
  return symmetric(out);
}

}  // namespace

void integrate_panel_moments(const PanelFrame& panel, const Vec3& x, Side side, PanelMoments& out) {
  if (side == Side::kAway && panel_is_far(panel, x)) return far_moments(panel, x, out);
  const PolynomialMoments<Real> moments(view_panel(panel, x, side, false));
  for (int m = 0; m < kQuadraticMonomials; ++m)
    out.inverse[m] = moments.inverse[m], out.dyad[m] = symmetric(moments.dyad[m]);
  for (int m = 0; m < kCubicMonomials; ++m) out.angle[m] = moments.angle[m];
}

void integrate_panel_moment_gradients(const PanelFrame& panel, const Vec3& x, Side side, PanelMomentGradients& out) {
  if (side == Side::kAway && panel_is_far(panel, x)) return far_moment_gradients(panel, x, out);
  const PanelView<Real> v = view_panel(panel, x, side, true);
  PlaneMoments<Real> plane;
  plane_moments(v, plane);
  Real fifth_table[tri(6)];
  plane_fifths(v, plane, fifth_table);
  const QuadraticTables<1, 1, Real> cube(v, plane.cube);
  const QuadraticTables<3, 3, Real> fifth(v, fifth_table);
  const LocalBasis basis(v);
  for (int m = 0; m < kQuadraticMonomials; ++m) {
    const Real(&f)[10] = fifth.f[m];
    // Integral of r / l^3 in the local axes; r = d n - u - w.
    const Real ru = -cube.f[m][1], rw = -cube.f[m][2], rn = cube.f[m][0];
    out.inverse[m] = (v.u * ru + v.w * rw + v.n * rn) * -1.0;
    // d/dx_k of r_i r_j / l^3 = (delta_ik r_j + delta_jk r_i) / l^3 - 3 r_i r_j r_k / l^5, k along u, w, n.
    const Sym3 du = tensor(basis, {2 * ru + 3 * f[6], rw + 3 * f[7], 3 * f[8], rn - 3 * f[3], -3 * f[4], 3 * f[1]});
    const Sym3 dw = tensor(basis, {3 * f[7], ru + 3 * f[8], 2 * rw + 3 * f[9], -3 * f[4], rn - 3 * f[5], 3 * f[2]});
    const Sym3 dn = tensor(basis, {-3 * f[3], -3 * f[4], -3 * f[5], ru + 3 * f[1], rw + 3 * f[2], 2 * rn - 3 * f[0]});
    for (int k = 0; k < 3; ++k) out.dyad[k][m] = du * v.u[k] + dw * v.w[k] + dn * v.n[k];
  }
}

}  // namespace sherd
