#include "engine/elastostatic/lane_kernels.h"

namespace sherd {

extern const LaneKernels kBaselineLaneKernels;
#ifdef SHERD_AVX512
extern const LaneKernels kAvx512LaneKernels;
#endif

const LaneKernels& baseline_lane_kernels() {
  return kBaselineLaneKernels;
}

const LaneKernels& lane_kernels() {
#ifdef SHERD_AVX512
  static const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                           __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
  if (wide) return kAvx512LaneKernels;
#endif
  return kBaselineLaneKernels;
}

}  // namespace sherd
