// Stress against exact solutions of linear elasticity (tools/exact). Errors are relative to the body's largest
// principal stress. Bands are the measured errors, which `sherd-bench stress` prints, times about 1.5, and never above
// the accuracy asked for.
#include <gtest/gtest.h>

#include <cmath>

#include "tools/exact/solve.h"

namespace sherd::exact {
namespace {

constexpr QuadratureOptions kExactQuadrature{1e30, 1e30};

SurfaceError error_at(std::string_view family, int resolution) {
  const ExactCase c = find_family(family).make(resolution);
  const Solved s = solve(c, SolveOptions{});
  EXPECT_TRUE(s.ok) << c.name << ": " << s.reason;
  return s.ok ? surface_error(c, s) : SurfaceError{{1, 1, 0}, {1, 1, 0}};
}

// Observed order in the edge length between two frequencies of the same family.
Real order(std::string_view family, int coarse, int fine) {
  return std::log(error_at(family, coarse).all.rms / error_at(family, fine).all.rms) /
         std::log(static_cast<Real>(fine) / coarse);
}

TEST(ValidationStress, UniformTensionIsExactOnTheSurfaceAndInside) {
  const ExactCase c = stretched_cube(4);
  SolveOptions options;
  options.elastic.quadrature = kExactQuadrature, options.elastic.double_storage = true;
  options.elastic.krylov.tolerance = 1e-13;
  const Solved s = solve(c, options);
  ASSERT_TRUE(s.ok) << s.reason;
  EXPECT_LT(surface_error(c, s).all.max, 1e-10);
  for (const Real depth : {0.05, 0.5, 1.0}) EXPECT_LT(interior_error(c, s, depth, 50).max, 1e-10) << depth;
}

TEST(ValidationStress, LoadsOnTriangleMeansAreExactForUniformTension) {
  const ExactCase c = stretched_cube(4);
  SolveOptions options;
  options.traction = TractionDetail::kConstant, options.elastic.krylov.tolerance = 1e-8;
  const Solved s = solve(c, options);
  ASSERT_TRUE(s.ok) << s.reason;
  // Float storage: 2e-6 of the stress (design notes, section 3), Gauss rules beyond three edges 1e-6.
  EXPECT_LT(surface_error(c, s).all.max, 1e-4);
}

TEST(ValidationStress, HollowSphereApproachesLame) {
  EXPECT_LT(error_at("hollow-sphere", 9).all.rms, 0.008);  // 3240 triangles: 0.6 %
  EXPECT_GT(order("hollow-sphere", 4, 9), 1.6);            // facets: second order
}

TEST(ValidationStress, CavityConcentratesAsSouthwellAndGough) {
  EXPECT_LT(error_at("cavity", 9).all.rms, 0.005);  // 3240 triangles: 0.32 %
  EXPECT_GT(order("cavity", 4, 9), 1.8);
}

TEST(ValidationStress, RotatingSphere) {
  EXPECT_LT(error_at("rotating-sphere", 11).all.rms, 0.004);  // 2420 triangles; asked for: 2 %
  EXPECT_GT(order("rotating-sphere", 4, 7), 1.7);
}

TEST(ValidationStress, BarUnderItsOwnWeight) {
  EXPECT_LT(error_at("self-weight", 6).all.rms, 0.0002);  // 1008 triangles; asked for: 0.3 % at 2268
}

TEST(ValidationStress, SquareBarInTorsionIsLimitedByTheRecoveryAlone) {
  const ExactCase c = square_torsion(9);  // 1620 triangles
  const Solved s = solve(c, SolveOptions{});
  ASSERT_TRUE(s.ok) << s.reason;
  const Real rms = surface_error(c, s).all.rms, floor = recovery_floor(c, s).all.rms;
  EXPECT_LT(rms, 0.0055);  // asked for: 3 %
  // With exact displacements the fits err as much: r^2 log r along the four edges is no polynomial.
  EXPECT_LT(rms, 1.2 * floor);
}

TEST(ValidationStress, RoundBarInTorsion) {
  EXPECT_LT(error_at("circular-torsion", 3).all.rms, 0.005);  // 468 triangles
}

TEST(ValidationStress, ThinSphericalShellUnderLegendrePressure) {
  EXPECT_LT(error_at("shell-0.95", 6).all.rms, 0.016);  // h/T 3.9; asked for: 3 %
}

TEST(ValidationStress, PlateBendsWithElementsOnceToThriceItsThickness) {
  EXPECT_LT(error_at("plate-q3-0.2", 10).all.rms, 0.0075);   // h/T 0.54; asked for: 1.5 %
  EXPECT_LT(error_at("plate-q3-0.1", 8).all.rms, 0.005);     // h/T 1.32; asked for: 2 %
  EXPECT_LT(error_at("plate-q3-0.05", 10).all.rms, 0.0075);  // h/T 2.06; asked for: 2 %
  EXPECT_LT(error_at("plate-q3-0.033", 10).all.rms, 0.02);   // h/T 3.07; asked for: 5 %
  EXPECT_LT(error_at("plate-q6-0.05", 10).all.rms, 0.05);    // h/T 2.06; asked for: 8 %
}

TEST(ValidationStress, PlateOfQuarterWavesConvergesFasterThanSecondOrder) {
  EXPECT_GT(order("plate-q3-0.05", 8, 10), 2);
}

// rms at every depth at most three times that at one edge plus 1 % of the peak.
TEST(ValidationStress, InteriorStressIsGoodUpToTheSurface) {
  for (const char* name : {"cavity", "square-torsion"}) {
    const ExactCase c = find_family(name).make(9);
    const Solved s = solve(c, SolveOptions{});
    ASSERT_TRUE(s.ok) << s.reason;
    const Real within = std::string_view(name) == "cavity" ? 1.5 : 1e300;  // the cavity's own surface
    const Real deep = interior_error(c, s, 1, 200, within).rms;
    for (const Real depth : {0.02, 0.05, 0.1, 0.25})
      EXPECT_LT(interior_error(c, s, depth, 200, within).rms, 3 * deep + 0.01) << name << " at " << depth << " edges";
  }
}

// Somigliana's identity: outside of the body the double layer of the displacement and the single layer of the traction
// cancel. Uniform tension, left to the operator by a particular solution without the mean stress; closed forms alone.
TEST(ValidationStress, FieldOutsideOfTheBodyIsZero) {
  const ExactCase c = stretched_cube(3);
  const Load load = make_load(c, TractionDetail::kQuadratic);
  for (const TestingRule rule : {TestingRule::kCollocation, TestingRule::kGalerkin}) {
    ElasticOptions options;
    options.quadrature = kExactQuadrature, options.double_storage = true, options.testing = rule;
    options.krylov.tolerance = 1e-14;
    const ElasticBody body(c.mesh, c.material, options);
    ASSERT_TRUE(body.ready());
    const ParticularSolution none(load.body_force, c.material);
    const ElasticSolution solution = body.solve(load, none);
    ASSERT_TRUE(solution.ok) << solution.reason;
    const TriangleBvh bvh(c.mesh);
    const SurfaceRecovery recovery(c.mesh, {});
    const StressState state(body, recovery, bvh, load, none, solution);
    for (const Vec3& x : {Vec3{0.9, 0.1, 0.2}, Vec3{0, 0.55, 0}, Vec3{-0.6, 0.7, -3}, Vec3{0.1, -0.2, 0.8}}) {
      const Sym3 s = state.interior(x) - none.stress(x);
      const Eigen3 e = eigen_symmetric(s);
      EXPECT_LT(std::max(std::abs(e.value[0]), std::abs(e.value[2])), 1e-12) << norm(x);
    }
    EXPECT_NEAR(state.interior({0.1, 0.2, -0.1}).zz, 1, 1e-12);  // and inside it is not
  }
}

// The indirect formulation is a reference, not an answer: fine on smooth bodies, tens of percent at sharp edges.
TEST(ValidationStress, IndirectFormulationIsGoodOnSmoothBodiesAndNotAtSharpEdges) {
  SolveOptions indirect;
  indirect.formulation = Formulation::kIndirect;
  const ExactCase smooth = hollow_sphere(6), sharp = stretched_cube(4);
  const Solved a = solve(smooth, indirect), b = solve(sharp, indirect);
  ASSERT_TRUE(a.ok && b.ok);
  EXPECT_LT(surface_error(smooth, a).all.rms, 0.015);  // design notes, section 5: 0.89 % at 1440
  EXPECT_NEAR(surface_error(sharp, b).all.rms, 0.30, 0.05);
}

TEST(ValidationStress, MeanStressOfASpinningSphereIsItsVirial) {
  // div sigma + b = 0 without tractions: integral of sigma_ij dV = integral of b_i x_j dV. b = (x, y, 0): 0.2 V (1, 1,
  // 0) for the unit sphere. Cones from the centre to the faces, three radial Gauss points: exact for fields quadratic
  // along a ray, as the exact stress is.
  const ExactCase c = rotating_sphere(5);
  const Solved s = solve(c, SolveOptions{});
  ASSERT_TRUE(s.ok) << s.reason;
  const Real node[3] = {0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)}, weight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  Vec3Column points;
  for (std::size_t t = 0; t < c.mesh.triangle_count(); ++t)
    for (const Real r : node) points.push_back(c.mesh.centroid(t) * r);
  std::vector<Sym3> sigma;
  s.field->evaluate(points, sigma);
  Vec3 mean;
  Real total = 0;
  for (std::size_t i = 0; i < sigma.size(); ++i) {
    const Real r = node[i % 3], w = weight[i % 3] * 3 * r * r * 0.5 * norm(c.mesh.area_normal2(i / 3));
    mean += Vec3{sigma[i].xx, sigma[i].yy, sigma[i].zz} * w, total += w;
  }
  mean = mean / total;
  // Faceting: edge 0.24 has a sagitta of h^2/12 = 0.5 %, the second moment 2 % with it; stress about 2 % more.
  EXPECT_NEAR(mean.x, 0.2, 0.008);
  EXPECT_NEAR(mean.y, 0.2, 0.008);
  EXPECT_NEAR(mean.z, 0, 0.004);
}

}  // namespace
}  // namespace sherd::exact
