// Cracks that follow a guide, whatever the stress.
#pragma once
#include "engine/material/guide_spec.h"
#include "engine/step/fracture_event.h"

namespace sherd {

// One crack for each curve in which the guide meets the body's surface. No solve, no net-section rule: where the guide
// ends, the crack stops. Never throws: a guide that misses the body gives no records, a failed crack says why.
FractureResult crack_along(Solid& solid, const GuideSpec& guide, const FractureOptions& options);

}  // namespace sherd
