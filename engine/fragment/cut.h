// Exact difference of two embedded closed meshes (the design's O10): body minus slab, then its solid components.
#pragma once
#include <string>
#include <vector>

#include "engine/fragment/cut_body.h"

namespace sherd {

enum class DustRule { kDrop, kKeep };

struct CutOptions {
  Real edge_length = 0;             // h, m: scale of the jitter and of clean-up
  std::uint64_t seed = 1;           // of the jitter
  Real min_fragment_volume = 1e-5;  // of the body's volume; smaller pieces are dust
  DustRule dust = DustRule::kDrop;  // kKeep: dust becomes fragments like all others
  bool complete = false;            // the slab's sheet ends outside the body: then a body without handles must separate
  bool slab_checked = false;        // the slab is known to be closed, manifold and embedded, as thicken() leaves it
};

struct CutResult {
  bool ok = false;
  std::string reason;                  // when not ok: the body is to stay as it was
  std::vector<SurfaceMesh> fragments;  // each valid, cavities with the solid that contains them; largest volume first
  Real removed_volume = 0;             // of body intersected with slab, m^3
  Real dust_volume = 0;                // of pieces dropped, m^3
  bool separated = false;              // into two solids or more, dust counted
  std::int64_t euler = 0;              // of the surface after the cut, dust included: as CutBody::euler()
  std::size_t touched = 0;             // faces of the result that are parts of a cut face
  int jitters = 0;                     // restarts because of an exact coincidence
  int cleanups = 0;                    // tiny edges collapsed at the cut
};

// Faces away from the slab are bit-identical to the input and keep their attributes; sub-faces inherit their parent's;
// slab walls keep the slab's (kind crack, crack id).
CutResult cut(const CutBody& body, const SurfaceMesh& slab, const CutOptions& options);
CutResult cut(const SurfaceMesh& body, const SurfaceMesh& slab, const CutOptions& options);

// Of the cut by a crack whose whole border lies outside the body: it came to nothing. In a body without handles
// whatever separates nothing does; in others it is what leaves a wall on one side alone, since it lies in a face of the
// body and planes it off. (A crack through a handle need not open it: one that passes a blind hole, too, makes that a
// new one.) `crack`: id of the slab's faces.
bool does_nothing(const CutBody& body, const CutResult& cut, std::int32_t crack);

}  // namespace sherd
