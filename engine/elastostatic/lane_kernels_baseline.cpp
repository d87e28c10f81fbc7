#define SHERD_LANE_KERNELS kBaselineLaneKernels
#define SHERD_LANE_WIDTH 4
#include "engine/elastostatic/lane_kernels_source.h"
