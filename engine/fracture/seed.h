// O1: the first fan of triangles of a crack. Internal to the fracture stage.
#pragma once
#include <string>

#include "engine/fracture/front.h"

namespace sherd {

// The direction with the sign that makes its largest component positive: a stress eigenvector's own sign means nothing.
Vec3 canonical_sign(const Vec3& e);

// Lays the fan into g (whose sheet is empty). Returns the reason of a refusal, or an empty string.
std::string open_seed(Growth& g, const CrackSeed& seed);

}  // namespace sherd
