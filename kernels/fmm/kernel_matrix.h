// The kernels of the expansions between two sets of points.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "kernels/core/vec3.h"
#include "kernels/fmm/translations.h"

namespace sherd::fmm {

struct Kernel {
  explicit Kernel(const TranslationOptions& o) : dim(o.family == Family::kKelvin ? 3 : 1), ratio(o.ratio) {}
  std::size_t dim;
  Real ratio;
  // Entry (i, j) of the kernel at r.
  void operator()(const Vec3& r, Real out[3][3]) const {
    const Real inverse = 1 / norm(r);
    if (dim == 1) {
      out[0][0] = inverse;
      return;
    }
    const Vec3 e = r * inverse;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) out[i][j] = (e[i] * e[j] + (i == j ? ratio : 0)) * inverse;
  }
};

// (dim targets) x (dim sources), point by point.
Eigen::MatrixXd kernel_matrix(const Kernel& kernel, const std::vector<Vec3>& targets, const std::vector<Vec3>& sources);

}  // namespace sherd::fmm
