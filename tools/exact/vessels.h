// The two thin bodies artists break, without an exact solution: they are compared with their own fine solution. Solids
// of revolution about y with their rings on exact curves and the wall cut square at the rim, so that meshes of all
// resolutions have the same creases and differ by faceting alone. SI units.
#pragma once
#include "engine/load/load.h"
#include "engine/mesh/shapes_revolve.h"
#include "tools/exact/solve.h"

namespace sherd::exact {

struct Vessel {
  SurfaceMesh mesh;
  std::vector<ProfileCurve> sections;  // of the true profile, from pole to pole, outward to the right
  Real thickness = 0;                  // of the wall, m
  Vec3 hit;                            // middle of the contact patch, on a smooth side well away from creases, m
  Vec3 force;                          // N
  Real patch_radius = 0;
};

// Radius 0.1 m, wall 6 mm everywhere: flat base, a bend of 30 degrees with radius 25 mm, a straight flange; hit from
// above on the middle of the flange.
Vessel dinner_plate(Real edge);
// Height 0.13 m, half-ellipsoid bowl of radius 36 mm with a wall of 5 mm, stem of radius 7 mm with fillets, foot of
// radius 30 mm; hit from the side on the bowl. The stem's edges are three tenths of the others.
Vessel goblet(Real edge);

// The force spread over the patch (panels that do not depend on the mesh), held by inertia relief.
Load vessel_load(const Vessel& vessel);

// Stress of a solution at points of the true surface, uniform by area and the same for every mesh of the vessel:
// on_face at the point of the mesh closest to them. Points within a fifth of the wall of a crease, where the side would
// be a matter of faceting, and within one and a half patch radii of the hit are left out.
struct VesselPoint {
  Vec3 position, normal;
  Real crease_distance;  // along the profile's plane, walls
};
std::vector<VesselPoint> vessel_points(const Vessel& vessel, std::size_t count);
std::vector<Sym3> vessel_stress(const Vessel& vessel, const Solved& solved, const std::vector<VesselPoint>& points);

}  // namespace sherd::exact
