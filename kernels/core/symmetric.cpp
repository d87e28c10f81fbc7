#include "kernels/core/symmetric.h"

#include <utility>

namespace sherd {

Eigen3 eigen_symmetric(const Sym3& s) {
  Mat3 a = to_matrix(s);
  Mat3 v = Mat3::identity();
  for (int sweep = 0; sweep < 32; ++sweep) {
    const Real off = a[0][1] * a[0][1] + a[0][2] * a[0][2] + a[1][2] * a[1][2];
    const Real diagonal = a[0][0] * a[0][0] + a[1][1] * a[1][1] + a[2][2] * a[2][2];
    if (off <= 1e-32 * diagonal || off == 0) break;
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q) {
        if (a[p][q] == 0) continue;
        const Real theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const Real t = (theta >= 0 ? 1.0 : -1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        const Real c = 1 / std::sqrt(t * t + 1), sn = t * c;
        for (int k = 0; k < 3; ++k) {
          const Real kp = a[k][p], kq = a[k][q];
          a[k][p] = c * kp - sn * kq, a[k][q] = sn * kp + c * kq;
        }
        for (int k = 0; k < 3; ++k) {
          const Real pk = a[p][k], qk = a[q][k];
          a[p][k] = c * pk - sn * qk, a[q][k] = sn * pk + c * qk;
        }
        for (int k = 0; k < 3; ++k) {
          const Real kp = v[k][p], kq = v[k][q];
          v[k][p] = c * kp - sn * kq, v[k][q] = sn * kp + c * kq;
        }
      }
  }
  int order[3] = {0, 1, 2};
  const auto by_value = [&](int i, int j) {
    if (a[order[i]][order[i]] < a[order[j]][order[j]]) std::swap(order[i], order[j]);
  };
  by_value(0, 1), by_value(1, 2), by_value(0, 1);
  Eigen3 e;
  for (int i = 0; i < 3; ++i) e.value[i] = a[order[i]][order[i]], e.vector[i] = v.column(order[i]);
  e.vector[2] = cross(e.vector[0], e.vector[1]);
  return e;
}

}  // namespace sherd
