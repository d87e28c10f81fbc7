// Closed forms of one panel at eight targets, one a lane: what kernels/quadrature/moments.h gives one by one. Included
// by lane_kernels_source.h; branches of the one-by-one form are choices between lanes here.
#include "kernels/quadrature/moments_terms.h"

namespace sherd {
namespace {

using Mask = decltype(V{} > V{});

inline bool any(Mask m) {
  bool out = false;
  for (std::size_t k = 0; k < kWidth; ++k) out = out || m[k] != 0;
  return out;
}
inline V at_least(V a, double least) {
  return a > least ? a : V{} + least;
}
inline V root(V a) {
  V r;
  for (std::size_t k = 0; k < kWidth; ++k) r[k] = std::sqrt(a[k]);
  return r;
}
inline V dot(const V a[3], const Vec3& b) {
  return a[0] * b.x + a[1] * b.y + a[2] * b.z;
}
inline V dot(const V a[3], const V b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline double dot(const Vec3& a, const double b[3]) {
  return a.x * b[0] + a.y * b[1] + a.z * b[2];
}

// An edge from a to b in the local plane.
struct LaneEdge {
  V au, aw, bu, bw, d;
  double length;
};

// As far_edge and near_edge of moments_terms.cpp, without the cubes.
inline void far_edge(const LaneEdge& g, EdgeMoments<V>& e) {
  constexpr double kNode[4] = {0.18343464249564980494, 0.52553240991632898582, 0.79666647741362673959,
                               0.96028985649753623168};
  constexpr double kWeight[4] = {0.36268378337836198297, 0.31370664587788728734, 0.22238103445337447054,
                                 0.10122853629037625915};
  e.base_u = 0.5 * (g.au + g.bu), e.base_w = 0.5 * (g.aw + g.bw);
  e.step_u = 0.5 * (g.bu - g.au), e.step_w = 0.5 * (g.bw - g.aw);
  const double half = 0.5 * g.length, c2 = half * half;
  const V c0 = e.base_u * e.base_u + e.base_w * e.base_w + g.d * g.d;
  const V c1 = 2 * (e.base_u * e.step_u + e.base_w * e.step_w);
  for (V& k : e.k) k = V{};
  for (int i = 0; i < 8; ++i) {
    const double z = i < 4 ? kNode[i] : -kNode[i - 4];
    V k = half * kWeight[i & 3] * inverse_root_above(c0 + z * (c1 + z * c2), 0);
    for (int a = 0; a < 4; ++a, k *= z) e.k[a] += k;
  }
}

inline void near_edge(const LaneEdge& g, V ra2, V rb2, double tu, double tw, double clamp, EdgeMoments<V>& e) {
  const V sa = g.au * tu + g.aw * tw, sb = g.bu * tu + g.bw * tw;
  const V ra = root(at_least(ra2, clamp)), rb = root(at_least(rb2, clamp));
  const V h2 = at_least(e.p * e.p + g.d * g.d, clamp);
  e.base_u = e.p * e.outward_u, e.base_w = e.p * e.outward_w;
  e.step_u = V{} + tu, e.step_w = V{} + tw;
  const V start = sa >= 0 ? ra + sa : (sb <= 0 ? rb - sb : h2);
  const V quotient = (sa >= 0 ? rb + sb : (sb <= 0 ? ra - sa : (rb + sb) * (ra - sa))) / start;
  for (std::size_t k = 0; k < kWidth; ++k) e.k[0][k] = std::log(quotient[k]);
  e.k[1] = (sb - sa) * (sb + sa) / (ra + rb);
  e.k[2] = 0.5 * (sb * rb - sa * ra - h2 * e.k[0]);
  e.k[3] = (sb * sb * rb - sa * sa * ra - 2 * h2 * e.k[1]) / 3;
}

// Solid angles; lanes close to an edge, where this form loses digits, are taken out of `served`.
inline V solid_angle(const PanelFrame& f, const V q[3][3], V d, Mask& served) {
  const V l[3] = {root(dot(q[0], q[0])), root(dot(q[1], q[1])), root(dot(q[2], q[2]))};
  const V lll = l[0] * l[1] * l[2], sine = 2 * f.area * d;
  const V cosine = lll + dot(q[0], q[1]) * l[2] + dot(q[1], q[2]) * l[0] + dot(q[2], q[0]) * l[1];
  served &= (lll * (sine < 0 ? -sine : sine) <= 4 * (sine * sine + cosine * cosine)) | (d == 0);
  V out{};
  for (std::size_t k = 0; k < kWidth; ++k)
    if (served[k] && d[k] != 0) out[k] = 2 * std::atan2(sine[k], cosine[k]);
  return out;
}

// The panel as a register of targets sees it. `on`: in its plane by definition. Lanes that the closed forms do not
// serve are taken out of `served`.
inline void view(const PanelFrame& f, const V x[3], Mask on, Mask& served, PanelView<V>& v) {
  V q[3][3], centre[3];
  for (int k = 0; k < 3; ++k) {
    const Vec3& a = f.vertex[k];
    q[k][0] = a.x - x[0], q[k][1] = a.y - x[1], q[k][2] = a.z - x[2];
  }
  for (int i = 0; i < 3; ++i) centre[i] = (q[0][i] + q[1][i] + q[2][i]) * (1.0 / 3);
  // Possibly beyond eight altitudes (panel_is_far), where the closed forms cancel.
  served &= (dot(centre, centre) * f.longest2 <= 8 * 8 * 4 * f.area * f.area) | on;
  V r2[3] = {dot(q[0], q[0]), dot(q[1], q[1]), dot(q[2], q[2])};
  V nearest[3];
  for (int i = 0; i < 3; ++i)
    nearest[i] = (r2[0] <= r2[1]) & (r2[0] <= r2[2]) ? q[0][i] : (r2[1] <= r2[2] ? q[1][i] : q[2][i]);
  v.d = on ? V{} : -dot(nearest, f.normal);
  v.omega = solid_angle(f, q, v.d, served);
  const int longest =
      f.length[0] >= f.length[1] ? (f.length[0] >= f.length[2] ? 0 : 2) : (f.length[1] >= f.length[2] ? 1 : 2);
  const Vec3 &along = f.tangent[longest], &out = f.outward[longest];
  const double u_axis[3] = {along.x, along.y, along.z}, w_axis[3] = {-out.x, -out.y, -out.z};
  v.u.x = u_axis[0], v.u.y = u_axis[1], v.u.z = u_axis[2];
  v.w.x = w_axis[0], v.w.y = w_axis[1], v.w.z = w_axis[2];
  v.n.x = f.normal.x, v.n.y = f.normal.y, v.n.z = f.normal.z;
  V u[3], w[3];
  for (int k = 0; k < 3; ++k) {
    u[k] = dot(q[k], v.u), w[k] = dot(q[k], v.w);
    r2[k] = u[k] * u[k] + w[k] * w[k] + v.d * v.d;
  }
  for (int a = 0; a < 3; ++a) {
    const int b = a == 2 ? 0 : a + 1;
    EdgeMoments<V>& e = v.edge[a];
    const double tu = dot(f.tangent[a], u_axis), tw = dot(f.tangent[a], w_axis);
    e.outward_u = tw, e.outward_w = -tu;
    const V from_a = dot(q[a], f.outward[a]), from_b = dot(q[b], f.outward[a]);
    e.p = r2[a] < r2[b] ? from_a : from_b;
    const LaneEdge g{u[a], w[a], u[b], w[b], v.d, f.length[a]};
    const double l2 = g.length * g.length;
    const Mask far = 0.5 * (r2[a] + r2[b]) - 0.25 * l2 > 4 * l2;
    if (any(!far)) near_edge(g, r2[a], r2[b], tu, tw, kPanelClamp * f.longest2, e);
    if (!any(far)) continue;
    EdgeMoments<V> away;
    far_edge(g, away);
    if (!any(!far)) {
      away.outward_u = e.outward_u, away.outward_w = e.outward_w, away.p = e.p;
      e = away;
      continue;
    }
    e.base_u = far ? away.base_u : e.base_u, e.base_w = far ? away.base_w : e.base_w;
    e.step_u = far ? away.step_u : e.step_u, e.step_w = far ? away.step_w : e.step_w;
    for (int k = 0; k < 4; ++k) e.k[k] = far ? away.k[k] : e.k[k];
  }
  const double cs = -f.length[2] / (2 * f.area), ct = -f.length[0] / (2 * f.area);
  v.su = cs * v.edge[2].outward_u, v.sw = cs * v.edge[2].outward_w;
  v.tu = ct * v.edge[0].outward_u, v.tw = ct * v.edge[0].outward_w;
  v.s0 = -(v.su * u[0] + v.sw * w[0]);
  v.t0 = -(v.tu * u[0] + v.tw * w[0]);
}

void panel_moments(const PanelFrame& f, const LaneConstants& c, const double* x, const double* on, double* wanted,
                   LaneMoments& out) {
  for (std::size_t h = 0; h < kLanes; h += kWidth) {
    const V target[3] = {load(x + h), load(x + kLanes + h), load(x + 2 * kLanes + h)};
    const Mask in_plane = load(on + h) > 0, asked = load(wanted + h) > 0;
    Mask served = asked;
    PanelView<V> v;
    view(f, target, in_plane, served, v);
    const PolynomialMoments<V> m(v);
    for (int b = 0; b < 6; ++b)
      for (int k = 0; k < 6; ++k) {
        const V value = m.dyad[b][k] * c.two;
        store(out.kernel[b][k] + h, served ? (k < 3 ? value + m.inverse[b] * c.one : value) : V{});
      }
    for (int b = 0; b < 10; ++b) store(out.angle[b] + h, served ? m.angle[b] * c.angle : V{});
    store(wanted + h, asked & !served ? V{} + 1 : V{});
  }
}

}  // namespace
}  // namespace sherd
