// Meshes of the exact cases: structured, jittered by a fixed seed so that no symmetry helps the solver. Lengths in m.
#pragma once
#include "engine/mesh/surface_mesh.h"

namespace sherd::exact {

// Box centred at the origin whose edge divides 1 m in n parts; vertices move by at most `jitter` / n along the faces
// and edges they lie on, corners stay.
SurfaceMesh jittered_box(const Vec3& size, int n, Real jitter);
// Sphere of 20 f^2 triangles about the origin, vertices moved by at most jitter * edge over the sphere.
SurfaceMesh jittered_sphere(Real radius, int frequency, Real jitter, std::uint64_t seed);
// Two concentric spheres of 20 f^2 triangles each, the inner one oriented into the cavity.
SurfaceMesh jittered_hollow_sphere(Real outer, Real inner, int frequency, Real jitter);
// Cylinder about z centred at the origin: caps of 6 m^2 triangles in rings, 6 m x layers x 2 triangles between them.
SurfaceMesh structured_cylinder(Real radius, Real length, int m, int layers);
// Edge of the equilateral triangle of mean area.
Real mean_edge(const SurfaceMesh& mesh);

}  // namespace sherd::exact
