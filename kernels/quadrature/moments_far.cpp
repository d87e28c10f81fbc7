#include <limits>

#include "kernels/quadrature/moments_terms.h"

namespace sherd {
namespace {

// Nearer targets (in altitudes of the panel over its longest edge) are left to the closed forms, whose monomials lose
// about (distance / altitude)^4 units of rounding.
constexpr Real kFarAltitudes = 8;

// Gauss-Legendre on [-1, 1] (Abramowitz and Stegun 1964, table 25.4); the other half by symmetry.
constexpr Real kAlong[4] = {0.18343464249564980494, 0.52553240991632898582, 0.79666647741362673959,
                            0.96028985649753623168};
constexpr Real kAlongWeight[4] = {0.36268378337836198297, 0.31370664587788728734, 0.22238103445337447054,
                                  0.10122853629037625915};
constexpr Real kAcross[3] = {0.23861918608319690863, 0.66120938646626451366, 0.93246951420315202781};
constexpr Real kAcrossWeight[3] = {0.46791393457269104739, 0.36076157304813860757, 0.17132449237917034504};

// The panel over its longest edge a -> b, split at the foot of the apex.
struct Strip {
  Vec3 a, along, up;  // along: the edge; up: the altitude
  Real length, altitude, foot;
  int apex;  // corner
};

Strip make_strip(const PanelFrame& f) {
  Strip s;
  const int e =
      f.length[0] >= f.length[1] ? (f.length[0] >= f.length[2] ? 0 : 2) : (f.length[1] >= f.length[2] ? 1 : 2);
  s.apex = (e + 2) % 3;
  s.length = f.length[e];
  s.altitude = 2 * f.area / s.length;
  s.a = f.vertex[e];
  s.along = f.tangent[e] * s.length;
  s.up = f.outward[e] * -s.altitude;
  s.foot = std::clamp(dot(f.vertex[s.apex] - s.a, f.tangent[e]) / s.length, 0.0, 1.0);
  return s;
}

// Distance of x from the point xi of the base, less the altitude: a bound for the strip there.
Real strip_distance(const Strip& s, const Vec3& x, Real xi) {
  return std::max(distance(x, s.a + s.along * xi) - s.altitude, s.altitude);
}

// Calls visit(weight, r, monomial of degree <= 3) at the Gauss points. Pieces of the base are at most a fifth of their
// distance long and strips at least seven altitudes away: 8 points along and 6 across err below 1e-13.
template <class Visit>
void for_far_points(const PanelFrame& f, const Vec3& x, Visit&& visit) {
  const Strip strip = make_strip(f);
  const Vec3 origin = x - strip.a;
  const auto piece = [&](Real x0, Real x1, Real slope, Real zero) {
    for (int i = 0; i < 8; ++i) {
      const Real half = 0.5 * (x1 - x0), node = i < 4 ? kAlong[i] : -kAlong[i - 4];
      const Real xi = 0.5 * (x0 + x1) + half * node, top = slope * (xi - zero);
      for (int j = 0; j < 6; ++j) {
        const Real eta =
            top * 0.5 * (1 + (j < 3 ? kAcross[j] : -kAcross[j - 3]));  // barycentric coordinate of the apex
        const Real second = xi - eta * strip.foot, corner[3] = {1 - second - eta, second, eta};
        const int to_first = (strip.apex + 1) % 3;  // corner at the base's start
        const Real s = corner[(4 - to_first) % 3], t = corner[(5 - to_first) % 3];
        const Real weight = f.area * half * kAlongWeight[i & 3] * kAcrossWeight[j % 3] * top;
        const Real monomial[kCubicMonomials] = {1,     s,         t,         s * s,     s * t,
                                                t * t, s * s * s, s * s * t, s * t * t, t * t * t};
        visit(weight, origin - strip.along * xi - strip.up * eta, monomial);
      }
    }
  };
  const auto half_panel = [&](Real x0, Real x1, Real slope, Real zero) {
    for (Real xi = x0; xi < x1;) {
      const Real step = strip_distance(strip, x, xi) / (5 * strip.length);
      const Real next = xi + 1.5 * step < x1 ? xi + step : x1;
      piece(xi, next, slope, zero);
      xi = next;
    }
  };
  if (strip.foot > 0) half_panel(0, strip.foot, 1 / strip.foot, 0);
  if (strip.foot < 1) half_panel(strip.foot, 1, -1 / (1 - strip.foot), 1);
}

Sym3 square(const Vec3& r) {
  return {r.x * r.x, r.y * r.y, r.z * r.z, r.y * r.z, r.x * r.z, r.x * r.y};
}

// sum[m] += monomial[m] row, in rows that fill whole vector registers.
template <int Rows, int Columns>
void accumulate(const Real* monomial, const Real (&row)[Columns], Real (&sum)[Rows][Columns]) {
  for (int m = 0; m < Rows; ++m)
    for (int c = 0; c < Columns; ++c) sum[m][c] += monomial[m] * row[c];
}

}  // namespace

bool panel_is_far(const PanelFrame& f, const Vec3& x) {
  // Squared (kFarAltitudes altitudes), times the longest edge squared.
  const Real far2 = kFarAltitudes * kFarAltitudes * 4 * f.area * f.area;
  if (distance2(x, f.centroid()) * f.longest2 <= far2) return false;
  const Vec3 q = x - f.vertex[0];
  const Real height = dot(q, f.normal);
  bool inside = true;
  Real nearest2 = std::numeric_limits<Real>::infinity();
  for (int e = 0; e < 3; ++e) {
    const Vec3 a = x - f.vertex[e];
    const Real s = std::clamp(dot(a, f.tangent[e]), 0.0, f.length[e]);
    nearest2 = std::min(nearest2, norm2(a - f.tangent[e] * s));
    inside = inside && dot(a, f.outward[e]) <= 0;
  }
  if (inside) nearest2 = height * height;
  return nearest2 * f.longest2 > far2;
}

void far_moments(const PanelFrame& f, const Vec3& x, PanelMoments& out) {
  Real sum[kCubicMonomials][8] = {};  // inverse, angle, dyad
  for_far_points(f, x, [&](Real weight, const Vec3& r, const Real(&monomial)[kCubicMonomials]) {
    const Real one = 1 / norm(r), w1 = weight * one, w3 = w1 * one * one;
    const Sym3 a = square(r) * w3;
    const Real row[8] = {w1, w3 * dot(r, f.normal), a.xx, a.yy, a.zz, a.yz, a.xz, a.xy};
    accumulate(monomial, row, sum);
  });
  for (int m = 0; m < kCubicMonomials; ++m) out.angle[m] = sum[m][1];
  for (int m = 0; m < kQuadraticMonomials; ++m) {
    const Real(&q)[8] = sum[m];
    out.inverse[m] = q[0];
    out.dyad[m] = {q[2], q[3], q[4], q[5], q[6], q[7]};
  }
}

void far_moment_gradients(const PanelFrame& f, const Vec3& x, PanelMomentGradients& out) {
  // Integrals of r / l^3 and of r_i r_j r_k / l^5, in the order xxx, yyy, zzz, xxy, xxz, yyx, yyz, zzx, zzy, xyz.
  Real sum[kQuadraticMonomials][16] = {};
  for_far_points(f, x, [&](Real weight, const Vec3& r, const Real(&monomial)[kCubicMonomials]) {
    const Real one = 1 / norm(r), w3 = weight * one * one * one;
    const Vec3 g = r * w3, e = r * one;
    const Real xx = e.x * e.x, yy = e.y * e.y, zz = e.z * e.z;
    const Real row[16] = {g.x,      g.y,      g.z,      xx * g.x, yy * g.y,        zz * g.z, xx * g.y, xx * g.z,
                          yy * g.x, yy * g.z, zz * g.x, zz * g.y, g.x * e.y * e.z, 0,        0,        0};
    accumulate(monomial, row, sum);
  });
  for (int m = 0; m < kQuadraticMonomials; ++m) {
    const Real(&q)[16] = sum[m];
    const Real x1 = q[0], y1 = q[1], z1 = q[2], *t = q + 3;
    out.inverse[m] = {-x1, -y1, -z1};
    // (delta_ik r_j + delta_jk r_i) / l^3 - 3 r_i r_j r_k / l^5
    const Real xyz = -3 * t[9];
    out.dyad[0][m] = {2 * x1 - 3 * t[0], -3 * t[5], -3 * t[7], xyz, z1 - 3 * t[4], y1 - 3 * t[3]};
    out.dyad[1][m] = {-3 * t[3], 2 * y1 - 3 * t[1], -3 * t[8], z1 - 3 * t[6], xyz, x1 - 3 * t[5]};
    out.dyad[2][m] = {-3 * t[4], -3 * t[6], 2 * z1 - 3 * t[2], y1 - 3 * t[8], x1 - 3 * t[7], xyz};
  }
}

}  // namespace sherd
