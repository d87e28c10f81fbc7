#include "engine/fragment/pieces.h"

#include "engine/mesh/solids.h"

namespace sherd {

std::vector<Piece> split_pieces(const SurfaceMesh& mesh) {
  std::vector<Piece> pieces;
  for (const SolidFaces& solid : group_shells(mesh)) pieces.push_back({extract_faces(mesh, solid.faces), solid.volume});
  return pieces;
}

}  // namespace sherd
