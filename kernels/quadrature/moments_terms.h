// Polynomials of two in-plane variables, and the edge integrals behind the panel moments.
//
// (u, w) are orthonormal coordinates in the panel's plane, centred at the projection of the target. A polynomial table
// holds the integrals of u^i w^j by total degree g = i + j: entry tri(g) + j. Tables of l^-3 and l^-5 carry powers of
// the height d in their lowest degrees, so that solid angles enter without a division: entry (i, j) of a table with
// carry c is multiplied by d^max(0, c - g).
#pragma once
#include "kernels/quadrature/moments.h"
#include "kernels/quadrature/panel_terms.h"

namespace sherd {

constexpr int tri(int degree) {
  return degree * (degree + 1) / 2;
}

// One edge: the point z of it lies at base + z step; k[a] = integral of z^a / l, e[a] = integral of z^a / l^3 along it.
struct EdgeMoments {
  Real base_u, base_w, step_u, step_w;
  Real outward_u, outward_w;
  Real p;  // base . outward: distance of the projection inside the edge's line
  Real k[4], e[5];
};

// The panel as the target sees it.
struct PanelView {
  Vec3 u, w, n;
  Real d, omega;
  // Affine coordinates of the panel: s = s0 + su u + sw w, and t.
  Real s0, su, sw, t0, tu, tw;
  EdgeMoments edge[3];
};
PanelView view_panel(const PanelFrame& panel, const Vec3& x, Side side, bool cubes);

// l^-1 to degree 2, l^-3 to degree 4 (carry 1).
struct PlaneMoments {
  Real inverse[tri(3)], cube[tri(5)];
};
void plane_moments(const PanelView& v, PlaneMoments& out);
// l^-5 to degree 5 (carry 3).
void plane_fifths(const PanelView& v, const PlaneMoments& m, Real (&fifth)[tri(6)]);

// Table of the edge integrals of u^i w^j to degree G from the integrals of z^a, a <= G.
template <int G>
inline void edge_table(const EdgeMoments& e, const Real* z, Real* out) {
  Real row[G + 1][G + 1];
  for (int a = 0; a <= G; ++a) row[0][a] = z[a];
  out[0] = z[0];
  for (int g = 1; g <= G; ++g) {
    for (int a = 0; a <= G - g; ++a) row[g][a] = e.base_w * row[g - 1][a] + e.step_w * row[g - 1][a + 1];
    for (int j = 0; j < g; ++j)
      for (int a = 0; a <= G - g; ++a) row[j][a] = e.base_u * row[j][a] + e.step_u * row[j][a + 1];
    for (int j = 0; j <= g; ++j) out[tri(g) + j] = row[j][0];
  }
}

// Multiplies the density of a table by c + au u + aw w; degrees 0..G of the result from 0..G+1 of the table.
template <int G, int Carry>
inline void multiply(const Real* f, Real d, Real c, Real au, Real aw, Real* out) {
  for (int g = 0; g <= G; ++g) {
    const Real bu = g < Carry ? d * au : au, bw = g < Carry ? d * aw : aw;
    for (int j = 0; j <= g; ++j)
      out[tri(g) + j] = c * f[tri(g) + j] + bu * f[tri(g + 1) + j] + bw * f[tri(g + 1) + j + 1];
  }
}

// Tables of the six quadratic monomials of s, t, to degree G, from a table to degree G + 2.
template <int G, int Carry>
struct QuadraticTables {
  Real f[kQuadraticMonomials][tri(G + 1)];

  QuadraticTables(const PanelView& v, const Real* table) {
    Real s[tri(G + 2)], t[tri(G + 2)];
    multiply<G + 1, Carry>(table, v.d, v.s0, v.su, v.sw, s);
    multiply<G + 1, Carry>(table, v.d, v.t0, v.tu, v.tw, t);
    for (int i = 0; i < tri(G + 1); ++i) f[0][i] = table[i], f[1][i] = s[i], f[2][i] = t[i];
    multiply<G, Carry>(s, v.d, v.s0, v.su, v.sw, f[3]);
    multiply<G, Carry>(s, v.d, v.t0, v.tu, v.tw, f[4]);
    multiply<G, Carry>(t, v.d, v.t0, v.tu, v.tw, f[5]);
  }
};

// Gauss rules on the panel for targets beyond `kFarAltitudes` altitudes, where the closed forms lose the digits that
// the monomials need (they cancel as a power of distance over altitude) and a few points across suffice.
bool panel_is_far(const PanelFrame& panel, const Vec3& x);
void far_moments(const PanelFrame& panel, const Vec3& x, PanelMoments& out);
void far_moment_gradients(const PanelFrame& panel, const Vec3& x, PanelMomentGradients& out);

}  // namespace sherd
