#include "engine/elastostatic/linear_operator.h"

#include <cmath>

namespace sherd {

void LinearOperator::apply_block(std::span<const Real> x, std::size_t count, std::span<Real> y) const {
  const std::size_t n = size();
  std::vector<Real> in(n), out(n);
  for (std::size_t j = 0; j < count; ++j) {
    for (std::size_t i = 0; i < n; ++i) in[i] = x[i * count + j];
    apply(in, out);
    for (std::size_t i = 0; i < n; ++i) y[i * count + j] = out[i];
  }
}

std::vector<Mat3> inverse_diagonal_blocks(const LinearOperator& a) {
  std::vector<Mat3> out(a.size() / 3);
  for (std::size_t p = 0; p < out.size(); ++p) {
    const Mat3 block = a.diagonal_block(p);
    const Real d = determinant(block), scale = trace(transpose(block) * block);
    out[p] = std::abs(d) > 1e-6 * scale * std::sqrt(scale) ? inverse(block) : Mat3::identity();
  }
  return out;
}

}  // namespace sherd
