// Where cracks and notches are told to run, as plain data in material space (m).
#pragma once
#include <variant>
#include <vector>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

// The plane through `point`. With a depth, the crack starts where the body's surface is nearest to `point` and ends on
// a straight line `depth` below that place.
struct GuidePlane {
  Vec3 point;
  Vec3 normal;     // unit
  Real depth = 0;  // m; 0: through the body
};

// A line on the surface, swept along `inward`. The crack ends at the line's ends: draw it past the body to cut through.
struct GuidePolyline {
  std::vector<Vec3> points;  // at least two, no two successive ones equal
  Vec3 inward;               // unit, not along the line
  Real depth = 0;            // m; 0: through the body
};

// A surface: an open, consistently oriented triangle mesh. The crack ends at its border.
using GuideSpec = std::variant<GuidePlane, GuidePolyline, SurfaceMesh>;
using NotchSpec = std::variant<GuidePlane, GuidePolyline>;  // with depth > 0

}  // namespace sherd
