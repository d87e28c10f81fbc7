// Cracks that start inside (the paper's future work): where the largest principal stress inside, in units of the
// strength there, exceeds what the caller asks for, a small closed slit is the seed.
#pragma once
#include <optional>

#include "engine/fracture/grow.h"

namespace sherd {

struct InteriorSeedOptions {
  Real spacing = 0;                // m, of the points that are asked first; 0: as max_points allow
  Real depth = 0;                  // m; points nearer to the surface are left to the surface's own seeds
  Real least = 1;                  // stress over strength that must be exceeded: the surface's largest, say
  std::size_t max_points = 20000;  // of the first samples; a finer spacing is widened to keep to it
};

// The largest stress over strength of a cubic lattice over the body, then of places around it, down to an eighth of the
// spacing. Where the stress hardly varies, the middle of the region in which it is largest (kPlateau in initiate.h).
std::optional<CrackSeed> find_interior_seed(const TriangleBvh& body, const CrackField& field,
                                            const ScalarField& strength, const InteriorSeedOptions& options);

}  // namespace sherd
