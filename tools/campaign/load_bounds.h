// Random loads on bodies of all kinds: the tension they cause, solved, against what tension_bound() says.
#pragma once
#include <string>
#include <vector>

#include "engine/mesh/surface_mesh.h"

namespace sherd::campaign {

struct BoundBody {
  std::string name;
  SurfaceMesh mesh;
};

struct BoundResult {
  std::string body;
  std::size_t load = 0;
  bool solved = false;
  std::string reason;  // when not solved
  Real tension = 0;    // largest principal stress of the surface, Pa
  Real bound = 0;      // Pa
};

// Boxes, balls, bars, plates, rings, shells, vessels, bodies with necks, holes and notches, and shards of a plate and a
// block: some 20, of a few hundred triangles each.
std::vector<BoundBody> bound_bodies();
// `loads` on each body: one to three contacts anywhere, half of them at vertices, of random size, friction up to 0.8
// and patches from the smallest to a seventh of the diagonal, every fourth with spin. Every second is near the one
// before, as those of a body at rest are, and is bounded by what that one did. By body, then load; parallel,
// deterministic.
std::vector<BoundResult> check_bounds(const std::vector<BoundBody>& bodies, std::size_t loads, std::uint64_t seed);
// A row a body: loads, largest and median of tension over bound; then loads whose tension exceeds their bound.
std::string to_text(const std::vector<BoundResult>& results);

}  // namespace sherd::campaign
