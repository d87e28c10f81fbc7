// What the closed forms of triangle.h and moments.h share: line integrals over one edge and the solid angle, all free
// of cancellation. s runs along the edge from sa to sb, measured from the foot of the target on the edge's line; r^2 =
// s^2 + h2 with h2 the squared distance of the target from that line; d is the height of the target above the panel's
// plane.
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/quadrature/triangle.h"

namespace sherd {

// Clamp of squared lengths, relative to the longest edge: keeps logarithms and quotients finite at edges and vertices.
inline constexpr Real kPanelClamp = 1e-28;

// Integral of 1/l along the edge.
inline Real edge_log(Real sa, Real sb, Real ra, Real rb, Real h2) {
  if (sa >= 0) return std::log((rb + sb) / (ra + sa));
  if (sb <= 0) return std::log((ra - sa) / (rb - sb));
  return std::log((rb + sb) * (ra - sa) / h2);
}

// Integral of 1/l^3 along the edge (e0), and h2 e0 = sb / rb - sa / ra.
struct EdgeCube {
  Real e0, cd;
};
inline EdgeCube edge_cube(Real sa, Real sb, Real ra, Real rb, Real h2) {
  if (sa * sb > 0) {  // the difference would cancel
    const Real e0 = (sb - sa) * (sb + sa) / (ra * rb * (sb * ra + sa * rb));
    return {e0, e0 * h2};
  }
  const Real cd = sb / rb - sa / ra;
  return {cd / h2, cd};
}

// The solid angle of a panel seen from height d, positive on the side of the normal; q[k] = vertex k - x. Van Oosterom
// and Strackee 1983, which keeps the relative accuracy of a small angle but loses digits close to an edge; there the
// sum over the edges (Wilton et al. 1984), which is exact to rounding of 2 pi.
inline Real panel_solid_angle(const PanelFrame& f, const Vec3 (&q)[3], Real d) {
  if (d == 0) return 0;
  const Real l0 = norm(q[0]), l1 = norm(q[1]), l2 = norm(q[2]), lll = l0 * l1 * l2;
  const Real sine = 2 * f.area * d;
  const Real cosine = lll + dot(q[0], q[1]) * l2 + dot(q[1], q[2]) * l0 + dot(q[2], q[0]) * l1;
  // Rounding of `cosine`, lll times epsilon, moves the angle by 2 lll |sine| / (sine^2 + cosine^2) epsilon.
  if (lll * std::abs(sine) <= 4 * (sine * sine + cosine * cosine)) return 2 * std::atan2(sine, cosine);
  const Real l[3] = {l0, l1, l2}, height = std::abs(d);
  Real sum = 0;
  for (int e = 0; e < 3; ++e) {
    const int b = e == 2 ? 0 : e + 1;
    const Real p = dot(l[e] < l[b] ? q[e] : q[b], f.outward[e]), h2 = p * p + d * d;
    sum += std::atan2(p * dot(q[b], f.tangent[e]), h2 + height * l[b]);
    sum -= std::atan2(p * dot(q[e], f.tangent[e]), h2 + height * l[e]);
  }
  return std::copysign(sum, d);
}

// Height and solid angle with the limit that `side` asks for.
struct PlaneTerms {
  Real d = 0, omega = 0;
};
inline PlaneTerms plane_terms(const PanelFrame& f, const Vec3& x, Side side) {
  if (side == Side::kOnSurface) return {0, 0};
  if (side == Side::kInterior) return {0, -2 * std::numbers::pi};
  const Vec3 q[3] = {f.vertex[0] - x, f.vertex[1] - x, f.vertex[2] - x};
  const Real r0 = norm2(q[0]), r1 = norm2(q[1]), r2 = norm2(q[2]);
  // From the nearest corner: rounding is relative to that distance.
  const Real d = -dot(r0 <= r1 && r0 <= r2 ? q[0] : (r1 <= r2 ? q[1] : q[2]), f.normal);
  return {d, panel_solid_angle(f, q, d)};
}

}  // namespace sherd
