// What a mesh is: counts, defects with example places, and whether it bounds a solid.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

// Up to five positions (metres) of one kind of defect, in order of the mesh's indices.
using DefectPlaces = std::vector<Vec3>;

struct MeshReport {
  std::size_t vertices = 0, triangles = 0;
  std::size_t unused_vertices = 0;       // in no triangle
  std::size_t components = 0;            // connected over shared edges
  std::size_t border_edges = 0;          // used by one triangle
  std::size_t border_loops = 0;          // connected pieces of the border
  std::size_t nonmanifold_edges = 0;     // used by three or more triangles
  std::size_t nonmanifold_vertices = 0;  // the triangles around are not one fan
  std::size_t misoriented_edges = 0;     // two triangles run through it in the same direction
  std::size_t degenerate_triangles = 0;  // a repeated vertex, or no area at all
  std::size_t needle_triangles = 0;      // smallest altitude / longest edge below 1e-4 (degenerate ones not counted)
  std::size_t bad_indices = 0;           // triangles with a vertex index out of range; all else is then left at 0
  std::size_t bad_coordinates = 0;       // vertices with a NaN or infinite coordinate; geometry is then left at 0
  std::int64_t self_intersections = -1;  // pairs of triangles, counted up to the option's limit; -1 = not counted
  std::size_t shells_inside_out = 0;     // closed components oriented against their depth of nesting
  std::int64_t genus = -1;               // summed over components; -1 when open, non-manifold or misoriented
  Real volume = 0, area = 0;             // m^3, m^2
  Box box;
  Real min_edge = 0, mean_edge = 0, max_edge = 0;  // metres
  Real min_angle = 0;                              // degrees
  DefectPlaces border_places, nonmanifold_edge_places, nonmanifold_vertex_places, misoriented_places, degenerate_places,
      needle_places, bad_coordinate_places, inside_out_places, self_intersection_places;
};

struct ReportOptions {
  bool count_self_intersections = false;       // the slowest part
  std::size_t self_intersection_limit = 1000;  // stop counting there
};

// Never throws for bad meshes: a defect is a count.
MeshReport report_mesh(const SurfaceMesh& mesh, const ReportOptions& options = {});

// Closed, manifold, consistently oriented, every shell the right way out, positive volume, no degenerate triangle, all
// finite; no self-intersection if they were counted. Needles are allowed: remeshing removes them.
bool is_valid(const MeshReport& report);

// Several lines for a person; defects with their places.
std::string to_text(const MeshReport& report);
// One JSON object with the members of MeshReport as keys.
std::string to_json(const MeshReport& report);

// +1 for a component bounding solid from outside, -1 for one bounding a cavity, by the number of closed components
// around it; 0 for components that are not closed. `label` and the count come from label_components().
std::vector<int> shell_sides(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& label,
                             std::uint32_t components);

}  // namespace sherd
