// The direct formulation collocated at vertices, stored densely:
//   (A u)(x_p) = D[u - u(x_p)] + 2 mu V_E[M u] - V_L[M u]  at every vertex x_p,
// with D the Laplace double layer, V_E and V_L the Kelvin and Laplace single layers, M the tangential Guenter operator
// (M u)_i = n_j d_i u_j - n_i d_j u_j. Equal to V_E[t] for the displacement u of a body with tractions t (Somigliana's
// identity with the traction kernel integrated by parts; Kupradze 1979). Independent of mu. Annihilates
// translations exactly and rotations to the quadrature's accuracy (1e-8 with the default rules), which is also how
// exact it is for affine u. Near and far field use the same form: the traction-kernel form agrees only over a closed
// surface.
#pragma once
#include <functional>
#include <string>

#include "engine/elastostatic/boundary.h"
#include "engine/elastostatic/linear_operator.h"

namespace sherd {

// Scalar: float or double storage (arithmetic of apply() accumulates in double). Bytes = (3 nv)^2 sizeof(Scalar).
template <class Scalar>
class DenseOperator final : public LinearOperator {
 public:
  DenseOperator(const Boundary& boundary, Real nu);
  // Any other operator on `points` vectors: fill(p, rows) adds the three rows of point p, row major (entry (i, 3 q + j)
  // at rows[i * 3 points + 3 q + j]), to zeros. Called in parallel, once a point.
  DenseOperator(std::size_t points, const std::function<void(std::size_t p, std::span<Real> rows)>& fill);
  // Zeros, to be filled through rows().
  explicit DenseOperator(std::size_t points) : size_(3 * points), matrix_(size_ * size_) {}
  // The three rows of point p, row major.
  std::span<Scalar> rows(std::size_t p) { return {matrix_.data() + 3 * p * size_, 3 * size_}; }
  std::span<const Scalar> rows(std::size_t p) const { return {matrix_.data() + 3 * p * size_, 3 * size_}; }
  std::size_t size() const override { return size_; }
  void apply(std::span<const Real> x, std::span<Real> y) const override;
  void apply_block(std::span<const Real> x, std::size_t count, std::span<Real> y) const override;
  Mat3 diagonal_block(std::size_t p) const override;

 private:
  std::size_t size_;
  std::vector<Scalar> matrix_;  // row major
};
// Why an operator of `size` unknowns on a mesh of so many triangles must not be made, or empty when it fits max_bytes.
std::string too_large(std::size_t triangles, std::size_t size, bool double_storage, std::size_t max_bytes);
extern template class DenseOperator<float>;
extern template class DenseOperator<double>;

}  // namespace sherd
