#include "engine/elastostatic/linear_operator.h"

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

}  // namespace sherd
