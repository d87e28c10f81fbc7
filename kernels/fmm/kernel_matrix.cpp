#include "kernels/fmm/kernel_matrix.h"

#include "kernels/core/parallel.h"

namespace sherd::fmm {

Eigen::MatrixXd kernel_matrix(const Kernel& kernel, const std::vector<Vec3>& targets,
                              const std::vector<Vec3>& sources) {
  using Eigen::Index;
  const std::size_t d = kernel.dim;
  Eigen::MatrixXd out(static_cast<Index>(d * targets.size()), static_cast<Index>(d * sources.size()));
  parallel_for(sources.size(), 16, [&](std::size_t q) {
    Real k[3][3];
    for (std::size_t p = 0; p < targets.size(); ++p) {
      kernel(targets[p] - sources[q], k);
      for (std::size_t j = 0; j < d; ++j)
        for (std::size_t i = 0; i < d; ++i) out(static_cast<Index>(d * p + i), static_cast<Index>(d * q + j)) = k[i][j];
    }
  });
  return out;
}

}  // namespace sherd::fmm
