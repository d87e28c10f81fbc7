#include "engine/elastostatic/factored.h"

#include <Eigen/Dense>
#include <cmath>

#include "kernels/core/parallel.h"

namespace sherd {
namespace {

constexpr Eigen::Index kPanel = 64, kStrip = 192;  // columns factored at once, columns a task updates

}  // namespace

template <class Scalar>
FactoredInverse::FactoredInverse(const DenseOperator<Scalar>& a, const RigidModes& modes, const CavityModes& cavities) {
  const auto n = static_cast<Eigen::Index>(a.size());
  lu_.resize(n, n);
  // Columns in strips, so that neither the rows read nor the columns written thrash the cache.
  parallel_for(static_cast<std::size_t>((n + 63) / 64), 1, [&](std::size_t strip) {
    const auto first = static_cast<Eigen::Index>(64 * strip), last = std::min(first + 64, n);
    std::vector<std::array<Real, 6>> coefficient;
    for (Eigen::Index j = first; j < last; ++j)
      coefficient.push_back(modes.coefficients_of_unit(static_cast<std::size_t>(j)));
    for (Eigen::Index i = 0; i < n; ++i) {
      const std::array<Real, 6> row = modes.row(static_cast<std::size_t>(i));
      const std::span<const Scalar> values =
          a.rows(static_cast<std::size_t>(i / 3)).subspan(static_cast<std::size_t>(i % 3 * n));
      for (Eigen::Index j = first; j < last; ++j) {
        Real sum = static_cast<Real>(values[static_cast<std::size_t>(j)]);
        for (std::size_t m = 0; m < 6; ++m)
          sum += CompletedOperator::kShift * row[m] * coefficient[static_cast<std::size_t>(j - first)][m];
        if (cavities.count() > 0) sum += cavities.entry(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
        lu_(i, j) = static_cast<float>(sum);
      }
    }
  });
  factor();
}

bool FactoredInverse::factor_panel(Eigen::Index first, Eigen::Index width) {
  const Eigen::Index n = lu_.rows();
  for (Eigen::Index k = first; k < first + width; ++k) {
    Eigen::Index best = 0;
    const float size = lu_.col(k).segment(k, n - k).cwiseAbs().maxCoeff(&best);
    if (!(size > 0) || !std::isfinite(size)) return false;
    pivot_[static_cast<std::size_t>(k)] = best += k;
    if (best != k) lu_.row(k).segment(first, width).swap(lu_.row(best).segment(first, width));
    lu_.col(k).segment(k + 1, n - k - 1) /= lu_(k, k);
    const Eigen::Index rest = first + width - k - 1;
    lu_.block(k + 1, k + 1, n - k - 1, rest).noalias() -=
        lu_.col(k).segment(k + 1, n - k - 1) * lu_.row(k).segment(k + 1, rest);
  }
  return true;
}

// Right-looking: factor a panel, then every other strip of columns swaps its rows and, right of the panel, is solved
// and updated.
void FactoredInverse::factor() {
  const Eigen::Index n = lu_.rows();
  pivot_.assign(static_cast<std::size_t>(n), 0);
  for (Eigen::Index first = 0; first < n; first += kPanel) {
    const Eigen::Index width = std::min(kPanel, n - first), next = first + width;
    if (!factor_panel(first, width)) return;
    parallel_for(static_cast<std::size_t>((n + kStrip - 1) / kStrip), 1, [&](std::size_t s) {
      const auto begin = static_cast<Eigen::Index>(s) * kStrip, end = std::min(begin + kStrip, n);
      const auto update = [&](Eigen::Index c0, Eigen::Index c1, bool right) {
        if (c0 >= c1) return;
        auto columns = lu_.middleCols(c0, c1 - c0);
        for (Eigen::Index k = first; k < next; ++k) {
          const Eigen::Index p = pivot_[static_cast<std::size_t>(k)];
          if (p != k) columns.row(k).swap(columns.row(p));
        }
        if (!right) return;
        auto top = columns.middleRows(first, width);
        lu_.block(first, first, width, width).triangularView<Eigen::UnitLower>().solveInPlace(top);
        columns.bottomRows(n - next).noalias() -= lu_.block(next, first, n - next, width) * top;
      };
      update(begin, std::min(end, first), false);
      update(std::max(begin, next), end, true);
    });
  }
  ok_ = lu_.diagonal().allFinite();
}

void FactoredInverse::apply(std::span<const Real> r, std::span<Real> z) const {
  const auto n = static_cast<Eigen::Index>(r.size());
  Eigen::VectorXf v(n);
  // Right-hand sides of any size: single precision has little range.
  Real size = 0;
  for (const Real x : r) size = std::max(size, std::abs(x));
  if (size == 0) size = 1;
  for (Eigen::Index i = 0; i < n; ++i) v[i] = static_cast<float>(r[static_cast<std::size_t>(i)] / size);
  for (Eigen::Index k = 0; k < n; ++k) std::swap(v[k], v[pivot_[static_cast<std::size_t>(k)]]);
  lu_.triangularView<Eigen::UnitLower>().solveInPlace(v);
  lu_.triangularView<Eigen::Upper>().solveInPlace(v);
  for (Eigen::Index i = 0; i < n; ++i) z[static_cast<std::size_t>(i)] = size * static_cast<Real>(v[i]);
}

template FactoredInverse::FactoredInverse(const DenseOperator<float>&, const RigidModes&, const CavityModes&);
template FactoredInverse::FactoredInverse(const DenseOperator<double>&, const RigidModes&, const CavityModes&);

}  // namespace sherd
