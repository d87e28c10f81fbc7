// What a cut must fulfil before it may replace the body. Every function returns an empty text, or what is wrong.
#pragma once
#include <string>

#include "engine/fragment/carving.h"

namespace sherd {

// Not empty, all coordinates finite, all indices in range; `name` begins the text.
std::string check_numbers(const SurfaceMesh& mesh, const char* name);
// Closed with one fan of faces around each vertex.
std::string check_manifold(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& twin);
// The same for the new faces and around their vertices.
std::string check_links(const Carving& carving);
// |V(body) - V(kept) - V(body in slab)| < 1e-9 V(body)
std::string check_balance(const Carving& carving);

// New faces that a valid mesh cannot have: smaller than least_area (m^2), or meeting another face beyond shared
// vertices and edges; exact on the rounded coordinates.
struct BadFaces {
  std::vector<std::uint32_t> faces;  // ascending
  std::string reason;                // of the first; empty when there are none
};
// Among `tested`, ascending indices into the carving's new faces. All others are taken to fit together.
BadFaces find_bad_faces(const Carving& carving, const std::vector<std::uint32_t>& tested, Real least_area);

}  // namespace sherd
