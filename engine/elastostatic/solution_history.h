// Earlier solutions of one system A x = b, for the next solve to start from: loads on one body are often alike, and
// sums of earlier ones are solved at once.
#pragma once
#include <span>
#include <vector>

#include "kernels/core/vec3.h"

namespace sherd {

// Right-hand sides are kept orthonormal, so the guess is the earlier solutions' best approximation in the residual.
struct SolutionHistory {
  // x = sum of (b_i . b) x_i; zero when nothing helps. Sizes as in every add(); false and x = 0 when it does not.
  bool guess(std::span<const Real> b, std::span<Real> x) const;
  // Keeps what is new in the pair, at most kMost of them; the oldest goes first. A pair less than kNew of which is new
  // is left out: scaled up, its residual would spoil later guesses.
  void add(std::span<const Real> b, std::span<const Real> x);

  struct Pair {
    std::vector<Real> b, x;  // |b| = 1
  };
  static constexpr std::size_t kMost = 8;
  static constexpr Real kNew = 0.05;

  std::vector<Pair> pairs;  // oldest first
};

}  // namespace sherd
