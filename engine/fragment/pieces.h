// Solid components of a mesh: every outer shell with the cavities inside it.
#pragma once
#include <vector>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

struct Piece {
  SurfaceMesh mesh;  // vertices and faces in the order of the whole
  Real volume = 0;   // cavities subtracted, m^3
};

// Largest volume first. `mesh` must be closed; a shell of negative volume is a cavity of the smallest solid around it.
std::vector<Piece> split_pieces(const SurfaceMesh& mesh);

}  // namespace sherd
