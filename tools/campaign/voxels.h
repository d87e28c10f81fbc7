// Solids made of cubes: any number of handles and cavities, all faces on a lattice.
#pragma once
#include <array>
#include <functional>

#include "engine/mesh/surface_mesh.h"

namespace sherd::campaign {

// Surface of the union of the unit cubes (i, j, k), 0 <= i < size[0] etc., that `filled` names, scaled by `edge`; two
// triangles a square. Filled cubes must not touch along an edge or at a corner alone.
SurfaceMesh make_voxels(const std::array<int, 3>& size, const std::function<bool(int, int, int)>& filled, Real edge);

// A plate 20 x 12 x 4 with two square holes: genus 2. Edges of the given length, m.
SurfaceMesh make_double_torus(Real edge);
// A block 22 x 10 x 6 with ten cavities of one or two cubes a side.
SurfaceMesh make_cheese(Real edge);

}  // namespace sherd::campaign
