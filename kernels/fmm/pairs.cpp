#include "kernels/fmm/pairs.h"

#include "kernels/fmm/pairs_table.h"

namespace sherd::fmm {

extern const PairTables kPortablePairs;
#ifdef SHERD_X86_PAIRS
extern const PairTables kAvx2Pairs, kAvx512Pairs;
#endif

Instructions best_instructions() {
#ifdef SHERD_X86_PAIRS
  static const Instructions best = [] {
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512cd"))
      return Instructions::kAvx512;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2"))
      return Instructions::kAvx2;
    return Instructions::kPortable;
  }();
  return best;
#else
  return Instructions::kPortable;
#endif
}

namespace {

const PairTables& tables(Instructions instructions) {
#ifdef SHERD_X86_PAIRS
  const Instructions best = best_instructions();
  switch (instructions < best ? instructions : best) {
    case Instructions::kAvx512:
      return kAvx512Pairs;
    case Instructions::kAvx2:
      return kAvx2Pairs;
    case Instructions::kPortable:
      return kPortablePairs;
  }
#endif
  static_cast<void>(instructions);
  return kPortablePairs;
}

}  // namespace

template <class T>
PairFunction<T> pair_function(PairSum sum, Instructions instructions) {
  const PairTables& t = tables(instructions);
  if constexpr (sizeof(T) == sizeof(float))
    return t.single.function[static_cast<std::size_t>(sum)];
  else
    return t.twice.function[static_cast<std::size_t>(sum)];
}
template PairFunction<float> pair_function(PairSum, Instructions);
template PairFunction<double> pair_function(PairSum, Instructions);

}  // namespace sherd::fmm
