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

void apply_blocks(const std::vector<Mat3>& blocks, std::span<const Real> r, std::span<Real> z) {
  for (std::size_t p = 0; p < blocks.size(); ++p) {
    const Vec3 v = blocks[p] * Vec3{r[3 * p], r[3 * p + 1], r[3 * p + 2]};
    z[3 * p] = v.x, z[3 * p + 1] = v.y, z[3 * p + 2] = v.z;
  }
}

}  // namespace sherd
