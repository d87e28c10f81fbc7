// Compiled with -march=x86-64-v3 on x86-64 (CMakeLists.txt) and run only where the processor has it.
#ifdef SHERD_X86_PAIRS
#define SHERD_PAIRS_NAME kAvx2Pairs
#define SHERD_PAIRS_BYTES 32
#define SHERD_PAIRS_ROOT SHERD_ROOT_AVX2
#define SHERD_PAIRS_VECTORS(sums) ((sums) <= 1 ? 2u : 1u)
#include "kernels/fmm/pairs_source.h"
#endif
