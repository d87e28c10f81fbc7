// Polynomials of two in-plane variables, and the edge integrals behind the panel moments.
//
// (u, w) are orthonormal coordinates in the panel's plane, centred at the projection of the target. A polynomial table
// holds the integrals of u^i w^j by total degree g = i + j: entry tri(g) + j. Tables of l^-3 and l^-5 carry powers of
// the height d in their lowest degrees, so that solid angles enter without a division: entry (i, j) of a table with
// carry c is multiplied by d^max(0, c - g).
//
// T is a number, or a vector of numbers, one a target, in code compiled for one processor: nothing here may be left to
// a function that other code shares.
#pragma once
#include "kernels/quadrature/moments.h"
#include "kernels/quadrature/panel_terms.h"

namespace sherd {

#define SHERD_INLINE [[gnu::always_inline]] inline

SHERD_INLINE constexpr int tri(int degree) {
  return degree * (degree + 1) / 2;
}

// One edge: the point z of it lies at base + z step; k[a] = integral of z^a / l, e[a] = integral of z^a / l^3 along it.
template <class T>
struct EdgeMoments {
  T base_u, base_w, step_u, step_w;
  Real outward_u, outward_w;
  T p;  // base . outward: distance of the projection inside the edge's line
  T k[4], e[5];
};

// The panel as the target sees it.
template <class T>
struct PanelView {
  Vec3 u, w, n;
  T d, omega;
  // Affine coordinates of the panel: s = s0 + su u + sw w, and t.
  T s0, t0;
  Real su, sw, tu, tw;
  EdgeMoments<T> edge[3];
};
PanelView<Real> view_panel(const PanelFrame& panel, const Vec3& x, Side side, bool cubes);

// l^-1 to degree 2, l^-3 to degree 4 (carry 1).
template <class T>
struct PlaneMoments {
  T inverse[tri(3)], cube[tri(5)];
};
// l^-5 to degree 5 (carry 3).
void plane_fifths(const PanelView<Real>& v, const PlaneMoments<Real>& m, Real (&fifth)[tri(6)]);

// Table of the edge integrals of u^i w^j to degree G from the integrals of z^a, a <= G.
template <int G, class T>
SHERD_INLINE void edge_table(const EdgeMoments<T>& e, const T* z, T* out) {
  T row[G + 1][G + 1];
  for (int a = 0; a <= G; ++a) row[0][a] = z[a];
  out[0] = z[0];
  for (int g = 1; g <= G; ++g) {
    for (int a = 0; a <= G - g; ++a) row[g][a] = e.base_w * row[g - 1][a] + e.step_w * row[g - 1][a + 1];
    for (int j = 0; j < g; ++j)
      for (int a = 0; a <= G - g; ++a) row[j][a] = e.base_u * row[j][a] + e.step_u * row[j][a + 1];
    for (int j = 0; j <= g; ++j) out[tri(g) + j] = row[j][0];
  }
}

// I_k[q] is the integral of q l^k over the panel, J_k over its edges (m outward, p = rho . m). From the divergence
// theorem
//   I_-3[rho_i q] = -sum_e m_i J_-1[q] + I_-1[d_i q],
//   (n + 1) I_-1[q] = -d^2 I_-3[q] + sum_e p J_-1[q] for q homogeneous of degree n,  d I_-3[1] = Omega.
template <class T>
SHERD_INLINE void plane_moments(const PanelView<T>& v, PlaneMoments<T>& out) {
  T p[tri(3)] = {}, mu[tri(4)] = {}, mw[4] = {};
  for (const EdgeMoments<T>& e : v.edge) {
    T j[tri(4)];
    edge_table<3>(e, e.k, j);
    for (int i = 0; i < tri(3); ++i) p[i] += e.p * j[i];
    for (int i = 0; i < tri(4); ++i) mu[i] += e.outward_u * j[i];
    for (int g = 0; g < 4; ++g) mw[g] += e.outward_w * j[tri(g) + g];
  }
  T *one = out.inverse, *three = out.cube;
  const T d2 = v.d * v.d;
  three[0] = v.omega;
  one[0] = p[0] - v.d * v.omega;
  three[1] = -mu[0], three[2] = -mw[0];
  for (int g = 1; g < 4; ++g) {
    if (g < 3)
      for (int j = 0; j <= g; ++j) one[tri(g) + j] = (p[tri(g) + j] - d2 * three[tri(g) + j]) / Real(g + 1);
    // Degree g + 1: u^(g-j) w^j from q = u^(g-j) w^j through rho_u, the last through rho_w.
    for (int j = 0; j < g; ++j) three[tri(g + 1) + j] = Real(g - j) * one[tri(g - 1) + j] - mu[tri(g) + j];
    three[tri(g + 1) + g] = -mu[tri(g) + g];
    three[tri(g + 1) + g + 1] = Real(g) * one[tri(g - 1) + g - 1] - mw[g];
  }
}

// Multiplies the density of a table by c + au u + aw w; degrees 0..G of the result from 0..G+1 of the table.
template <int G, int Carry, class T>
SHERD_INLINE void multiply(const T* f, T d, T c, Real au, Real aw, T* out) {
  for (int g = 0; g <= G; ++g) {
    const T bu = g < Carry ? d * au : T{} + au, bw = g < Carry ? d * aw : T{} + aw;
    for (int j = 0; j <= g; ++j)
      out[tri(g) + j] = c * f[tri(g) + j] + bu * f[tri(g + 1) + j] + bw * f[tri(g + 1) + j + 1];
  }
}

// Tables of the six quadratic monomials of s, t, to degree G, from a table to degree G + 2.
template <int G, int Carry, class T>
struct QuadraticTables {
  T f[kQuadraticMonomials][tri(G + 1)];

  SHERD_INLINE QuadraticTables(const PanelView<T>& v, const T* table) {
    T s[tri(G + 2)], t[tri(G + 2)];
    multiply<G + 1, Carry>(table, v.d, v.s0, v.su, v.sw, s);
    multiply<G + 1, Carry>(table, v.d, v.t0, v.tu, v.tw, t);
    for (int i = 0; i < tri(G + 1); ++i) f[0][i] = table[i], f[1][i] = s[i], f[2][i] = t[i];
    multiply<G, Carry>(s, v.d, v.s0, v.su, v.sw, f[3]);
    multiply<G, Carry>(s, v.d, v.t0, v.tu, v.tw, f[4]);
    multiply<G, Carry>(t, v.d, v.t0, v.tu, v.tw, f[5]);
  }
};

// Symmetric products of the local axes: the tensor sum of c[i] product[i], in the order uu, uw, ww, un, wn, nn.
// product[i] has the entries xx, yy, zz, yz, xz, xy.
struct LocalBasis {
  Real product[6][6];

  template <class View>
  SHERD_INLINE explicit LocalBasis(const View& v) {
    const Real axis[3][3] = {{v.u.x, v.u.y, v.u.z}, {v.w.x, v.w.y, v.w.z}, {v.n.x, v.n.y, v.n.z}};
    constexpr int kFirst[6] = {0, 0, 1, 0, 1, 2}, kSecond[6] = {0, 1, 1, 2, 2, 2};
    for (int i = 0; i < 6; ++i) {
      const Real *a = axis[kFirst[i]], *b = axis[kSecond[i]];
      const Real c = kFirst[i] == kSecond[i] ? 0.5 : 1.0;
      for (int k = 0; k < 3; ++k) product[i][k] = 2 * a[k] * b[k] * c;
      product[i][3] = (a[1] * b[2] + a[2] * b[1]) * c;
      product[i][4] = (a[0] * b[2] + a[2] * b[0]) * c;
      product[i][5] = (a[0] * b[1] + a[1] * b[0]) * c;
    }
  }
  template <class T>
  SHERD_INLINE void tensor(const T (&c)[6], T (&out)[6]) const {
    for (int k = 0; k < 6; ++k) {
      out[k] = product[0][k] * c[0];
      for (int i = 1; i < 6; ++i) out[k] += product[i][k] * c[i];
    }
  }
};

// From the panel as targets see it: integrals of the six quadratic monomials over l, and times r r^T / l^3 (entries xx,
// yy, zz, yz, xz, xy), and of the ten cubic ones times r.n / l^3.
template <class T>
struct PolynomialMoments {
  T inverse[kQuadraticMonomials], dyad[kQuadraticMonomials][6], angle[kCubicMonomials];

  SHERD_INLINE explicit PolynomialMoments(const PanelView<T>& v) {
    PlaneMoments<T> plane;
    plane_moments(v, plane);
    const QuadraticTables<0, 0, T> one(v, plane.inverse);
    const QuadraticTables<2, 1, T> cube(v, plane.cube);
    const LocalBasis basis(v);
    for (int m = 0; m < kQuadraticMonomials; ++m) {
      const T(&f)[6] = cube.f[m];
      inverse[m] = one.f[m][0];
      angle[m] = f[0];
      // r = d n - u - w.
      basis.tensor({f[3], f[4], f[5], -v.d * f[1], -v.d * f[2], v.d * f[0]}, dyad[m]);
    }
    multiply<0, 1>(cube.f[3], v.d, v.s0, v.su, v.sw, &angle[6]);
    multiply<0, 1>(cube.f[3], v.d, v.t0, v.tu, v.tw, &angle[7]);
    multiply<0, 1>(cube.f[5], v.d, v.s0, v.su, v.sw, &angle[8]);
    multiply<0, 1>(cube.f[5], v.d, v.t0, v.tu, v.tw, &angle[9]);
  }
};

// Gauss rules on the panel for targets beyond `kFarAltitudes` altitudes, where the closed forms lose the digits that
// the monomials need (they cancel as a power of distance over altitude) and a few points across suffice.
bool panel_is_far(const PanelFrame& panel, const Vec3& x);
void far_moments(const PanelFrame& panel, const Vec3& x, PanelMoments& out);
void far_moment_gradients(const PanelFrame& panel, const Vec3& x, PanelMomentGradients& out);

}  // namespace sherd
