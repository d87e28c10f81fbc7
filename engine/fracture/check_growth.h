// The laws of a grown crack (the design's S1 to S5 and L1), asked anew of the result alone.
#pragma once
#include "engine/fracture/grow.h"

namespace sherd {

// Empty when all hold, else the first violation in words. Of a complete or arrested result: the sheet is an embedded
// oriented manifold whose border is its front; exited nodes lie outside the body; it is complete if and only if its
// whole border does; an arrested one has an arrested node or one blocked at another crack; its slab is closed and
// embedded (with the options' thickness, when positive). Of any other: it has a reason and no sheet.
std::string check_growth(const GrowthResult& result, const TriangleBvh& body, const GrowthOptions& options);

}  // namespace sherd
