#include "engine/step/refit_piece.h"

#include <algorithm>

namespace sherd {

Real piece_edge_length(const SurfaceMesh& piece, const RootScale& root) {
  const Real per_triangle = surface_area(piece) / kLeastTriangles;
  return std::min(root.edge_length, std::sqrt(per_triangle * 4 / std::sqrt(3.0)));  // equilateral triangles
}

RefitReport refit_piece(const SurfaceMesh& piece, const RootScale& root, SurfaceMesh& out) {
  RefitOptions o;
  o.edge_length = piece_edge_length(piece, root);
  o.edge_per_thickness = root.edge_per_thickness;
  return refit(piece, o, out);
}

}  // namespace sherd
