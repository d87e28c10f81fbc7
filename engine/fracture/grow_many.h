// Several cracks of one body at the same time (O14): one step each in turn.
#pragma once
#include <span>

#include "engine/fracture/grow.h"

namespace sherd {

// result[i] belongs to seeds[i] and does not depend on the order of the seeds. A crack that runs into another one from
// the side stops there (a T-junction, GrowthResult::met: the other's place in `seeds`; numbers of options.obstacles
// should differ from those), whoever is there first. Where two grow in one plane, the one with the smaller stress stops
// and the other takes its place. Seeds nearer than 2 h to one with more stress are rejected. What the true field cannot
// close is grown again alone, down the ladder, with the others as obstacles. options.accept is asked for each crack as
// it ends.
std::vector<GrowthResult> grow_cracks(const TriangleBvh& body, const CrackField& field,
                                      std::span<const CrackSeed> seeds, const GrowthOptions& options);

}  // namespace sherd
