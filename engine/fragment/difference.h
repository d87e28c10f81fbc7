// Body minus slab: triangulates the cut faces and decides which faces stay (the design's O10, steps 4 to 6).
#pragma once
#include "engine/fragment/carving.h"

namespace sherd {

// `piercing`, between the carving's own operands, must be in state kOk. Empty, or why not: a face cannot be
// triangulated, or sides contradict each other. Costs what the slab touches.
std::string subtract(const Piercing& piercing, Carving& carving);

}  // namespace sherd
