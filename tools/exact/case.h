// Exact solutions of linear elasticity as test cases: a mesh, its loads, and the stress and displacement they cause.
// Loads are the exact traction sigma n of the exact field on each facet unless `load` says otherwise: "practical" loads
// are what a user would apply to the faceted body (a pressure along the facet's normal, free facets), so that faceting
// is part of the error.
#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/load/load.h"
#include "kernels/core/symmetric.h"
#include "kernels/fundamental/elastic.h"

namespace sherd::exact {

struct ExactCase {
  std::string name;
  std::string load;  // what pulls, in words
  SurfaceMesh mesh;
  Elastic material;
  BodyForce body_force;
  std::function<Vec3(const Vec3& x)> displacement;             // m, up to a rigid motion of the solver's solution
  std::function<Sym3(const Vec3& x)> stress;                   // Pa
  std::function<Vec3(const Vec3& x, const Vec3& n)> traction;  // at x on a facet with unit outward normal n, Pa
  // Nearest point of the true solid, for points of a polyhedron that reaches outside of it; empty: contained.
  std::function<Vec3(const Vec3& x)> nearest_inside;
  Real peak = 1;       // largest absolute principal stress in the body, Pa: the scale of the errors
  Real thickness = 0;  // of the wall, m; 0 for bulky bodies
};

// A case at a sequence of resolutions: `make(resolution)` for each of `resolutions`, coarse to fine.
struct CaseFamily {
  std::string_view name;
  std::vector<int> resolutions;
  std::function<ExactCase(int resolution)> make;
};
// In the order of the benchmark's table. nu = 0.3 and mu = 1 Pa throughout.
const std::vector<CaseFamily>& case_families();
// InputError naming the choices when there is none of that name.
const CaseFamily& find_family(std::string_view name);

// How the exact traction is handed to the solver: its mean on each triangle (seven-point rule), or the quadratic
// through its values at corners and edge midpoints.
enum class TractionDetail { kConstant, kQuadratic };
// The load on the case's own mesh, with the body force.
Load make_load(const ExactCase& c, TractionDetail detail);

ExactCase stretched_cube(int n);  // 12 n^2 triangles; traction e_z at z = +-1/2
// `jitter`: of the vertices over the spheres, in edges.
ExactCase hollow_sphere(int f, Real jitter = 0);          // 40 f^2; r/R = 0.5, practical inner pressure 1 Pa
ExactCase cavity(int f, Real outer, Real jitter = 0);     // 40 f^2; radius 1 in a sphere of radius `outer`, free cavity
ExactCase rotating_sphere(int f);                         // 20 f^2; body force (x, y, 0), practical: free facets
ExactCase spherical_shell(int f, Real inner);             // 40 f^2; outer radius 1, pressure P4(cos theta) inside
ExactCase square_torsion(int n);                          // 20 n^2; 1 x 1 x 2
ExactCase circular_torsion(int m, int layers);            // 12 m (m + layers); radius 1, length 3; free side facets
ExactCase hanging_bar(int n);                             // 28 n^2; 1 x 3 x 1, body force (0, -1, 0), held at the top
ExactCase harmonic_plate(int k, Real thickness, Real q);  // 1 x 1 x T, k cells a side: w = cos(q x) cosh(q y)

}  // namespace sherd::exact
