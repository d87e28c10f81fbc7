// What a cut must fulfil before it may replace the body. Every function returns an empty text, or what is wrong.
#pragma once
#include <string>

#include "engine/fragment/difference.h"

namespace sherd {

// Not empty, all coordinates finite, all indices in range; `name` begins the text.
std::string check_numbers(const SurfaceMesh& mesh, const char* name);
// Closed with one fan of faces around each vertex.
std::string check_manifold(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& twin);
// Parts of cut faces have area and meet no other face but at shared vertices and edges: exact on the rounded
// coordinates.
std::string check_touched(const Difference& difference);
// |V(body) - V(kept) - V(body in slab)| < 1e-9 V(body)
std::string check_balance(const Difference& difference);

}  // namespace sherd
