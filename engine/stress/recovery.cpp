#include "engine/stress/recovery.h"

#include <algorithm>
#include <numbers>

#include "kernels/core/error.h"
#include "kernels/core/parallel.h"

namespace sherd {
namespace {

// Smooth neighbour of face e/3 across directed edge e, or kNone at a crease.
std::vector<std::uint32_t> smooth_twins(const SurfaceMesh& mesh, Real feature_angle) {
  std::vector<std::uint32_t> twin = build_twins(mesh);
  const Real limit = std::cos(feature_angle * std::numbers::pi / 180);
  for (std::uint32_t e = 0; e < twin.size(); ++e)
    if (twin[e] != kNone && twin[e] > e) {
      const Vec3 a = normalized(mesh.area_normal2(e / 3)), b = normalized(mesh.area_normal2(twin[e] / 3));
      if (dot(a, b) < limit) twin[twin[e]] = kNone, twin[e] = kNone;
    }
  return twin;
}

// Patch of a corner: its faces, grown by rings of smooth neighbours until enough vertices carry a fit of the degree.
void grow_patch(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& smooth, std::size_t wanted,
                SurfaceCorner& c) {
  std::vector<std::uint32_t> faces = c.faces;
  c.patch.assign(1, c.vertex);
  const auto add_vertices = [&](std::size_t from) {
    for (std::size_t i = from; i < faces.size(); ++i)
      for (const std::uint32_t v : mesh.triangles[faces[i]])
        if (std::find(c.patch.begin(), c.patch.end(), v) == c.patch.end()) c.patch.push_back(v);
  };
  add_vertices(0);
  std::size_t begin = 0;
  while (c.patch.size() < wanted) {
    const std::size_t end = faces.size();
    for (std::size_t i = begin; i < end; ++i)
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t e = smooth[3 * faces[i] + k];
        if (e != kNone && std::find(faces.begin(), faces.end(), e / 3) == faces.end()) faces.push_back(e / 3);
      }
    if (faces.size() == end) return;
    add_vertices(end);
    begin = end;
  }
}

// Tangent axes: principal directions of the patch in the plane of the mean normal, so that strips are aligned.
void choose_frame(const SurfaceMesh& mesh, const SurfaceCorner& c, Vec3& a, Vec3& b, Vec3& n) {
  n = Vec3{};
  for (const std::uint32_t f : c.faces) n += mesh.area_normal2(f);
  n = normalized(n);
  const Vec3 e1 = any_perpendicular(n), e2 = cross(n, e1), x0 = mesh.vertices[c.vertex];
  Real xx = 0, xy = 0, yy = 0;
  for (const std::uint32_t v : c.patch) {
    const Vec3 d = mesh.vertices[v] - x0;
    const Real x = dot(d, e1), y = dot(d, e2);
    xx += x * x, xy += x * y, yy += y * y;
  }
  const Real angle = 0.5 * std::atan2(2 * xy, xx - yy);
  a = e1 * std::cos(angle) + e2 * std::sin(angle);
  b = cross(n, a);
}

// Interpolatory weighted least squares in monomials x^i y^j, 1 <= i + j <= degree, by Gram-Schmidt in order of
// increasing degree; a monomial whose remaining norm falls below `drop` of its own is left out (one-element strips,
// corners). Gives the rows of the two first derivatives at the origin for the points 1..n-1; returns false when a first
// derivative was dropped.
bool fit_rows(const std::vector<Real>& x, const std::vector<Real>& y, const std::vector<Real>& weight, int degree,
              Real drop, std::vector<Real>& row_x, std::vector<Real>& row_y) {
  const std::size_t n = x.size();
  std::vector<std::vector<Real>> q;  // orthonormal columns
  std::vector<std::vector<Real>> r;  // r[k][j]: coefficient of q_j in kept column k
  bool kept_x = false, kept_y = false;
  for (int d = 1; d <= degree; ++d)
    for (int j = 0; j <= d; ++j) {
      if (q.size() >= n) break;
      std::vector<Real> column(n), coefficient;
      Real own = 0;
      for (std::size_t i = 0; i < n; ++i) {
        column[i] = weight[i] * std::pow(x[i], d - j) * std::pow(y[i], j);
        own += column[i] * column[i];
      }
      for (const auto& base : q) {
        Real c = 0;
        for (std::size_t i = 0; i < n; ++i) c += base[i] * column[i];
        for (std::size_t i = 0; i < n; ++i) column[i] -= c * base[i];
        coefficient.push_back(c);
      }
      Real rest = 0;
      for (const Real v : column) rest += v * v;
      if (rest <= drop * drop * own || own == 0) continue;
      rest = std::sqrt(rest);
      for (Real& v : column) v /= rest;
      coefficient.push_back(rest);
      q.push_back(std::move(column)), r.push_back(std::move(coefficient));
      if (d == 1) (j == 0 ? kept_x : kept_y) = true;
    }
  if (!kept_x || !kept_y) return false;
  // coefficients = R^-1 Q^T W data; rows 0 and 1 of R^-1 by forward substitution of the transpose.
  for (std::size_t which = 0; which < 2; ++which) {
    std::vector<Real> z(q.size(), 0);  // z = R^-T e_which, with R_jk = r[k][j]
    for (std::size_t k = 0; k < q.size(); ++k) {
      Real s = k == which ? 1 : 0;
      for (std::size_t j = 0; j < k; ++j) s -= r[k][j] * z[j];
      z[k] = s / r[k][k];
    }
    std::vector<Real>& row = which == 0 ? row_x : row_y;
    row.assign(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < q.size(); ++k) row[i] += z[k] * q[k][i];
      row[i] *= weight[i];
    }
  }
  return true;
}

void fit(const SurfaceMesh& mesh, int degree, SurfaceCorner& c) {
  Vec3 a, b, n;
  choose_frame(mesh, c, a, b, n);
  const std::size_t count = c.patch.size() - 1;
  std::vector<Real> x(count), y(count), z(count), weight(count);
  Real hx = 0, hy = 0, nearest = 1e300;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 d = mesh.vertices[c.patch[i + 1]] - mesh.vertices[c.vertex];
    x[i] = dot(d, a), y[i] = dot(d, b), z[i] = dot(d, n);
    hx = std::max(hx, std::abs(x[i])), hy = std::max(hy, std::abs(y[i]));
    weight[i] = 1 / norm(d), nearest = std::min(nearest, norm(d));
  }
  for (std::size_t i = 0; i < count; ++i) x[i] /= hx, y[i] /= hy;
  std::vector<Real> px, py;
  // The safeguard against an ill-conditioned fit (amplification of noise in the values) raises the drop threshold.
  bool ok = false;
  for (Real drop = 0.03; drop < 0.5; drop *= 2) {
    if (!fit_rows(x, y, weight, degree, drop, px, py)) break;
    ok = true;
    Real sx = 0, sy = 0;
    for (std::size_t i = 0; i < count; ++i) sx += std::abs(px[i]), sy += std::abs(py[i]);
    if (nearest * std::max(sx / hx, sy / hy) <= 8) break;
  }
  if (!ok) ok = fit_rows(x, y, weight, 1, 1e-6, px, py);
  if (!ok) px.assign(count, 0), py.assign(count, 0);  // collinear patch: no information, no stress from it
  c.row_x.assign(count + 1, 0), c.row_y.assign(count + 1, 0);
  Real zx = 0, zy = 0;
  for (std::size_t i = 0; i < count; ++i) {
    c.row_x[i + 1] = px[i] / hx, c.row_y[i + 1] = py[i] / hy;
    c.row_x[0] -= c.row_x[i + 1], c.row_y[0] -= c.row_y[i + 1];
    zx += c.row_x[i + 1] * z[i], zy += c.row_y[i + 1] * z[i];
  }
  c.tangent_x = a + n * zx, c.tangent_y = b + n * zy;
  c.normal = normalized(cross(c.tangent_x, c.tangent_y));
}

}  // namespace

SurfaceRecovery::SurfaceRecovery(const SurfaceMesh& mesh, const RecoveryOptions& options) {
  SHERD_CHECK(options.degree >= 1 && options.degree <= 3, "degree {}", options.degree);
  const std::vector<std::uint32_t> smooth = smooth_twins(mesh, options.feature_angle);
  corner_of_.assign(3 * mesh.triangle_count(), kNone);
  for (std::uint32_t e = 0; e < corner_of_.size(); ++e) {
    if (corner_of_[e] != kNone) continue;
    SurfaceCorner c;
    c.vertex = mesh.triangles[e / 3][e % 3];
    // Walk the smooth fan around the vertex both ways from this face.
    const auto id = static_cast<std::uint32_t>(corners_.size());
    std::vector<std::uint32_t> stack{e};
    corner_of_[e] = id;
    while (!stack.empty()) {
      const std::uint32_t h = stack.back(), t = h / 3, k = h % 3;
      stack.pop_back();
      c.faces.push_back(t);
      const std::uint32_t next = smooth[3 * t + k], before = smooth[3 * t + (k + 2) % 3];
      for (const std::uint32_t candidate : {next == kNone ? kNone : 3 * (next / 3) + (next % 3 + 1) % 3, before})
        if (candidate != kNone && corner_of_[candidate] == kNone)
          corner_of_[candidate] = id, stack.push_back(candidate);
    }
    std::sort(c.faces.begin(), c.faces.end());
    corners_.push_back(std::move(c));
  }
  const std::size_t wanted = options.degree == 3 ? 16 : (options.degree == 2 ? 10 : 4);
  parallel_for(corners_.size(), 32, [&](std::size_t i) {
    grow_patch(mesh, smooth, wanted, corners_[i]);
    fit(mesh, options.degree, corners_[i]);
  });
}

std::vector<Sym3> SurfaceRecovery::stress(const Vec3Column& displacement, const Vec3Column& traction,
                                          const Elastic& m) const {
  std::vector<Sym3> out(corners_.size());
  const Real young = 2 * m.mu * (1 + m.nu);
  parallel_for(corners_.size(), 256, [&](std::size_t i) {
    const SurfaceCorner& c = corners_[i];
    Vec3 dx, dy;
    for (std::size_t k = 0; k < c.patch.size(); ++k) {
      const Vec3 u = displacement[c.patch[k]];
      dx += u * c.row_x[k], dy += u * c.row_y[k];
    }
    // Surface gradient G with G tangent_x = dx, G tangent_y = dy, G normal = 0.
    const Mat3 g = Mat3::from_columns(dx, dy, Vec3{}) * inverse(Mat3::from_columns(c.tangent_x, c.tangent_y, c.normal));
    const Vec3 n = c.normal, e1 = any_perpendicular(n), e2 = cross(n, e1), t = traction[i];
    const Real e11 = dot(e1, g * e1), e22 = dot(e2, g * e2), e12 = 0.5 * (dot(e1, g * e2) + dot(e2, g * e1));
    const Real plane = young / (1 - m.nu * m.nu), tn = dot(t, n), pressure = m.nu / (1 - m.nu) * tn;
    const Real s11 = plane * (e11 + m.nu * e22) + pressure, s22 = plane * (e22 + m.nu * e11) + pressure,
               s12 = 2 * m.mu * e12;
    const Mat3 s = outer(e1, e1) * s11 + outer(e2, e2) * s22 + (outer(e1, e2) + outer(e2, e1)) * s12 +
                   outer(n, n) * tn + (outer(e1, n) + outer(n, e1)) * dot(t, e1) +
                   (outer(e2, n) + outer(n, e2)) * dot(t, e2);
    out[i] = symmetric_part(s);
  });
  return out;
}

}  // namespace sherd
