// What every fragment must be, checked from nothing but the mesh itself: the record that goes with each frame.
#pragma once
#include <cstdint>
#include <string>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

struct MeshCertificate {
  bool closed = false;      // every edge in two triangles, no vertex index out of range, every coordinate finite
  bool manifold = false;    // no edge in three triangles or more, one fan of triangles around each vertex
  bool oriented = false;    // neighbours agree, and every shell looks away from the solid
  bool embedded = false;    // no two triangles meet beyond what they share, none without area (exact)
  bool attributed = false;  // every column and channel is as long as the triangles ask for
  std::size_t vertices = 0, triangles = 0;
  std::size_t shells = 0, cavities = 0;                  // connected surfaces, and how many of them bound a cavity
  std::size_t below_1_degree = 0, below_15_degrees = 0;  // triangles with a smaller angle
  std::int64_t genus = -1;                               // summed over shells; -1 where it has no meaning
  Real volume = 0, area = 0;                             // m^3, m^2
  Real min_angle = 0;                                    // degrees
  std::string first_defect;                              // "" when ok(), else what is wrong and where

  // Bounds a solid of positive volume. Angles are counted, not judged.
  bool ok() const { return first_defect.empty(); }
};

// Never throws for bad meshes. As slow as the search for self-intersections: some microseconds a triangle.
MeshCertificate certify(const SurfaceMesh& mesh);
// One JSON object with the members as keys, and "ok".
std::string to_json(const MeshCertificate& certificate);

}  // namespace sherd
