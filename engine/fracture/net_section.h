// Does the ligament of a stopped crack bear the load? The stress is solved once, on the body without the crack (as in
// the paper), so a front stops where that stress falls below the strength, even when the crack has taken most of the
// section. The tension the cracked part no longer carries goes to what is left: the ligament's mean stress is the
// tension over the whole section divided by the ligament's area (net-section stress of engineering fracture mechanics).
#pragma once
#include "engine/fracture/grow.h"

namespace sherd {

struct NetSection {
  bool complete = false;  // the crack, continued along the field, separates: `through` is that sheet
  GrowthResult through;
  Real stress = 0;    // of the ligament, Pa; 0 when not complete
  Real strength = 0;  // propagation strength, its mean over the ligament, Pa
};

// `arrested`: outcome of growth in `body` under `field`. Never throws, deterministic.
NetSection net_section(const TriangleBvh& body, const CrackField& field, const CrackSheet& arrested,
                       const GrowthOptions& options);

}  // namespace sherd
