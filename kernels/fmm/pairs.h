// Sums over pairs of points, all sources to all targets: the near field, the direct sum, and the translation of points
// to check surfaces and back. One target a SIMD lane, sources broadcast. r = x - y (target minus source), l = |r|,
// e = r / l. A pair at l = 0 adds nothing. The bodies (kernels/fundamental/pair_bodies.h) are neutral between host and
// device; kernels/fundamental/pair_sums.h says what they mean and how the arrays lie.
#pragma once
#include <cstddef>

#include "kernels/fundamental/pair_sums.h"

namespace sherd::fmm {

// out[k][i] += what target i (at x + shift) receives as number k. The order of the sources fixes the rounding, nothing
// else does.
template <class T>
using PairFunction = void (*)(const PairSources<T>& sources, const PairTargets<T>& targets, const T shift[3],
                              const PairConstants<T>& constants, T* const out[]);

enum class Instructions { kPortable, kAvx2, kAvx512 };
Instructions best_instructions();  // of this processor (and this build)

// T: float (relative error 1e-6 a pair) or double (1e-14), of the pair's terms as they stand in pair_sums.h. Pairs
// closer than 8.7e-19 (float) or 3e-151 (double) count as coincident; squared distances must not overflow. Float wants
// coordinates of the order of 1 about a centre nearby. Instructions that this processor or build lacks give the best it
// has.
template <class T>
PairFunction<T> pair_function(PairSum sum, Instructions instructions = best_instructions());
extern template PairFunction<float> pair_function(PairSum, Instructions);
extern template PairFunction<double> pair_function(PairSum, Instructions);

}  // namespace sherd::fmm
