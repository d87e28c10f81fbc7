// Mass properties of the solid bounded by a closed mesh.
#pragma once
#include "engine/mesh/surface_mesh.h"

namespace sherd {

struct MassProperties {
  Real volume = 0;  // m^3
  Real mass = 0;    // kg
  Vec3 centre;      // of mass, mesh coordinates, metres
  Mat3 inertia;     // about the centre, mesh axes, kg m^2
};

// Exact for the polyhedron: volume integrals reduced to its triangles by the divergence theorem (Mirtich 1996; here by
// signed tetrahedra from the box centre). `mesh` closed and outward; density in kg/m^3.
MassProperties mass_properties(const SurfaceMesh& mesh, Real density);

}  // namespace sherd
