// Compiled with -march=x86-64-v4 on x86-64 (CMakeLists.txt) and run only where the processor has it.
#ifdef SHERD_AVX512
#define SHERD_LANE_KERNELS kAvx512LaneKernels
#define SHERD_LANE_WIDTH 8
#include "engine/elastostatic/lane_kernels_source.h"
#endif
