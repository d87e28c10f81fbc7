// Krylov solvers for the (nonsymmetric, well conditioned) boundary integral systems.
#pragma once
#include <functional>

#include "engine/elastostatic/linear_operator.h"

namespace sherd {

enum class KrylovStatus { kConverged, kMaxIterations, kBreakdown };

struct KrylovOptions {
  Real tolerance = 1e-4;  // of |b - A x| / |b|
  int max_iterations = 300;
  // For a preconditioner that is linear but for its rounding, where that counts: triangular factors of a nearly
  // singular operator in single precision. Doubles the memory (Saad 1993).
  bool flexible = false;
};
struct KrylovResult {
  KrylovStatus status = KrylovStatus::kConverged;
  int iterations = 0;
  int products = 0;   // applications of A
  Real residual = 0;  // true relative residual at the end
};

// z = M^-1 r; empty for none.
using Preconditioner = std::function<void(std::span<const Real> r, std::span<Real> z)>;

// Full GMRES (Saad and Schultz 1986) without restart, right preconditioned; x holds the initial guess and the solution.
// Restarting at 30 is fatal on thin plates (measured in the design notes), so memory grows with the iterations.
KrylovResult gmres(const LinearOperator& a, const Preconditioner& m, std::span<const Real> b, std::span<Real> x,
                   const KrylovOptions& options);
// BiCGSTAB (van der Vorst 1992), the paper's solver; right preconditioned, 2 products an iteration.
KrylovResult bicgstab(const LinearOperator& a, const Preconditioner& m, std::span<const Real> b, std::span<Real> x,
                      const KrylovOptions& options);

}  // namespace sherd
