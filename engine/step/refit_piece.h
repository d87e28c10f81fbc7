// A cut piece made fit for the next solve and the next cracks.
#pragma once
#include "engine/mesh/refit.h"
#include "engine/step/solid.h"

namespace sherd {

// Edge length for a piece of a scene body, m: the body's own, or shorter where the piece is so small that fewer than
// kLeastTriangles would cover it. A stress needs several edges across a piece, and so does a crack.
Real piece_edge_length(const SurfaceMesh& piece, const RootScale& root);
inline constexpr int kLeastTriangles = 240;

// refit() to piece_edge_length().
RefitReport refit_piece(const SurfaceMesh& piece, const RootScale& root, SurfaceMesh& out);

}  // namespace sherd
