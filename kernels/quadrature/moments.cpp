#include "kernels/quadrature/moments.h"

#include "kernels/quadrature/moments_terms.h"

namespace sherd {
namespace {

// Symmetric products of the local axes: the tensor sum of c[i] basis[i], in the order uu, uw, ww, un, wn, nn.
struct LocalBasis {
  Sym3 product[6];
  explicit LocalBasis(const PanelView& v) {
    const Vec3 axis[3] = {v.u, v.w, v.n};
    constexpr int kFirst[6] = {0, 0, 1, 0, 1, 2}, kSecond[6] = {0, 1, 1, 2, 2, 2};
    for (int i = 0; i < 6; ++i) {
      const Vec3 &a = axis[kFirst[i]], &b = axis[kSecond[i]];
      const Real c = kFirst[i] == kSecond[i] ? 0.5 : 1.0;
      product[i] = Sym3{2 * a.x * b.x,         2 * a.y * b.y,         2 * a.z * b.z,
                        a.y * b.z + a.z * b.y, a.x * b.z + a.z * b.x, a.x * b.y + a.y * b.x} *
                   c;
    }
  }
  Sym3 tensor(const Real (&c)[6]) const {
    Sym3 r = product[0] * c[0];
    for (int i = 1; i < 6; ++i) r += product[i] * c[i];
    return r;
  }
};

}  // namespace

void integrate_panel_moments(const PanelFrame& panel, const Vec3& x, Side side, PanelMoments& out) {
  if (side == Side::kAway && panel_is_far(panel, x)) return far_moments(panel, x, out);
  const PanelView v = view_panel(panel, x, side, false);
  PlaneMoments plane;
  plane_moments(v, plane);
  const QuadraticTables<0, 0> inverse(v, plane.inverse);
  const QuadraticTables<2, 1> cube(v, plane.cube);
  const LocalBasis basis(v);
  for (int m = 0; m < kQuadraticMonomials; ++m) {
    const Real(&f)[6] = cube.f[m];
    out.inverse[m] = inverse.f[m][0];
    out.angle[m] = f[0];
    // r = d n - u - w.
    out.dyad[m] = basis.tensor({f[3], f[4], f[5], -v.d * f[1], -v.d * f[2], v.d * f[0]});
  }
  multiply<0, 1>(cube.f[3], v.d, v.s0, v.su, v.sw, &out.angle[6]);
  multiply<0, 1>(cube.f[3], v.d, v.t0, v.tu, v.tw, &out.angle[7]);
  multiply<0, 1>(cube.f[5], v.d, v.s0, v.su, v.sw, &out.angle[8]);
  multiply<0, 1>(cube.f[5], v.d, v.t0, v.tu, v.tw, &out.angle[9]);
}

void integrate_panel_moment_gradients(const PanelFrame& panel, const Vec3& x, Side side, PanelMomentGradients& out) {
  if (side == Side::kAway && panel_is_far(panel, x)) return far_moment_gradients(panel, x, out);
  const PanelView v = view_panel(panel, x, side, true);
  PlaneMoments plane;
  plane_moments(v, plane);
  Real fifth_table[tri(6)];
  plane_fifths(v, plane, fifth_table);
  const QuadraticTables<1, 1> cube(v, plane.cube);
  const QuadraticTables<3, 3> fifth(v, fifth_table);
  const LocalBasis basis(v);
  for (int m = 0; m < kQuadraticMonomials; ++m) {
    const Real(&f)[10] = fifth.f[m];
    // Integral of r / l^3 in the local axes; r = d n - u - w.
    const Real ru = -cube.f[m][1], rw = -cube.f[m][2], rn = cube.f[m][0];
    out.inverse[m] = (v.u * ru + v.w * rw + v.n * rn) * -1.0;
    // d/dx_k of r_i r_j / l^3 = (delta_ik r_j + delta_jk r_i) / l^3 - 3 r_i r_j r_k / l^5, k along u, w, n.
    const Sym3 du = basis.tensor({2 * ru + 3 * f[6], rw + 3 * f[7], 3 * f[8], rn - 3 * f[3], -3 * f[4], 3 * f[1]});
    const Sym3 dw = basis.tensor({3 * f[7], ru + 3 * f[8], 2 * rw + 3 * f[9], -3 * f[4], rn - 3 * f[5], 3 * f[2]});
    const Sym3 dn = basis.tensor({-3 * f[3], -3 * f[4], -3 * f[5], ru + 3 * f[1], rw + 3 * f[2], 2 * rn - 3 * f[0]});
    for (int k = 0; k < 3; ++k) out.dyad[k][m] = du * v.u[k] + dw * v.w[k] + dn * v.n[k];
  }
}

}  // namespace sherd
