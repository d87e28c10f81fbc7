// What a mesh looks like to the graphics pipeline: single precision, one vertex per smooth group, crack faces last.
#pragma once
#include <cstdint>
#include <vector>

#include "engine/frame/frame.h"

namespace sherd {

struct DrawMesh {
  Vec3 origin;                         // mesh coordinates of the drawn zero: keeps single precision harmless
  Box box;                             // mesh coordinates
  std::vector<float> vertices;         // x y z nx ny nz per vertex, relative to origin, unit normals
  std::vector<float> values;           // of the field, one per vertex; empty without one
  std::vector<std::uint32_t> indices;  // three per triangle: original faces, then crack faces
  std::size_t original_indices = 0;    // how many of `indices` belong to original faces
};

// Normals are angle-weighted means over the triangles that can be reached around a vertex without crossing a crease: an
// edge with a dihedral angle above `crease_degrees`, a border, or an edge between an original and a crack face. A field
// moves the vertices by its displacement; its value at a vertex is the mean over the corners that share it.
DrawMesh make_draw_mesh(const SurfaceMesh& mesh, const SurfaceField* field = nullptr, Real crease_degrees = 35);

}  // namespace sherd
