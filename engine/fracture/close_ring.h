// Cracks that come round a handle or a cavity and run along their own flank. Internal to the fracture stage.
#pragma once
#include <optional>

#include "engine/fracture/front.h"

namespace sherd {

struct Ring {
  CrackSheet sheet;               // the arms and what joins them: goes on growing
  std::vector<CrackSheet> wings;  // stopped where they were parted from it
};

// A field that no surface follows (e . curl e != 0) brings the arms of a crack back beside where they started. There
// the flank is opened under the front, so that the two have fronts that face each other and meet: the ring closes, and
// the part of the flank beyond is a crack of its own, which goes on to the ring's wall once that is cut. Nothing when
// no front runs along the sheet, or when flank and front are joined by another way than round the ring.
std::optional<Ring> close_ring(Growth& g);

}  // namespace sherd
