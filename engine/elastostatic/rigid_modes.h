// Completion of the six rigid motions: A + a R R^T W is invertible, where A alone annihilates them.
#pragma once
#include <array>

#include "engine/elastostatic/linear_operator.h"
#include "kernels/core/column.h"

namespace sherd {

class RigidModes {
 public:
  // Orthonormal in W = diag(weight) / sum(weight), one weight a point (lumped area), about the weighted centre.
  RigidModes(const Vec3Column& points, const std::vector<Real>& weight);
  // The six coefficients R^T W x; x interleaved (3 entries a point).
  std::array<Real, 6> coefficients(std::span<const Real> x) const;
  Real size(std::span<const Real> x) const;  // sqrt(x^T W x): rms over the points
  // R^T W e_j of the unit vector j, and the row i of R: the entries of R R^T W one by one.
  std::array<Real, 6> coefficients_of_unit(std::size_t j) const;
  std::array<Real, 6> row(std::size_t i) const;
  // y += scale R c
  void add(std::span<Real> y, const std::array<Real, 6>& c, Real scale) const;

 private:
  std::array<std::vector<Real>, 6> mode_;  // interleaved
  std::vector<Real> weight_;               // per point
};

class CavityModes;

// With the six rigid motions and one equation a cavity (cavities.h; none for the indirect formulation).
class CompletedOperator final : public LinearOperator {
 public:
  // Positive like the spectrum of A (1/2 + compact on smooth bodies); 0.3 .. 0.5 gives the least condition number
  // (measured, design notes section 3).
  static constexpr Real kShift = 0.4;
  CompletedOperator(const LinearOperator& a, const RigidModes& modes, const CavityModes* cavities = nullptr)
      : a_(a), modes_(modes), cavities_(cavities) {}
  std::size_t size() const override { return a_.size(); }
  void apply(std::span<const Real> x, std::span<Real> y) const override;
  void apply_block(std::span<const Real> x, std::size_t count, std::span<Real> y) const override;
  Mat3 diagonal_block(std::size_t p) const override { return a_.diagonal_block(p); }

 private:
  const LinearOperator& a_;
  const RigidModes& modes_;
  const CavityModes* cavities_;
};

}  // namespace sherd
