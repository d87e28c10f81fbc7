// Bodies with cavities as Poisson's ratio approaches one half.
#include <gtest/gtest.h>

#include "engine/mesh/shapes.h"
#include "engine/stress/stress.h"

namespace sherd {
namespace {

// rms error of the largest principal stress at the corners of a sphere of radius 1 with a cavity of radius 1/2 under
// pressure 1, relative to the rms of Lame's solution, which does not depend on nu.
Real lame_error(const SurfaceMesh& mesh, const Vec3& centre, Real nu) {
  Load load;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    load.face_traction.push_back(distance(mesh.corner(t, 0), centre) < 0.75 ? -normalized(mesh.area_normal2(t))
                                                                            : Vec3{});
  ElasticOptions options;
  options.krylov.tolerance = 1e-7, options.double_storage = true;
  const ElasticBody body(mesh, {1, nu}, options);
  const SurfaceRecovery recovery(mesh, {});
  const TriangleBvh bvh(mesh);
  const ParticularSolution particular = body.particular(load);
  const ElasticSolution solution = body.solve(load, particular);
  EXPECT_TRUE(solution.ok) << solution.reason;
  EXPECT_LE(solution.krylov.products, 30);
  const StressState state(body, recovery, bvh, load, particular, solution);
  Real error = 0, size = 0;
  for (std::size_t c = 0; c < recovery.corners().size(); ++c) {
    const Real r = distance(mesh.vertices[recovery.corners()[c].vertex], centre), hoop = (1 + 0.5 / (r * r * r)) / 7;
    const Real d = eigen_symmetric(state.corner_stress()[c]).value[0] - hoop;
    error += d * d, size += hoop * hoop;
  }
  return std::sqrt(error / size);
}

TEST(NearlyIncompressible, HollowSphereKeepsLamesStress) {
  // Facets err by the sagitta of the cavity's triangles, h^2 / (12 a^2) = 2 % of its volume at h = 0.25 a, times a few;
  // without the cavities' equations nu = 0.499 errs by 77 %.
  const SurfaceMesh mesh = make_hollow_sphere(1, 0.5, 0.12);
  for (const Real nu : {-0.5, 0.3, 0.45, 0.49, 0.499}) EXPECT_LT(lame_error(mesh, {}, nu), 0.06) << nu;
}

TEST(NearlyIncompressible, CavityEquationsDoNotDependOnWhereTheBodyIs) {
  SurfaceMesh mesh = make_hollow_sphere(1, 0.5, 0.2);
  const Real here = lame_error(mesh, {}, 0.49);
  const Vec3 far{300, -200, 500};
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) mesh.vertices.add(v, far);
  EXPECT_NEAR(lame_error(mesh, far, 0.49), here, 1e-6);  // positions keep 13 digits of the radius
}

}  // namespace
}  // namespace sherd
