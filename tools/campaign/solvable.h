// Is a piece fit for the stress stage?
#pragma once
#include <string>
#include <vector>

#include "engine/mesh/surface_mesh.h"

namespace sherd::campaign {

struct Solvability {
  bool solved = false;
  std::vector<std::string> warnings;  // of the stress stage; the refusal when it threw
  bool clean() const { return solved && warnings.empty(); }
};

// Solves the piece (one solid or more) under a bending stress field about a direction drawn from `seed`: tractions
// that balance on any closed surface.
Solvability solve_piece(const SurfaceMesh& piece, std::uint64_t seed);

}  // namespace sherd::campaign
