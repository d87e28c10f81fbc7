// The two thin bodies artists break, without an exact solution: they are compared with their own fine solution. Solids
// of revolution about y with their rings on exact curves and the wall cut square at the rim, so that meshes of all
// resolutions have the same creases and differ by faceting alone. SI units.
#pragma once
#include "engine/load/load.h"
#include "engine/mesh/surface_mesh.h"

namespace sherd::exact {

struct Vessel {
  SurfaceMesh mesh;
  Real thickness = 0;  // of the wall, m
  Vec3 hit;            // middle of the contact patch on the rim, m
  Vec3 force;          // N
  Real patch_radius = 0;
};

// Radius 0.12 m, wall 5 mm everywhere: flat base, a bend of 30 degrees with radius 30 mm, a straight flange.
Vessel dinner_plate(Real edge);
// Height 0.14 m, half-ellipsoid bowl of radius 40 mm with a wall of 4 mm, stem of radius 6 mm with fillets, foot of
// radius 32 mm.
Vessel goblet(Real edge);

// The force spread over the patch (panels that do not depend on the mesh), held by inertia relief.
Load vessel_load(const Vessel& vessel);

}  // namespace sherd::exact
