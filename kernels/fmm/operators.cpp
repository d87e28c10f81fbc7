#include <algorithm>

#include "kernels/fmm/evaluator.h"

namespace sherd::fmm {
namespace {

template <class T>
Columns<T> surface(const std::vector<Vec3>& points) {
  Columns<T> out(3, padded_count(points.size()));
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < out.size(); ++i)
      out.column(k)[i] = static_cast<T>(points[std::min(i, points.size() - 1)][static_cast<int>(k)]);
  return out;
}

// Columns of a matrix over a surface from point by point to component by component, padded.
template <class T>
typename Operators<T>::Matrix by_component(const Eigen::MatrixXd& m, std::size_t dim) {
  const std::size_t points = static_cast<std::size_t>(m.cols()) / dim, stride = padded_count(points);
  typename Operators<T>::Matrix out = Operators<T>::Matrix::Zero(m.rows(), static_cast<Eigen::Index>(dim * stride));
  for (std::size_t p = 0; p < points; ++p)
    for (std::size_t i = 0; i < dim; ++i)
      out.col(static_cast<Eigen::Index>(i * stride + p)) = m.col(static_cast<Eigen::Index>(dim * p + i)).cast<T>();
  return out;
}

}  // namespace

template <class T>
Operators<T>::Operators(const FarField& field) : columns(field.columns) {
  const std::shared_ptr<const Translations> t = translations(field.translations);
  rank = t->rank, dim = t->dim;
  inner_size = t->inner.size(), outer_size = t->outer.size();
  inner = surface<T>(t->inner), outer = surface<T>(t->outer);
  up = by_component<T>(t->up, dim), down = up.transpose();
  gather = by_component<T>(t->spread.transpose(), dim), spread = gather.transpose();
  for (std::size_t o = 0; o < 8; ++o) {
    merge[o] = t->merge[o].cast<T>();
    // Half: a child's local is the potential in the child's units.
    split[o] = (0.5 * t->merge[o].transpose()).cast<T>();
  }
  for (const Eigen::MatrixXd& m : t->to_local) across.push_back(m.cast<T>());
  for (unsigned s = 0; s < 8; ++s)
    for (const std::uint8_t p : t->parity) flip[s].push_back(__builtin_popcount(s & p) % 2 ? T(-1) : T(1));
}

template struct Operators<float>;
template struct Operators<double>;

}  // namespace sherd::fmm
