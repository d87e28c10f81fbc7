// Exact triangle-triangle intersection and the self-intersections of a mesh. Triangles are closed sets: touching
// counts, except in the simplex (vertex or edge) that two triangles share by vertex index. Degenerate triangles count
// as the segment or point they are.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

// Do the closed triangles a and b have a point in common? No vertex counts as shared, whatever its coordinates.
bool triangles_intersect(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

// The same with vertex indices ia, ib of the corners: equal indices are shared vertices. Triangles that share a vertex
// or an edge intersect only when they meet beyond it (a coplanar overlap does); three shared vertices always intersect.
bool triangles_intersect(const Triangle& ia, const std::array<Vec3, 3>& a, const Triangle& ib,
                         const std::array<Vec3, 3>& b);

// Faces t0 and t1 of one mesh, t0 != t1.
bool faces_intersect(const SurfaceMesh& mesh, std::size_t t0, std::size_t t1);

// Number of intersecting face pairs, at most `limit` (the search stops soon after). `examples`, when given, receives
// the counted pairs (low, high) in ascending order. Needs finite vertices, nothing else. Parallel, deterministic.
std::size_t count_self_intersections(const SurfaceMesh& mesh,
                                     std::size_t limit = std::numeric_limits<std::size_t>::max(),
                                     std::vector<std::pair<std::uint32_t, std::uint32_t>>* examples = nullptr);

}  // namespace sherd
