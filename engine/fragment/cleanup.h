// Clean-up where the cut passes a vertex or an edge so closely that rounding, or the least area of a face, does not
// allow what is exactly right (the design's O10, step 7): tiny edges at the cut are collapsed.
#pragma once
#include "engine/fragment/cut_checks.h"

namespace sherd {

// Collapses edges shorter than a thousandth of edge_length (m) at the bad faces until none is bad, and counts them.
// Vertices of the body stay where they are. Every collapse keeps the mesh manifold and makes no good face bad; false
// when bad faces remain. The carving's kept volume is brought up to date.
bool clean_up(Carving& carving, BadFaces bad, Real edge_length, Real least_area, int& collapses);

}  // namespace sherd
