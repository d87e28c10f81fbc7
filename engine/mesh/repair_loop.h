// Triangulation of a closed polygon in space.
#pragma once
#include <vector>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

// n - 2 triangles over the loop's own vertices (indices into `loop`), oriented like the loop. Minimal total area with a
// preference for well-shaped triangles by dynamic programming (Barequet and Sharir 1995) up to 400 vertices, O(n^3);
// longer loops are first clipped down to that at their best-shaped ears. A planar polygon, concave or not, gets a
// triangulation without overlaps. Fewer than three vertices give nothing.
std::vector<Triangle> triangulate_loop(const std::vector<Vec3>& loop);

}  // namespace sherd
