#include "engine/mesh/surface_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sherd {
namespace {

constexpr std::size_t kWanted[] = {0, 4, 10, 16, 24};  // vertices per degree

// The corner's faces, grown by rings of smooth neighbours until enough vertices carry a fit of the degree.
std::vector<std::uint32_t> grow_patch(const SurfaceMesh& mesh, const SurfaceCorners& corners, const SurfaceCorner& c,
                                      std::size_t wanted) {
  std::vector<std::uint32_t> faces = c.faces, patch{c.vertex};
  const auto add_vertices = [&](std::size_t from) {
    for (std::size_t i = from; i < faces.size(); ++i)
      for (const std::uint32_t v : mesh.triangles[faces[i]])
        if (std::find(patch.begin(), patch.end(), v) == patch.end()) patch.push_back(v);
  };
  add_vertices(0);
  std::size_t begin = 0;
  while (patch.size() < wanted) {
    const std::size_t end = faces.size();
    for (std::size_t i = begin; i < end; ++i)
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t e = corners.smooth[3 * faces[i] + k];
        if (e != kNone && std::find(faces.begin(), faces.end(), e / 3) == faces.end()) faces.push_back(e / 3);
      }
    if (faces.size() == end) break;
    add_vertices(end);
    begin = end;
  }
  return patch;
}

Real power(Real x, int n) {
  Real p = 1;
  while (n-- > 0) p *= x;
  return p;
}

}  // namespace

SurfaceFit::SurfaceFit(const SurfaceMesh& mesh, const SurfaceCorners& corners, std::size_t corner,
                       const FitOptions& options) {
  const SurfaceCorner& c = corners.corner[corner];
  origin_ = mesh.vertices[c.vertex];
  for (const std::uint32_t f : c.faces) n_ += mesh.area_normal2(f);
  n_ = normalized(n_);
  const Vec3 e1 = any_perpendicular(n_), e2 = cross(n_, e1);
  int degree = std::max(options.degree, options.planar_degree);
  patch_ = grow_patch(mesh, corners, c, kWanted[degree]);
  const auto flat = [&] {
    Real height = 0, size = 0;
    for (const std::uint32_t v : patch_) {
      const Vec3 d = mesh.vertices[v] - origin_;
      height = std::max(height, std::abs(dot(d, n_))), size = std::max(size, norm(d));
    }
    return height <= 1e-3 * size;
  };
  if (degree > options.degree && !flat()) {
    degree = options.degree;
    patch_ = grow_patch(mesh, corners, c, kWanted[degree]);
  }
  // Axes along the principal directions of the patch in the tangent plane, so that strips are aligned.
  Real xx = 0, xy = 0, yy = 0;
  for (const std::uint32_t v : patch_) {
    const Vec3 d = mesh.vertices[v] - origin_;
    const Real x = dot(d, e1), y = dot(d, e2);
    xx += x * x, xy += x * y, yy += y * y;
  }
  const Real angle = 0.5 * std::atan2(2 * xy, xx - yy);
  a_ = e1 * std::cos(angle) + e2 * std::sin(angle);
  b_ = cross(n_, a_);
  nearest_ = 1e300;
  for (std::size_t i = 1; i < patch_.size(); ++i) {
    const Vec3 d = mesh.vertices[patch_[i]] - origin_;
    x_.push_back(dot(d, a_)), y_.push_back(dot(d, b_)), z_.push_back(dot(d, n_));
    hx_ = std::max(hx_, std::abs(x_.back())), hy_ = std::max(hy_, std::abs(y_.back()));
    weight_.push_back(1 / norm(d)), nearest_ = std::min(nearest_, norm(d));
  }
  for (Real& x : x_) x /= hx_;
  for (Real& y : y_) y /= hy_;
  fit(degree);
}

// Gram-Schmidt in order of increasing degree; a monomial whose remaining norm falls below `drop` of its own is left
// out. Returns false when a first derivative was.
bool SurfaceFit::fit_rows(int degree, Real drop) {
  const std::size_t n = x_.size();
  std::vector<std::vector<Real>> q;          // orthonormal columns
  std::vector<std::vector<Real>> r;          // r[k][j]: coefficient of q_j in kept column k
  std::vector<std::array<int, 2>> monomial;  // kept exponents
  for (int d = 1; d <= degree; ++d)
    for (int j = 0; j <= d; ++j) {
      if (q.size() >= n) break;
      std::vector<Real> column(n), coefficient;
      Real own = 0;
      for (std::size_t i = 0; i < n; ++i) {
        column[i] = weight_[i] * power(x_[i], d - j) * power(y_[i], j);
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
      q.push_back(std::move(column)), r.push_back(std::move(coefficient)), monomial.push_back({d - j, j});
    }
  if (monomial.size() < 2 || monomial[0][0] != 1 || monomial[1][1] != 1) return false;
  // coefficients = R^-1 Q^T W data; the first two rows, by forward substitution of the transpose.
  coefficient_.assign(2, std::vector<Real>(n, 0));
  for (std::size_t which = 0; which < 2; ++which) {
    std::vector<Real> z(q.size(), 0);  // z = R^-T e_which, with R_jk = r[k][j]
    for (std::size_t k = which; k < q.size(); ++k) {
      Real s = k == which ? 1 : 0;
      for (std::size_t j = which; j < k; ++j) s -= r[k][j] * z[j];
      z[k] = s / r[k][k];
    }
    for (std::size_t i = 0; i < n; ++i) {
      Real sum = 0;
      for (std::size_t k = which; k < q.size(); ++k) sum += z[k] * q[k][i];
      coefficient_[which][i] = sum * weight_[i];
    }
  }
  return true;
}

void SurfaceFit::fit(int degree) {
  const std::size_t n = x_.size();
  bool ok = false;
  // The safeguard against an ill-conditioned fit (amplification of noise in the values) raises the drop threshold.
  for (Real drop = 0.03; drop < 0.5; drop *= 2) {
    if (!fit_rows(degree, drop)) break;
    ok = true;
    Real sx = 0, sy = 0;
    for (std::size_t i = 0; i < n; ++i) sx += std::abs(coefficient_[0][i]), sy += std::abs(coefficient_[1][i]);
    if (nearest_ * std::max(sx / hx_, sy / hy_) <= 8) break;
  }
  // A collinear patch carries no information: every derivative is zero.
  if (!ok && !fit_rows(1, 1e-6)) coefficient_.clear();
  row_x_.assign(n + 1, 0), row_y_.assign(n + 1, 0);
  if (coefficient_.empty()) return;
  for (std::size_t i = 0; i < n; ++i) {
    row_x_[i + 1] = coefficient_[0][i] / hx_, row_y_[i + 1] = coefficient_[1][i] / hy_;
    row_x_[0] -= row_x_[i + 1], row_y_[0] -= row_y_[i + 1];
    slope_x_ += row_x_[i + 1] * z_[i], slope_y_ += row_y_[i + 1] * z_[i];
  }
}

}  // namespace sherd
