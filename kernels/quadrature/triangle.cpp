#include "kernels/quadrature/triangle.h"

#include <algorithm>

#include "kernels/quadrature/panel_terms.h"

namespace sherd {
namespace {

// Line integrals over one edge; hv is the vector from the foot on the edge's line to the target.
struct EdgeTerms {
  Vec3 hv;
  Real p = 0;    // in-plane distance of the target inside the edge
  Real log = 0;  // L = integral of 1/l
  Real sa = 0, sb = 0, ra = 0, rb = 0, h2 = 0;
};

EdgeTerms edge_terms(const PanelFrame& f, int e, const Vec3& x, Real d) {
  const Vec3 a = f.vertex[e] - x, b = f.vertex[(e + 1) % 3] - x;
  const Real clamp = kPanelClamp * f.longest2;
  EdgeTerms t;
  t.sa = dot(a, f.tangent[e]), t.sb = dot(b, f.tangent[e]);
  t.ra = std::sqrt(std::max(norm2(a), clamp)), t.rb = std::sqrt(std::max(norm2(b), clamp));
  t.p = 0.5 * (dot(a, f.outward[e]) + dot(b, f.outward[e]));
  t.h2 = std::max(t.p * t.p + d * d, clamp);
  t.hv = f.normal * d - f.outward[e] * t.p;
  t.log = edge_log(t.sa, t.sb, t.ra, t.rb, t.h2);
  return t;
}

}  // namespace

PanelFrame make_panel(const Vec3& v0, const Vec3& v1, const Vec3& v2) {
  PanelFrame f;
  f.vertex[0] = v0, f.vertex[1] = v1, f.vertex[2] = v2;
  const Vec3 n = cross(v1 - v0, v2 - v0);
  f.area = 0.5 * norm(n);
  f.normal = normalized(n);
  for (int e = 0; e < 3; ++e) {
    const Vec3 edge = f.vertex[(e + 1) % 3] - f.vertex[e];
    f.length[e] = norm(edge);
    f.tangent[e] = normalized(edge);
    f.outward[e] = cross(f.tangent[e], f.normal);
    f.longest2 = std::max(f.longest2, norm2(edge));
  }
  return f;
}

void integrate_panel(const PanelFrame& f, const Vec3& x, Side side, PanelValues& out) {
  const PlaneTerms plane = plane_terms(f, x, side);
  const Vec3& n = f.normal;
  Real inverse = -plane.d * plane.omega;
  Vec3 sum_ml;  // sum over edges of m L
  Mat3 mr;      // sum over edges of m_i R_j
  for (int e = 0; e < 3; ++e) {
    const EdgeTerms t = edge_terms(f, e, x, plane.d);
    inverse += t.p * t.log;
    sum_ml += f.outward[e] * t.log;
    mr += outer(f.outward[e], t.hv * t.log - f.tangent[e] * (t.rb - t.ra));
  }
  const Vec3 gradient = n * -plane.omega - sum_ml;  // A,k
  out.inverse = inverse;
  out.dyad = mr - outer(n, gradient) * plane.d + (Mat3::identity() - outer(n, n)) * inverse;
  out.solid_angle = plane.omega;
  for (int a = 0; a < 3; ++a) {
    const Vec3 g = f.shape_gradient(a);
    const Real shape = 1.0 + dot(g, x - f.vertex[a]);
    out.shape_angle[a] = shape * plane.omega - plane.d * dot(g, sum_ml);
  }
}

void integrate_panel_gradient(const PanelFrame& f, const Vec3& x, Side side, PanelGradients& out) {
  const PlaneTerms plane = plane_terms(f, x, side);
  const Vec3& n = f.normal;
  const Real d = plane.d;
  Real inverse = -d * plane.omega;
  Vec3 sum_ml, omega_k;
  Mat3 second;  // A,jk without the normal part: - sum_e m_j gL_k
  Mat3 mrk[3];  // sum_e m_i R_jk, indexed [k][i][j]
  for (int e = 0; e < 3; ++e) {
    const EdgeTerms t = edge_terms(f, e, x, d);
    const Vec3 &m = f.outward[e], &tg = f.tangent[e];
    const auto [e0, cd] = edge_cube(t.sa, t.sb, t.ra, t.rb, t.h2);
    const Real e1 = 1 / t.ra - 1 / t.rb, e2 = t.log - cd;
    const Vec3 log_gradient = t.hv * -e0 + tg * e1;
    const Mat3 r = Mat3::identity() * t.log -
                   (outer(t.hv, t.hv) * e0 - (outer(t.hv, tg) + outer(tg, t.hv)) * e1 + outer(tg, tg) * e2);
    inverse += t.p * t.log;
    sum_ml += m * t.log;
    omega_k += m * dot(log_gradient, n) - n * dot(log_gradient, m);
    second += outer(m, log_gradient) * -1.0;
    for (int k = 0; k < 3; ++k) mrk[k] += outer(m, r.column(k));
  }
  const Vec3 gradient = n * -plane.omega - sum_ml;
  second += outer(n, omega_k) * -1.0;
  out.inverse = gradient;
  const Mat3 tangential = Mat3::identity() - outer(n, n);
  for (int k = 0; k < 3; ++k)
    out.dyad[k] = mrk[k] - outer(n, gradient) * n[k] + tangential * gradient[k] - outer(n, second.column(k)) * d;
}

}  // namespace sherd
