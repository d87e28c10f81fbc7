// Body minus slab as one welded triangle set, before it is taken apart into fragments.
#pragma once
#include <string>
#include <vector>

#include "engine/fragment/piercing.h"

namespace sherd {

struct Difference {
  bool ok = false;
  std::string reason;
  SurfaceMesh mesh;                    // kept faces of the body in order, then kept faces of the slab, reversed
  std::vector<std::uint32_t> touched;  // faces of `mesh` that are parts of a cut face, ascending
  std::vector<char> intact;  // per face of `mesh`: a whole, unmoved face of body (1) or slab (2), or a part (0)
  Real body_volume = 0;      // m^3
  Real kept_volume = 0;      // of `mesh`
  Real removed_volume = 0;   // slab minus (slab minus body): uses the faces that `mesh` does not
};

// `piercing` must be in state kOk. Not ok when a face cannot be triangulated or sides contradict each other.
Difference subtract(const CutOperand& body, const CutOperand& slab, const Piercing& piercing);

}  // namespace sherd
