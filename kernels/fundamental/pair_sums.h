// What the sums over pairs of points mean, and the arrays they read. Neutral between host and device.
// r = x - y (target minus source), l = |r|, e = r / l. A pair at l = 0 adds nothing.
#pragma once
#include <cstddef>
#include <cstdint>

#include "kernels/core/vec3.h"

namespace sherd::fmm {

// Strengths a source carries -> numbers a target receives. a, b, c, lambda, mu: PairConstants.
enum class PairSum : std::uint8_t {
  kLaplaceValue,     // q -> c q / l
  kLaplaceGradient,  // q -> that and its gradient: 4 numbers
  kDipoleValue,      // q, n (3) -> c q (r . n) / l^3
  kDipoleGradient,   // q, n (3) -> that and its gradient: 4 numbers
  kKelvinValue,      // f (3) -> u = (a f + b e (e . f)) / l
  kKelvinGradient,   // f (3) -> u_i,k at [3 i + k]
  kKelvinStress,     // f (3) -> lambda u_m,m d_ik + mu (u_i,k + u_k,i): xx, yy, zz, yz, xz, xy
  kKelvinTraction,   // f (3) -> that stress times the target's normal
  kElasticValue,     // f (3), w (3), n (3) -> (a f + b e (e . f)) / l + c w (r . n) / l^3
  kElasticGradient,  // f (3), g (3), w (3), n (3) -> gradient [3 i + k] of (a f + b e (e . f) + c g) / l + c w (r . n)
                     // / l^3
};
inline constexpr std::size_t kPairSums = 10, kMaxStrengths = 12, kMaxOutputs = 9;

struct PairShape {
  std::size_t strengths, outputs;
  bool target_normals;
};
SHERD_HD constexpr PairShape pair_shape(PairSum s) {
  constexpr PairShape shapes[kPairSums] = {{1, 1, false}, {1, 4, false}, {4, 1, false}, {4, 4, false}, {3, 3, false},
                                           {3, 9, false}, {3, 6, false}, {3, 3, true},  {9, 3, false}, {12, 9, false}};
  return shapes[static_cast<std::size_t>(s)];
}

template <class T>
struct PairConstants {
  T a = 1, b = 1, c = 1, lambda = 0, mu = 0;
};

// Arrays of `count` numbers each, finite. Strengths in the order that PairSum names them; those after the sum's own are
// not read.
template <class T>
struct PairSources {
  std::size_t count;
  const T* x[3];
  const T* strength[kMaxStrengths];
};

// Arrays of `count` numbers each, count a multiple of kPairPad (fill up with any finite points).
inline constexpr std::size_t kPairPad = 16;
SHERD_HD constexpr std::size_t padded_count(std::size_t n) {
  return (n + kPairPad - 1) / kPairPad * kPairPad;
}
template <class T>
struct PairTargets {
  std::size_t count;
  const T* x[3];
  const T* normal[3];  // where the sum needs it
};

}  // namespace sherd::fmm
