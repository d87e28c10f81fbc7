// What loads solved before tell of a new one: a body at rest bears nearly the same load step after step.
#pragma once
#include <span>
#include <utility>
#include <vector>

#include "engine/load/contact_load.h"
#include "engine/load/tension_bound.h"

namespace sherd {

// A contact with its place's solidity() and the shares of its force that the faces of the mesh bear: by face,
// ascending, 1 together.
struct SpreadContact {
  BodyContact contact;
  Real solidity = 1;
  std::vector<std::pair<std::uint32_t, Real>> shares;
};

// By contact. `twins` (build_twins()) and `bvh` of the mesh; parallel, the same bits for any number of threads.
std::vector<SpreadContact> spread(const SurfaceMesh& mesh, std::span<const BodyContact> contacts,
                                  const std::vector<std::uint32_t>& twins, const TriangleBvh& bvh);

// A load that was solved, and what it caused.
struct SolvedLoad {
  std::vector<SpreadContact> contacts;
  Real spin = 0;     // rad/s
  Real tension = 0;  // the largest on the surface, Pa, at least 0
};

// tension_bound() with what earlier loads of the body did: stress is linear in the load and the largest principal
// stress of a sum is at most the sum of the largest ones, so a load causes at most `share` times what an earlier one
// did and what the rest of it can. The least over `earlier` and none, Pa. `spin`: density and spin of the load.
Real tension_bound(const BoundedBody& body, std::span<const SpreadContact> contacts,
                   std::span<const SolvedLoad> earlier, const BoundedLoad& spin);

}  // namespace sherd
