// Triangular factors of the completed operator in single precision: the preconditioner of last resort, for walls so
// thin against the elements that no coarse space reaches their bending. GMRES on the exact operator then needs a
// handful of products, whatever the accuracy asked for.
#pragma once
#include <Eigen/Core>

#include "engine/elastostatic/cavities.h"
#include "engine/elastostatic/dense_operator.h"
#include "engine/elastostatic/rigid_modes.h"

namespace sherd {

class FactoredInverse {
 public:
  // 2/3 n^3 operations and n^2 floats. Blocked, with partial pivoting; parallel, the same bits for any number of
  // threads.
  template <class Scalar>
  FactoredInverse(const DenseOperator<Scalar>& a, const RigidModes& modes, const CavityModes& cavities);
  static std::size_t bytes(std::size_t n) { return n * n * sizeof(float); }
  // z = (L U)^-1 P r in single precision.
  void apply(std::span<const Real> r, std::span<Real> z) const;
  bool ok() const { return ok_; }  // false when a pivot vanished

 private:
  void factor();
  bool factor_panel(Eigen::Index first, Eigen::Index width);
  Eigen::MatrixXf lu_;
  std::vector<Eigen::Index> pivot_;
  bool ok_ = false;
};

}  // namespace sherd
