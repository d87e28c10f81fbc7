// Which closed surfaces of a mesh bound the same solid.
#pragma once
#include <vector>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

// One solid: an outer shell with the cavities directly inside it. A solid within a cavity is one of its own.
struct SolidFaces {
  std::vector<std::uint32_t> faces;  // of the whole mesh, ascending
  Real volume = 0;                   // cavities subtracted, m^3
};

// Largest volume first. `mesh` must be closed; a shell of negative volume is a cavity of the smallest solid around it
// (of the largest solid where none is around it).
std::vector<SolidFaces> group_shells(const SurfaceMesh& mesh);

// The faces named (ascending) with their vertices, both in the order of the whole; face attributes go along.
SurfaceMesh extract_faces(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& faces);

}  // namespace sherd
