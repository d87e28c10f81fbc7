// Smooth groups of faces around each vertex: faces connected across edges that turn less than the feature angle. A
// smooth vertex has one corner, a vertex on a crease one per side.
#pragma once
#include "engine/mesh/surface_mesh.h"

namespace sherd {

struct SurfaceCorner {
  std::uint32_t vertex = 0;
  std::vector<std::uint32_t> faces;  // incident faces of the group, ascending
};

struct SurfaceCorners {
  std::vector<SurfaceCorner> corner;
  std::vector<std::uint32_t> of;      // index into `corner` of corner k of face t at [3 t + k]
  std::vector<std::uint32_t> smooth;  // twins (build_twins) with kNone at creases

  std::uint32_t at(std::size_t t, std::size_t k) const { return of[3 * t + k]; }
};

// feature_angle in degrees: two faces whose normals differ by more are separated by a crease. 0 makes every edge
// between faces that are not coplanar (to 0.01 degrees) a crease: the exact polyhedron.
SurfaceCorners make_surface_corners(const SurfaceMesh& mesh, Real feature_angle);

}  // namespace sherd
