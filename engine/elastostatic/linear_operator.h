// The face between the Krylov solver and whatever applies the boundary integral operator: dense now, a fast multipole
// method later.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "kernels/core/vec3.h"

namespace sherd {

class LinearOperator {
 public:
  virtual ~LinearOperator() = default;
  virtual std::size_t size() const = 0;  // rows = columns
  // y = A x, both of size(); same bits for any number of threads.
  virtual void apply(std::span<const Real> x, std::span<Real> y) const = 0;
  // The same for `count` vectors stored row major (entry i of vector j at [i * count + j]); an operator that is bound
  // by memory reads itself once for several of them. Defaults to one product a vector.
  virtual void apply_block(std::span<const Real> x, std::size_t count, std::span<Real> y) const;
  // The 3x3 block of point p on itself: the nearest of the near field, which block-Jacobi needs. An operator that
  // splits into a stored near field and a far field of any kind (a fast multipole method) offers this and apply().
  virtual Mat3 diagonal_block(std::size_t p) const = 0;
};

// Their inverses, the identity where a block is nearly singular.
std::vector<Mat3> inverse_diagonal_blocks(const LinearOperator& a);
// Block-Jacobi: z = the blocks times r, point by point.
void apply_blocks(const std::vector<Mat3>& blocks, std::span<const Real> r, std::span<Real> z);

}  // namespace sherd
