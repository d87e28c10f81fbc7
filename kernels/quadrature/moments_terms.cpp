#include "kernels/quadrature/moments_terms.h"

namespace sherd {
namespace {

// Gauss-Legendre on [-1, 1], 8 points (Abramowitz and Stegun 1964, table 25.4).
constexpr Real kNode8[4] = {0.18343464249564980494, 0.52553240991632898582, 0.79666647741362673959,
                            0.96028985649753623168};
constexpr Real kWeight8[4] = {0.36268378337836198297, 0.31370664587788728734, 0.22238103445337447054,
                              0.10122853629037625915};

// An edge in the local plane, from a to b.
struct PlaneEdge {
  Real au, aw, bu, bw, length, d;
};

// The edge is seen from more than two of its lengths: about its middle, so that no large terms cancel. The
// singularities lie beyond 4 half-lengths, the 8-point rule errs below 8^-16 = 4e-15.
void far_edge(const PlaneEdge& g, bool cubes, EdgeMoments<Real>& e) {
  e.base_u = 0.5 * (g.au + g.bu), e.base_w = 0.5 * (g.aw + g.bw);
  e.step_u = 0.5 * (g.bu - g.au), e.step_w = 0.5 * (g.bw - g.aw);
  const Real half = 0.5 * g.length;
  const Real c0 = e.base_u * e.base_u + e.base_w * e.base_w + g.d * g.d;
  const Real c1 = 2 * (e.base_u * e.step_u + e.base_w * e.step_w), c2 = half * half;
  Real f[8], z[8];
  for (int i = 0; i < 4; ++i) z[i] = kNode8[i], z[i + 4] = -kNode8[i];
  for (int i = 0; i < 8; ++i) f[i] = 1 / std::sqrt(c0 + z[i] * (c1 + z[i] * c2));
  for (int a = 0; a < 4; ++a) e.k[a] = 0;
  for (int a = 0; a < 5; ++a) e.e[a] = 0;
  for (int i = 0; i < 8; ++i) {
    Real k = half * kWeight8[i & 3] * f[i], cube = k * f[i] * f[i];
    for (int a = 0; a < 4; ++a, k *= z[i]) e.k[a] += k;
    if (cubes)
      for (int a = 0; a < 5; ++a, cube *= z[i]) e.e[a] += cube;
  }
}

// Closed forms about the foot of the target on the edge's line, which keep their relative accuracy close to it.
void near_edge(const PlaneEdge& g, Real ra2, Real rb2, Real tu, Real tw, Real clamp, bool cubes, EdgeMoments<Real>& e) {
  const Real sa = g.au * tu + g.aw * tw, sb = g.bu * tu + g.bw * tw;
  const Real ra = std::sqrt(std::max(ra2, clamp)), rb = std::sqrt(std::max(rb2, clamp));
  const Real h2 = std::max(e.p * e.p + g.d * g.d, clamp);
  e.base_u = e.p * e.outward_u, e.base_w = e.p * e.outward_w;
  e.step_u = tu, e.step_w = tw;
  e.k[0] = edge_log(sa, sb, ra, rb, h2);
  e.k[1] = (sb - sa) * (sb + sa) / (ra + rb);
  e.k[2] = 0.5 * (sb * rb - sa * ra - h2 * e.k[0]);
  e.k[3] = (sb * sb * rb - sa * sa * ra - 2 * h2 * e.k[1]) / 3;
  if (!cubes) return;
  const auto [e0, cd] = edge_cube(sa, sb, ra, rb, h2);
  e.e[0] = e0;
  e.e[1] = e.k[1] / (ra * rb);
  e.e[2] = e.k[0] - cd;
  e.e[3] = e.k[1] - h2 * e.e[1];
  e.e[4] = e.k[2] - h2 * e.e[2];
}

}  // namespace

PanelView<Real> view_panel(const PanelFrame& f, const Vec3& x, Side side, bool cubes) {
  PanelView<Real> v;
  const PlaneTerms plane = plane_terms(f, x, side);
  v.d = plane.d, v.omega = plane.omega;
  // u along the longest edge: the two directions of a sliver keep their own scales.
  const int longest =
      f.length[0] >= f.length[1] ? (f.length[0] >= f.length[2] ? 0 : 2) : (f.length[1] >= f.length[2] ? 1 : 2);
  v.u = f.tangent[longest], v.w = -f.outward[longest], v.n = f.normal;
  Real u[3], w[3], r2[3];
  for (int k = 0; k < 3; ++k) {
    const Vec3 q = f.vertex[k] - x;
    u[k] = dot(q, v.u), w[k] = dot(q, v.w);
    r2[k] = u[k] * u[k] + w[k] * w[k] + v.d * v.d;
  }
  for (int a = 0; a < 3; ++a) {
    const int b = a == 2 ? 0 : a + 1;
    EdgeMoments<Real>& e = v.edge[a];
    const Real tu = dot(f.tangent[a], v.u), tw = dot(f.tangent[a], v.w);
    e.outward_u = tw, e.outward_w = -tu;
    // From the nearer corner, and not from the rounded u, w: its rounding is relative to the distance from the edge
    // where the panel's own coordinates allow.
    e.p = dot(f.vertex[r2[a] < r2[b] ? a : b] - x, f.outward[a]);
    const PlaneEdge g{u[a], w[a], u[b], w[b], f.length[a], v.d};
    const Real middle2 = 0.5 * (r2[a] + r2[b]) - 0.25 * g.length * g.length;
    if (middle2 > 4 * g.length * g.length)
      far_edge(g, cubes, e);
    else
      near_edge(g, r2[a], r2[b], tu, tw, kPanelClamp * f.longest2, cubes, e);
  }
  // Gradient of the coordinate that is 1 at a corner: minus the outward normal of the opposite edge over the altitude.
  const Real cs = -f.length[2] / (2 * f.area), ct = -f.length[0] / (2 * f.area);
  v.su = cs * v.edge[2].outward_u, v.sw = cs * v.edge[2].outward_w;
  v.tu = ct * v.edge[0].outward_u, v.tw = ct * v.edge[0].outward_w;
  v.s0 = -(v.su * u[0] + v.sw * w[0]);
  v.t0 = -(v.tu * u[0] + v.tw * w[0]);
  return v;
}

// I_-5[rho_i q] = -(sum_e m_i J_-3[q] - I_-3[d_i q]) / 3,  3 d^3 I_-5[1] = Omega + d sum_e p J_-3[1].
void plane_fifths(const PanelView<Real>& v, const PlaneMoments<Real>& m, Real (&fifth)[tri(6)]) {
  Real p = 0, mu[tri(5)] = {}, mw[5] = {};
  for (const EdgeMoments<Real>& e : v.edge) {
    Real j[tri(5)];
    edge_table<4>(e, e.e, j);
    p += e.p * j[0];
    for (int i = 0; i < tri(5); ++i) mu[i] += e.outward_u * j[i];
    for (int g = 0; g < 5; ++g) mw[g] += e.outward_w * j[tri(g) + g];
  }
  const Real *three = m.cube, d = v.d, third = 1.0 / 3;
  fifth[0] = third * (v.omega + d * p);
  fifth[1] = -third * d * d * mu[0];
  fifth[2] = -third * d * d * mw[0];
  fifth[3] = -third * (d * mu[1] - three[0]);
  fifth[4] = -third * d * mu[2];
  fifth[5] = -third * (d * mw[1] - three[0]);
  for (int g = 2; g < 5; ++g) {
    for (int j = 0; j <= g; ++j)
      fifth[tri(g + 1) + j] = -third * (mu[tri(g) + j] - (j < g ? (g - j) * three[tri(g - 1) + j] : 0));
    fifth[tri(g + 1) + g + 1] = -third * (mw[g] - g * three[tri(g - 1) + g - 1]);
  }
}

}  // namespace sherd
