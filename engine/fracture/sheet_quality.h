// Shape of the sheet's triangles: the walls of the crack inherit them.
#pragma once
#include "engine/fracture/sheet_mesh.h"

namespace sherd {

struct SheetQuality {
  std::size_t triangles = 0, below_10 = 0;  // below_10: with an angle under 10 degrees
  Real least_angle = 0;                     // degrees
  Real mean_angle = 0;                      // of each triangle's least, degrees; 60 is best
  Real mean_radius_ratio = 0;  // twice the inscribed circle's radius over the circumscribed one's; 1 is best
  Real edge_ratio = 0;         // longest edge of the sheet over its shortest
};
// Of all triangles, those outside the body too. All zero for an empty sheet.
SheetQuality sheet_quality(const CrackSheet& sheet);

// Flips edges and moves inner nodes to the middle of their neighbours where that makes better triangles. Border nodes
// and the sheet's invariants stay. Internal to the fracture stage.
void improve_inside(SheetMesh& sheet);

}  // namespace sherd
