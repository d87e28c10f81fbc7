#include "engine/elastostatic/dense_operator.h"

#include <fmt/format.h>

#include <numbers>

#include "kernels/core/parallel.h"
#include "kernels/quadrature/gauss.h"

namespace sherd {
namespace {

// K = integral of 2 mu U - I/(4 pi l) over a panel = one a I + two M; both single layers act on the same density M u.
struct KernelConstants {
  Real one, two, angle;
  explicit KernelConstants(Real nu) {
    two = 1 / (8 * std::numbers::pi * (1 - nu));
    one = (3 - 4 * nu) * two - 1 / (4 * std::numbers::pi);
    angle = 1 / (4 * std::numbers::pi);
  }
};

// What one (target, panel) pair contributes: the matrix K and the double-layer weights of the three corners.
struct PairTerms {
  Mat3 kernel;
  Vec3 weight;
};

template <std::size_t N>
PairTerms gauss_pair(const PanelFrame& f, const Vec3& x, const std::array<TrianglePoint, N>& rule,
                     const KernelConstants& c) {
  PairTerms out;
  for (const TrianglePoint& g : rule) {
    const Vec3 r = x - (f.vertex[0] * g.a + f.vertex[1] * g.b + f.vertex[2] * g.c);
    const Real inverse2 = 1 / norm2(r), inverse = std::sqrt(inverse2), w = g.weight * f.area * inverse;
    for (int i = 0; i < 3; ++i) {
      out.kernel[i][i] += c.one * w;
      for (int j = 0; j < 3; ++j) out.kernel[i][j] += c.two * w * inverse2 * r[i] * r[j];
    }
    const Real k = w * inverse2 * dot(r, f.normal);
    out.weight += Vec3{g.a, g.b, g.c} * (c.angle * k);
  }
  return out;
}

PairTerms pair_terms(const Boundary& b, std::size_t t, const Vec3& x, bool incident, const KernelConstants& c) {
  const PanelFrame& f = b.panels[t];
  const Real d2 = distance2(x, b.centroid[t]);
  if (!incident && d2 > b.middle2[t]) return gauss_pair(f, x, kGauss3, c);
  if (!incident && d2 > b.near2[t]) return gauss_pair(f, x, kGauss7, c);
  PanelValues v;
  integrate_panel(f, x, incident ? Side::kOnSurface : Side::kAway, v);
  return {v.dyad * c.two + Mat3::identity() * (c.one * v.inverse), v.shape_angle * c.angle};
}

// The three rows of vertex p.
void fill_direct_rows(const Boundary& b, const KernelConstants& constants, std::size_t p, std::span<Real> row) {
  const std::size_t size = row.size() / 3;
  const Vec3 x = b.mesh.vertices[p];
  const auto add = [&](std::size_t column, const Mat3& block) {
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) row[i * size + 3 * column + j] += block.m[i][j];
  };
  Real total = 0;
  for (std::size_t t = 0; t < b.panels.size(); ++t) {
    const Triangle& v = b.mesh.triangles[t];
    const bool incident = v[0] == p || v[1] == p || v[2] == p;
    const PairTerms terms = pair_terms(b, t, x, incident, constants);
    const Vec3& n = b.panels[t].normal;
    for (int a = 0; a < 3; ++a) {
      const Vec3 g = b.panels[t].shape_gradient(a);
      // M u = sum_a (g n^T - n g^T) u_a on a flat P1 triangle
      Mat3 block = outer(terms.kernel * g, n) - outer(terms.kernel * n, g);
      for (int i = 0; i < 3; ++i) block[i][i] += terms.weight[a];
      add(v[static_cast<std::size_t>(a)], block);
      total += terms.weight[a];
    }
  }
  add(p, Mat3::identity() * -total);
}

}  // namespace

template <class Scalar>
DenseOperator<Scalar>::DenseOperator(std::size_t points, const std::function<void(std::size_t, std::span<Real>)>& fill)
    : size_(3 * points), matrix_(size_ * size_) {
  parallel_for_chunks(points, 8, [&](std::size_t begin, std::size_t end) {
    std::vector<Real> rows(3 * size_);
    for (std::size_t p = begin; p < end; ++p) {
      std::fill(rows.begin(), rows.end(), 0);
      fill(p, rows);
      for (std::size_t i = 0; i < rows.size(); ++i) matrix_[3 * p * size_ + i] = static_cast<Scalar>(rows[i]);
    }
  });
}

template <class Scalar>
DenseOperator<Scalar>::DenseOperator(const Boundary& b, Real nu)
    : DenseOperator(b.mesh.vertex_count(), [&b, constants = KernelConstants(nu)](std::size_t p, std::span<Real> rows) {
        fill_direct_rows(b, constants, p, rows);
      }) {}

template <class Scalar>
void DenseOperator<Scalar>::apply(std::span<const Real> x, std::span<Real> y) const {
  // Products in double even for float storage: rounding the vector would cost thin bodies, whose displacement is
  // thousands of times the right-hand side, three digits of the residual. Eight partial sums let the compiler
  // vectorise.
  parallel_for(size_, 64, [&](std::size_t i) {
    const Scalar* row = matrix_.data() + i * size_;
    Real partial[8] = {};
    std::size_t j = 0;
    for (; j + 8 <= size_; j += 8)
      for (std::size_t k = 0; k < 8; ++k) partial[k] += static_cast<Real>(row[j + k]) * x[j + k];
    for (std::size_t k = 0; j < size_; ++j, ++k) partial[k] += static_cast<Real>(row[j]) * x[j];
    Real sum = 0;
    for (const Real v : partial) sum += v;
    y[i] = sum;
  });
}

template <class Scalar>
void DenseOperator<Scalar>::apply_block(std::span<const Real> x, std::size_t count, std::span<Real> y) const {
  constexpr std::size_t kLanes = 16;  // vectors a pass: the matrix is read once for all of them
  std::vector<Scalar> narrow(size_ * kLanes);
  for (std::size_t first = 0; first < count; first += kLanes) {
    const std::size_t lanes = std::min(kLanes, count - first);
    for (std::size_t i = 0; i < size_; ++i)
      for (std::size_t k = 0; k < kLanes; ++k)
        narrow[i * kLanes + k] = k < lanes ? static_cast<Scalar>(x[i * count + first + k]) : Scalar(0);
    // A vertex's three rows together: six accumulators hide the latency of an addition.
    parallel_for(size_ / 3, 16, [&](std::size_t p) {
      const Scalar* row = matrix_.data() + 3 * p * size_;
      Real sum[3][kLanes] = {};
      for (std::size_t j0 = 0; j0 < size_; j0 += 256) {
        const std::size_t j1 = std::min(j0 + 256, size_);
        Scalar a[kLanes] = {}, b[kLanes] = {}, c[kLanes] = {};
        for (std::size_t j = j0; j < j1; ++j)
          for (std::size_t k = 0; k < kLanes; ++k) {
            const Scalar v = narrow[j * kLanes + k];
            a[k] += row[j] * v, b[k] += row[size_ + j] * v, c[k] += row[2 * size_ + j] * v;
          }
        for (std::size_t k = 0; k < kLanes; ++k)
          sum[0][k] += static_cast<Real>(a[k]), sum[1][k] += static_cast<Real>(b[k]),
              sum[2][k] += static_cast<Real>(c[k]);
      }
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < lanes; ++k) y[(3 * p + i) * count + first + k] = sum[i][k];
    });
  }
}

template <class Scalar>
Mat3 DenseOperator<Scalar>::diagonal_block(std::size_t p) const {
  Mat3 block;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) block.m[i][j] = static_cast<Real>(matrix_[(3 * p + i) * size_ + 3 * p + j]);
  return block;
}

std::string too_large(std::size_t triangles, std::size_t size, bool double_storage, std::size_t max_bytes) {
  const std::size_t bytes = size * size * (double_storage ? sizeof(double) : sizeof(float));
  if (bytes <= max_bytes) return {};
  return fmt::format("{} triangles need a dense operator of {} MiB, more than the {} MiB allowed: raise edge_length",
                     triangles, bytes >> 20, max_bytes >> 20);
}

template class DenseOperator<float>;
template class DenseOperator<double>;

}  // namespace sherd
