// Generated solids: closed, outward, vertex-shared, roughly uniform meshes with edges near `edge`. All lengths in
// metres. Triangles are inscribed (vertices lie on the surface), so volumes converge to the analytic value from below
// or, at concave parts, above, with order edge^2. Every function throws InputError for sizes that are not positive and
// finite, or that do not describe a solid, and for meshes beyond 20 million triangles.
#pragma once
#include "engine/mesh/surface_mesh.h"

namespace sherd {

// Axis-aligned box centred at the origin; `size` are the full side lengths. At least one element along each side.
SurfaceMesh make_box(const Vec3& size, Real edge);
// Box centred at the origin with the thickness along y: width along x, depth along z.
SurfaceMesh make_plate(Real width, Real depth, Real thickness, Real edge);
// Box centred at the origin: length along x, height along y, width along z.
SurfaceMesh make_bar(Real length, Real height, Real width, Real edge);

// Icosahedron with each edge divided in f parts (20 f^2 triangles), projected to the sphere; centred at the origin.
SurfaceMesh make_sphere(Real radius, Real edge);
// Two concentric spheres, the inner one oriented into the cavity; 0 < inner < outer.
SurfaceMesh make_hollow_sphere(Real outer, Real inner, Real edge);

// Solids of revolution about y.
// Cylinder centred at the origin, at least 8 segments around.
SurfaceMesh make_cylinder(Real radius, Real height, Real edge);
// Torus centred at the origin; minor < major.
SurfaceMesh make_torus(Real major, Real minor, Real edge);
// Plate standing with its flat base on y = 0: uniform wall `thickness`, flat to 0.6 radius, then a bend of 30 degrees
// and a straight raised rim that ends in a half circle at `radius`. thickness <= 0.1 radius.
SurfaceMesh make_dinner_plate(Real radius, Real thickness, Real edge);
// Wine glass standing on y = 0, its lip at `height`: foot disc of radius 0.8 bowl_radius, stem of radius
// max(0.1 bowl_radius, wall), half-ellipsoid bowl of outer radius bowl_radius over the upper half, open at the top.
// wall <= 0.1 min(bowl_radius, height / 2); bowl_radius <= height. `edge` is reduced where the wall would intersect
// itself.
SurfaceMesh make_goblet(Real height, Real bowl_radius, Real wall, Real edge);
// Drinking glass standing on y = 0: a straight wall that widens from 0.75 radius to `radius` at the lip, a bottom twice
// as thick. wall <= 0.2 min(radius, height).
SurfaceMesh make_tumbler(Real height, Real radius, Real wall, Real edge);
// Vase standing on y = 0: foot, a belly of outer radius `radius` in the lower half, a narrower open neck; the bottom is
// twice as thick as the wall. wall <= 0.15 radius, radius <= height. Of both vessels `edge` is reduced where the wall
// would intersect itself.
SurfaceMesh make_vase(Real height, Real radius, Real wall, Real edge);
// Solid figure on y = 0, as a chessman: plinth of radius 0.305 height, robe, collar and a round head.
SurfaceMesh make_figurine(Real height, Real edge);

// Square column on y = 0, `turn` radians twisted about y from bottom to top; |turn| <= 2 pi height / width.
SurfaceMesh make_twisted_column(Real width, Real height, Real turn, Real edge);

}  // namespace sherd
