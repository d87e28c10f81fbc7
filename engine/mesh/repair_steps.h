// The steps of repair_mesh(), each for meshes that passed the steps before it.
#pragma once
#include <string>
#include <vector>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

using Messages = std::vector<std::string>;

std::size_t drop_repeated_vertex_triangles(SurfaceMesh& mesh);
std::size_t drop_unused_vertices(SurfaceMesh& mesh);
// Returns the number of vertices split. Border fans count as fans.
std::size_t split_vertices(SurfaceMesh& mesh);

struct Orientation {
  std::size_t flipped = 0;      // triangles turned; at most half of each component
  std::vector<Vec3> conflicts;  // middles of edges that no orientation satisfies
};
Orientation orient(SurfaceMesh& mesh);

struct HoleFilling {
  std::size_t filled = 0, triangles = 0, refused_edges = 0;
  Real largest_filled = 0, largest_refused = 0;  // metres
  std::vector<Vec3> refused;                     // loop centres
};
HoleFilling fill_holes(SurfaceMesh& mesh, Real max_diameter);

struct NeedleRemoval {
  std::size_t flips = 0, collapses = 0;
};
NeedleRemoval remove_needles(SurfaceMesh& mesh);

// Number of shells turned.
std::size_t turn_shells(SurfaceMesh& mesh);

struct Untangling {
  std::size_t before = 0, after = 0;  // intersecting pairs, counted up to 1000
  Real moved = 0;                     // largest displacement, metres
  std::vector<Vec3> places;           // of pairs before
};
Untangling untangle(SurfaceMesh& mesh);

}  // namespace sherd
