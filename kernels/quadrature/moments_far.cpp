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

constexpr int kPoints = 48;

// The Gauss points of one piece: weight with the area, r = x - y, monomials.
struct PiecePoints {
  alignas(32) Real weight[kPoints], x[kPoints], y[kPoints], z[kPoints], monomial[kCubicMonomials][kPoints];
};

// The piece [x0, x1] of the base; the panel's edge rises from `zero` to 1 at the foot.
void place_points(const PanelFrame& f, const Strip& strip, const Vec3& origin, Real x0, Real x1, Real zero,
                  PiecePoints& out) {
  const Real half = 0.5 * (x1 - x0), slope = 1 / (strip.foot - zero);
  const int start = (strip.apex + 1) % 3;  // corner at the base's start
  const int s_corner = (4 - start) % 3, t_corner = (5 - start) % 3;
  for (int i = 0; i < 8; ++i) {
    const Real xi = 0.5 * (x0 + x1) + half * (i < 4 ? kAlong[i] : -kAlong[i - 4]), top = slope * (xi - zero);
    const Vec3 foot = origin - strip.along * xi;
    for (int j = 0; j < 6; ++j) {
      const int k = 6 * i + j;
      const Real eta = top * 0.5 * (1 + (j < 3 ? kAcross[j] : -kAcross[j - 3]));  // barycentric coordinate of the apex
      const Real second = xi - eta * strip.foot, corner[3] = {1 - second - eta, second, eta};
      const Vec3 r = foot - strip.up * eta;
      out.weight[k] = f.area * half * kAlongWeight[i & 3] * kAcrossWeight[j % 3] * top;
      out.x[k] = r.x, out.y[k] = r.y, out.z[k] = r.z;
      out.monomial[1][k] = corner[s_corner], out.monomial[2][k] = corner[t_corner];
    }
  }
  Real(&m)[kCubicMonomials][kPoints] = out.monomial;
  for (int k = 0; k < kPoints; ++k) {
    const Real s = m[1][k], t = m[2][k];
    m[0][k] = 1, m[3][k] = s * s, m[4][k] = s * t, m[5][k] = t * t;
    m[6][k] = s * s * s, m[7][k] = s * s * t, m[8][k] = s * t * t, m[9][k] = t * t * t;
  }
}

// Calls visit(points) for pieces of the base at most a fifth of their distance long, in strips at least seven altitudes
// away: 8 points along and 6 across err below 1e-13.
template <class Visit>
void for_far_pieces(const PanelFrame& f, const Vec3& x, Visit&& visit) {
  const Strip strip = make_strip(f);
  const Vec3 origin = x - strip.a;
  PiecePoints points;
  const auto half_panel = [&](Real x0, Real x1, Real zero) {
    for (Real xi = x0; xi < x1;) {
      const Real step = strip_distance(strip, x, xi) / (5 * strip.length);
      const Real next = xi + 1.5 * step < x1 ? xi + step : x1;
      place_points(f, strip, origin, xi, next, zero, points);
      visit(points);
      xi = next;
    }
  };
  half_panel(0, strip.foot, 0);
  half_panel(strip.foot, 1, 1);
}

// sum[m][c] += the sum over the points of monomial[m] row[c]; four partial sums fill a vector register.
template <int Rows, int Columns>
void accumulate(const PiecePoints& points, const Real (&row)[Columns][kPoints], Real (&sum)[Rows][Columns]) {
  for (int m = 0; m < Rows; ++m)
    for (int c = 0; c < Columns; ++c) {
      Real part[4] = {};
      for (int k = 0; k < kPoints; k += 4)
        for (int lane = 0; lane < 4; ++lane) part[lane] += points.monomial[m][k + lane] * row[c][k + lane];
      sum[m][c] += (part[0] + part[1]) + (part[2] + part[3]);
    }
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
  Real angle[kCubicMonomials][1] = {}, sum[kQuadraticMonomials][7] = {};  // inverse, dyad
  alignas(32) Real angle_row[1][kPoints], row[7][kPoints];
  for_far_pieces(f, x, [&](const PiecePoints& p) {
    for (int k = 0; k < kPoints; ++k) {
      const Real rx = p.x[k], ry = p.y[k], rz = p.z[k];
      const Real one = 1 / std::sqrt(rx * rx + ry * ry + rz * rz), w1 = p.weight[k] * one, w3 = w1 * one * one;
      angle_row[0][k] = w3 * (rx * f.normal.x + ry * f.normal.y + rz * f.normal.z);
      row[0][k] = w1;
      row[1][k] = w3 * rx * rx, row[2][k] = w3 * ry * ry, row[3][k] = w3 * rz * rz;
      row[4][k] = w3 * ry * rz, row[5][k] = w3 * rx * rz, row[6][k] = w3 * rx * ry;
    }
    accumulate(p, angle_row, angle);
    accumulate(p, row, sum);
  });
  for (int m = 0; m < kCubicMonomials; ++m) out.angle[m] = angle[m][0];
  for (int m = 0; m < kQuadraticMonomials; ++m) {
    const Real(&q)[7] = sum[m];
    out.inverse[m] = q[0];
    out.dyad[m] = {q[1], q[2], q[3], q[4], q[5], q[6]};
  }
}

void far_moment_gradients(const PanelFrame& f, const Vec3& x, PanelMomentGradients& out) {
  // Integrals of r / l^3 and of r_i r_j r_k / l^5, in the order xxx, yyy, zzz, xxy, xxz, yyx, yyz, zzx, zzy, xyz.
  Real sum[kQuadraticMonomials][13] = {};
  alignas(32) Real row[13][kPoints];
  for_far_pieces(f, x, [&](const PiecePoints& p) {
    for (int k = 0; k < kPoints; ++k) {
      const Real rx = p.x[k], ry = p.y[k], rz = p.z[k];
      const Real one = 1 / std::sqrt(rx * rx + ry * ry + rz * rz), w3 = p.weight[k] * one * one * one;
      const Real gx = rx * w3, gy = ry * w3, gz = rz * w3, ex = rx * one, ey = ry * one, ez = rz * one;
      row[0][k] = gx, row[1][k] = gy, row[2][k] = gz;
      row[3][k] = ex * ex * gx, row[4][k] = ey * ey * gy, row[5][k] = ez * ez * gz;
      row[6][k] = ex * ex * gy, row[7][k] = ex * ex * gz, row[8][k] = ey * ey * gx, row[9][k] = ey * ey * gz;
      row[10][k] = ez * ez * gx, row[11][k] = ez * ez * gy, row[12][k] = ex * ey * gz;
    }
    accumulate(p, row, sum);
  });
  for (int m = 0; m < kQuadraticMonomials; ++m) {
    const Real(&q)[13] = sum[m];
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
