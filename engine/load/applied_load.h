// Loads without contact: forces and couples spread over a region of the surface, as a testing machine applies them.
#pragma once
#include <vector>

#include "engine/load/load.h"

namespace sherd {

// In material space. Acts on the original surface (no crack faces) inside the box.
struct AppliedLoad {
  Box region;          // m
  Vec3 facing;         // faces whose outward normal lies within 45 degrees of it alone; zero: any
  Vec3 force;          // N, spread evenly: its line of action goes through the region's centroid
  Vec3 moment;         // N m, a couple: spread as w x (x - centroid), on a shaft's end the traction of its torsion
  Real from = 0;       // s
  Real until = 1e300;  // s, exclusive
  bool acts(Real time) const { return time >= from && time < until; }
};

// What the load is on the body it was made for. Kept when that body is cut: every piece bears the traction of the part
// of the region it owns.
struct AppliedTraction {
  Box region;
  Vec3 facing;
  Vec3 uniform;  // Pa
  Vec3 twist;    // Pa/m: the traction at x is uniform + twist x (x - centre), times the share of the face in the box
  Vec3 centre;   // m
};

// Faces at the box's border bear the traction in the share of their area that lies inside, so the resultant and where
// it acts converge quickly with the mesh; force and moment themselves are met to rounding on any mesh. Throws
// InputError when the region holds no part of the surface.
AppliedTraction spread(const SurfaceMesh& mesh, const AppliedLoad& load);
// Adds to load.quadratic_traction. Returns the area under load, m^2: 0 when the mesh owns no part of the region.
Real add_traction(const SurfaceMesh& mesh, const AppliedTraction& traction, Load& load);

}  // namespace sherd
