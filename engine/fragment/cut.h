// Exact difference of two embedded closed meshes (the design's O10): body minus slab, then its solid components.
#pragma once
#include <string>
#include <vector>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

struct CutOptions {
  Real edge_length = 0;             // h, m: scale of the jitter and of clean-up
  std::uint64_t seed = 1;           // of the jitter
  Real min_fragment_volume = 1e-5;  // of the body's volume; smaller pieces are dust
};

struct CutResult {
  bool ok = false;
  std::string reason;                  // when not ok: the body is to stay as it was
  std::vector<SurfaceMesh> fragments;  // each valid, cavities with the solid that contains them; largest volume first
  Real removed_volume = 0;             // of body intersected with slab, m^3
  Real dust_volume = 0;                // of pieces dropped, m^3
  int jitters = 0;                     // restarts because of an exact coincidence
};

// Faces away from the slab are bit-identical to the input and keep their attributes; sub-faces inherit their parent's;
// slab walls keep the slab's (kind crack, crack id).
CutResult cut(const SurfaceMesh& body, const SurfaceMesh& slab, const CutOptions& options);

}  // namespace sherd
