// From a mesh as loaded to a valid solid (engine/mesh/validate.h), or a clear refusal.
#pragma once
#include <string>
#include <vector>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

struct RepairOptions {
  std::string name = "mesh";  // stands first in errors: the file or the body
  Real max_hole_diameter =
      0;  // metres, largest extent of a border loop that is closed; 0 = 5 % of the bounding box's diagonal
  bool check_self_intersections = true;  // refuse a surface that intersects itself (slow for millions of triangles)
};

// In place, in this order: vertices in no triangle and triangles with a repeated vertex are dropped; vertices with
// several fans of triangles are split, one vertex per fan, all but one drawn into their fan by a thousandth of its
// size; triangles are oriented alike; holes up to the limit are closed; needles and triangles without area are removed
// by edge flips and collapses; shells are turned outward, cavities inward; intersections of at most one triangle in 500
// are smoothed apart. Small separate pieces are kept and mentioned. `messages` gets one sentence for everything done,
// with counts; nothing for a valid mesh. New triangles have faces.source = -1. The result satisfies is_valid().
// InputError, with counts and places, for what cannot be repaired: indices out of range, coordinates not finite, edges
// with more than two triangles, a surface that cannot be oriented, holes beyond the limit, triangles that intersect.
// `mesh` is then left half repaired.
void repair_mesh(SurfaceMesh& mesh, const RepairOptions& options, std::vector<std::string>& messages);

}  // namespace sherd
