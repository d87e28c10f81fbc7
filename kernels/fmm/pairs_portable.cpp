#define SHERD_PAIRS_NAME kPortablePairs
#define SHERD_PAIRS_BYTES 16
#define SHERD_PAIRS_ROOT SHERD_ROOT_PORTABLE
#define SHERD_PAIRS_VECTORS(sums) ((sums) <= 4 ? 2u : 1u)
#include "kernels/fmm/pairs_source.h"
