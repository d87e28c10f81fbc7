#include "kernels/fmm/translations.h"

#include <Eigen/Dense>
#include <algorithm>
#include <map>
#include <mutex>
#include <numbers>
#include <tuple>

#include "kernels/core/parallel.h"
#include "kernels/fmm/kernel_matrix.h"
#include "kernels/fmm/rbf.h"

namespace sherd::fmm {
namespace {

using Matrix = Eigen::MatrixXd;
using Eigen::Index;

constexpr Real kInner = 1.05, kOuter = 2.95;  // sides of the cubes
constexpr Real kInverseCut = 1e-10;           // singular values of the surface equation that are kept

// Points on the surface of the cube [-1/2, 1/2]^3 in the positive octant; the rest are their reflections. No coordinate
// vanishes, so that every point has eight. Even resolutions: grids up to the cube's edges; odd ones: centres of the
// cells of a grid one finer than the even number below.
std::vector<Vec3> octant_points(int resolution) {
  const bool cells = resolution % 2 == 1;
  const int n = resolution - (cells ? 1 : 0);
  const auto coordinate = [&](int i) { return cells ? (i + 0.5) / n - 0.5 : i / (n - 1.0) - 0.5; };
  std::vector<Vec3> out;
  for (int axis = 0; axis < 3; ++axis)
    for (int i = n / 2; i < n; ++i)
      for (int j = n / 2; j < n; ++j) {
        // A grid point on an edge belongs to the first of its faces.
        if (!cells && ((axis > 0 && (axis == 1 ? j : i) == n - 1) || (axis == 2 && j == n - 1))) continue;
        Vec3 p;
        p[axis] = 0.5, p[(axis + 1) % 3] = coordinate(i), p[(axis + 2) % 3] = coordinate(j);
        out.push_back(p);
      }
  return out;
}

Vec3 reflect(const Vec3& x, unsigned s) {
  return {s & 1 ? -x.x : x.x, s & 2 ? -x.y : x.y, s & 4 ? -x.z : x.z};
}
Real sign(unsigned s) {
  return __builtin_popcount(s) % 2 ? -1 : 1;
}

// Works in the basis of fields that are even or odd under each reflection, where everything that commutes with
// reflections falls into eight blocks.
class Builder {
 public:
  Builder(const TranslationOptions& options)
      : options_(options),
        kernel_(options),
        inner_(octant_points(options.inner)),
        outer_(octant_points(options.outer)),
        block_(static_cast<Index>(kernel_.dim * inner_.size())) {
    for (Vec3& p : inner_) p = p * kInner;
    for (Vec3& p : outer_) p = p * kOuter;
  }

  Translations build() {
    Translations t;
    t.dim = kernel_.dim;
    t.inner = images(inner_), t.outer = images(outer_);
    inverse_surface();
    excitation();
    observation();
    truncate(t);
    for (unsigned o = 0; o < 8; ++o) {
      std::vector<Vec3> child = t.inner;
      for (Vec3& p : child) p = p * 0.5 + reflect({-0.25, -0.25, -0.25}, o);
      t.merge[o] = t.up * (kernel_matrix(kernel_, t.outer, child) * t.spread);
    }
    far_matrices(t);
    return t;
  }

 private:
  static std::vector<Vec3> images(const std::vector<Vec3>& octant) {
    std::vector<Vec3> out;
    for (unsigned s = 0; s < 8; ++s)
      for (const Vec3& p : octant) out.push_back(reflect(p, s));
    return out;
  }
  // Sign of a vector's component j under reflections s, and of a block of parity b.
  Real component_sign(unsigned s, std::size_t j) const { return kernel_.dim == 3 && (s >> j) & 1 ? -1 : 1; }

  // Block b of an operator that commutes with reflections, between points of the positive octant and their images.
  Matrix block(unsigned b, const std::vector<Vec3>& targets, const std::vector<Vec3>& sources) const {
    const std::size_t d = kernel_.dim;
    Matrix out = Matrix::Zero(static_cast<Index>(d * targets.size()), static_cast<Index>(d * sources.size()));
    Real k[3][3];
    for (std::size_t q = 0; q < sources.size(); ++q)
      for (unsigned s = 0; s < 8; ++s)
        for (std::size_t p = 0; p < targets.size(); ++p) {
          kernel_(targets[p] - reflect(sources[q], s), k);
          for (std::size_t j = 0; j < d; ++j)
            for (std::size_t i = 0; i < d; ++i)
              out(static_cast<Index>(d * p + i), static_cast<Index>(d * q + j)) +=
                  sign(s & b) * component_sign(s, j) * k[i][j];
        }
    return out;
  }

  // Rows of a full surface matrix to block b: what even and odd fields pick.
  Matrix fold(unsigned b, const Matrix& full) const {
    Matrix out = Matrix::Zero(block_, full.cols());
    for (unsigned s = 0; s < 8; ++s)
      for (Index i = 0; i < block_; ++i)
        out.row(i) += full.row(static_cast<Index>(s) * block_ + i) *
                      (sign(s & b) * component_sign(s, static_cast<std::size_t>(i) % kernel_.dim) / std::sqrt(8.0));
    return out;
  }
  // Its transpose: columns of block b to the full surface.
  Matrix unfold(unsigned b, const Matrix& part) const {
    const Index n = part.rows();
    Matrix out(8 * n, part.cols());
    for (unsigned s = 0; s < 8; ++s)
      for (Index i = 0; i < n; ++i)
        out.row(static_cast<Index>(s) * n + i) =
            part.row(i) * (sign(s & b) * component_sign(s, static_cast<std::size_t>(i) % kernel_.dim) / std::sqrt(8.0));
    return out;
  }

  // Density on the inner surface from the potential on the outer one.
  void inverse_surface() {
    parallel_for(8, 1, [&](std::size_t b) {
      const Eigen::BDCSVD<Matrix> svd(block(static_cast<unsigned>(b), outer_, inner_),
                                      Eigen::ComputeThinU | Eigen::ComputeThinV);
      Eigen::VectorXd w = svd.singularValues();
      for (Index i = 0; i < w.size(); ++i) w[i] = w[i] > kInverseCut * w[0] ? 1 / w[i] : 0;
      solve_[b] = svd.matrixV() * w.asDiagonal(), modes_[b] = svd.matrixU().transpose();
    });
  }

  // excite_ excite_^T: covariance of the densities that independent sources throughout the box cause.
  void excitation() {
    // Even, so that no source lies on a plane of reflection; (n / 2)^3 excite each block, more than its modes.
    const int n = options_.inner / 4 * 2 + 4;
    std::vector<Vec3> sources;  // midpoints of cells, finer towards the faces
    const auto coordinate = [&](int i) { return 0.5 * std::sin(0.5 * std::numbers::pi * (i + 0.5) / n); };
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < n; ++k) sources.push_back({coordinate(i), coordinate(j), coordinate(k)});
    parallel_for(8, 1, [&](std::size_t b) {
      const Matrix cause = solve_[b] * (modes_[b] * block(static_cast<unsigned>(b), outer_, sources));
      excite_[b] = factor(cause.transpose());
    });
  }

  // L with L L^T = m^T m. Never through the product, whose rounding would bury what is below 1e-8 of the largest.
  static Matrix factor(const Matrix& m) {
    if (m.rows() <= m.cols()) return m.transpose();
    const Eigen::HouseholderQR<Matrix> qr(m);
    return qr.matrixQR().topRows(m.cols()).triangularView<Eigen::Upper>().transpose();
  }

  // observe_[b] observe_[b]^T = sum over the 316 far offsets of M C M^T, C the excitation: by duality what the targets
  // there see.
  void observation() {
    for (Matrix& m : observe_) m.resize(block_, 0);
    std::array<Matrix, 8> full;
    for (unsigned b = 0; b < 8; ++b) full[b] = unfold(b, excite_[b]);
    const std::vector<Vec3> in = images(inner_);
    for (int x = 0; x <= 3; ++x)
      for (int y = 0; y <= x; ++y)
        for (int z = 0; z <= y; ++z) {
          if (x < 2) continue;
          std::vector<Vec3> moved = in;
          for (Vec3& p : moved) p = p + Vec3{Real(x), Real(y), Real(z)};
          const Matrix m = kernel_matrix(kernel_, moved, in);
          const Real images = 8.0 / ((x ? 1 : 2) * (y ? 1 : 2) * (z ? 1 : 2));
          const Real orders = x == y && y == z ? 1 : (x == y || y == z ? 3 : 6);
          const Real weight = std::sqrt(images * orders);
          std::array<Matrix, 8> seen;
          parallel_for(8, 1, [&](std::size_t c) { seen[c] = m * full[c]; });
          parallel_for(8, 1, [&](std::size_t c) {
            Index rows = observe_[c].cols();
            for (const Matrix& v : seen) rows += v.cols();
            Matrix all(rows, block_);
            all.topRows(observe_[c].cols()) = observe_[c].transpose();
            Index at = observe_[c].cols();
            for (const Matrix& v : seen) {
              all.middleRows(at, v.cols()) = fold(static_cast<unsigned>(c), v).transpose() * weight;
              at += v.cols();
            }
            observe_[c] = factor(all);
          });
        }
    average_axes();
  }

  // The six orders of the axes have equal parts in the sum.
  void average_axes() {
    constexpr std::array<std::array<unsigned, 3>, 6> orders{
        {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
    std::map<std::tuple<Real, Real, Real>, std::size_t> place;
    for (std::size_t i = 0; i < inner_.size(); ++i) place[{inner_[i].x, inner_[i].y, inner_[i].z}] = i;
    std::array<Matrix, 8> sum;
    for (Matrix& m : sum) m.resize(6 * block_, block_);
    for (std::size_t k = 0; k < orders.size(); ++k) {
      const auto& o = orders[k];
      std::vector<Index> to(static_cast<std::size_t>(block_));
      for (std::size_t p = 0; p < inner_.size(); ++p) {
        const Vec3& v = inner_[p];
        const std::size_t q =
            place.at({v[static_cast<int>(o[0])], v[static_cast<int>(o[1])], v[static_cast<int>(o[2])]});
        for (std::size_t j = 0; j < kernel_.dim; ++j) {
          // component j of the image is component o[j] of the original
          to[kernel_.dim * q + j] = static_cast<Index>(kernel_.dim * p + (kernel_.dim == 3 ? o[j] : 0));
        }
      }
      for (unsigned b = 0; b < 8; ++b) {
        const unsigned from = ((b & 1u) << o[0]) | (((b >> 1) & 1u) << o[1]) | (((b >> 2) & 1u) << o[2]);
        for (Index i = 0; i < block_; ++i)
          sum[b].col(i).segment(static_cast<Index>(k) * block_, block_) =
              observe_[from].row(to[static_cast<std::size_t>(i)]).transpose() / std::sqrt(6.0);
      }
    }
    for (unsigned b = 0; b < 8; ++b) observe_[b] = factor(sum[b]);
  }

  // Balanced truncation: project = S^-1/2 Q^T Lo^T, spread = Lc R S^-1/2 from Lo^T Lc = Q S R^T.
  void truncate(Translations& t) const {
    std::array<Matrix, 8> left, right;
    std::array<Eigen::VectorXd, 8> hankel;
    Real largest = 0;
    for (unsigned b = 0; b < 8; ++b) {
      const Matrix& lo = observe_[b];
      const Eigen::BDCSVD<Matrix> svd(lo.transpose() * excite_[b], Eigen::ComputeThinU | Eigen::ComputeThinV);
      hankel[b] = svd.singularValues();
      const Eigen::VectorXd root = hankel[b].cwiseSqrt().cwiseInverse();
      left[b] = (root.asDiagonal() * svd.matrixU().transpose() * lo.transpose() * solve_[b]) * modes_[b];
      right[b] = excite_[b] * svd.matrixV() * root.asDiagonal();
      largest = std::max(largest, hankel[b][0]);
    }
    std::array<Index, 8> kept{};
    Index rank = 0;
    for (unsigned b = 0; b < 8; ++b) {
      while (kept[b] < hankel[b].size() && hankel[b][kept[b]] > options_.cut * largest) ++kept[b];
      rank += kept[b];
    }
    t.rank = static_cast<std::size_t>(rank);
    t.up.resize(rank, 8 * static_cast<Index>(kernel_.dim * outer_.size())), t.spread.resize(8 * block_, rank);
    Index first = 0;
    for (unsigned b = 0; b < 8; ++b) {
      t.up.middleRows(first, kept[b]) = unfold(b, left[b].topRows(kept[b]).transpose()).transpose();
      t.spread.middleCols(first, kept[b]) = unfold(b, right[b].leftCols(kept[b]));
      t.parity.insert(t.parity.end(), static_cast<std::size_t>(kept[b]), static_cast<std::uint8_t>(b));
      first += kept[b];
    }
  }

  void far_matrices(Translations& t) const {
    std::array<std::uint16_t, 64> made{};
    for (int x = 0; x <= 3; ++x)
      for (int y = 0; y <= 3; ++y)
        for (int z = 0; z <= 3; ++z) {
          if (x < 2 && y < 2 && z < 2) continue;
          std::vector<Vec3> moved = t.inner;
          for (Vec3& p : moved) p = p + Vec3{Real(x), Real(y), Real(z)};
          made[static_cast<std::size_t>(16 * x + 4 * y + z)] = static_cast<std::uint16_t>(t.to_local.size());
          t.to_local.push_back(t.spread.transpose() * (kernel_matrix(kernel_, moved, t.inner) * t.spread));
        }
    for (int x = -3; x <= 3; ++x)
      for (int y = -3; y <= 3; ++y)
        for (int z = -3; z <= 3; ++z) {
          const int ax = std::abs(x), ay = std::abs(y), az = std::abs(z);
          if (ax < 2 && ay < 2 && az < 2) continue;
          t.offset[offset_index(x, y, z)] = {made[static_cast<std::size_t>(16 * ax + 4 * ay + az)],
                                             static_cast<std::uint8_t>((x < 0) | (y < 0) << 1 | (z < 0) << 2)};
        }
  }

  TranslationOptions options_;
  Kernel kernel_;
  std::vector<Vec3> inner_, outer_;  // of the positive octant
  Index block_;
  // Density from the potential: solve_ modes_. Never multiplied: large numbers would cancel, and their rounding stay.
  std::array<Matrix, 8> solve_, modes_, excite_, observe_;
};

}  // namespace

std::shared_ptr<const Translations> translations(const TranslationOptions& options) {
  static std::mutex mutex;
  static std::vector<std::pair<TranslationOptions, std::shared_ptr<const Translations>>> kept;
  const std::lock_guard lock(mutex);
  for (const auto& [o, t] : kept)
    if (o == options) return t;
  kept.emplace_back(options, std::make_shared<const Translations>(options.sphere > 0 ? rbf_translations(options)
                                                                                     : Builder(options).build()));
  return kept.back().second;
}

}  // namespace sherd::fmm
