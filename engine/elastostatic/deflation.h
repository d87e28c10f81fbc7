// Two-level preconditioner for thin and slender bodies: a coarse space of rigid motions of overlapping cells, in which
// bending is cheap to solve, over block-Jacobi. GMRES iterations of a 20:1 plate fall from 75 to 18 (design notes,
// section 3).
#pragma once
#include <memory>

#include "engine/elastostatic/boundary.h"
#include "engine/elastostatic/linear_operator.h"

namespace sherd {

struct DeflationOptions {
  int cells = 8;                    // along the longest side of the bounding box, lowered until the space fits
  std::size_t max_dimension = 600;  // of the coarse space, six motions a cell node; never above a tenth of the unknowns
};

// Coarse space Z: trilinear hat functions on a grid of cells (a partition of unity) times the six rigid motions. With
// Q = Z (Z^T W B Z)^-1 Z^T W the preconditioner is M^-1 r = Q r + J (r - B Q r), J block-Jacobi; B Z is stored, so one
// application costs 2 n k multiplications and no product with B.
class Deflation {
 public:
  // `b`: the completed operator (its coarse matrix must not be singular); inverse_blocks: of the 3x3 diagonal blocks.
  Deflation(const LinearOperator& b, const Boundary& boundary, const std::vector<Mat3>& inverse_blocks,
            const DeflationOptions& options);
  ~Deflation();
  void apply(std::span<const Real> r, std::span<Real> z) const;
  std::size_t dimension() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sherd
