// Laws of the solver: what scaling, moving and turning a body do to its solution, and how far Poisson's ratio may go.
#include <gtest/gtest.h>

#include "kernels/core/parallel.h"
#include "tests/elastostatic/robust_support.h"

namespace sherd {
namespace {

ElasticOptions precise(Real tolerance = 1e-12) {
  ElasticOptions o;
  o.double_storage = true, o.krylov.tolerance = tolerance;
  return o;
}

// Not uniform, in balance on every closed surface: tractions of a stress that is in equilibrium.
Sym3 bending(const Vec3& x) {
  return {x.y, 0.3 * x.z, -0.5 * x.x, 0, 0, 0.2};
}

struct Solved {
  ParticularSolution particular;
  ElasticSolution solution;
};
Solved solve(const SurfaceMesh& mesh, const Elastic& material, const Load& load, const ElasticOptions& options) {
  const ElasticBody body(mesh, material, options);
  const ParticularSolution particular = body.particular(load);
  return {particular, body.solve(load, particular)};
}
Load scaled(Load load, Real factor) {
  for (std::size_t i = 0; i < load.quadratic_traction.size(); ++i)
    load.quadratic_traction.set(i, load.quadratic_traction[i] * factor);
  return load;
}

// Young's modulus from 1e3 to 1e12 Pa, bodies from 1 mm to 1 km: powers of two only move exponents.
TEST(RobustSolver, ScalesInBitsWithSizeStiffnessAndLoad) {
  const SurfaceMesh mesh = make_box({1, 0.8, 0.6}, 0.25);
  const Load load = traction_load(mesh, bending);
  for (const bool storage : {false, true}) {
    ElasticOptions options;
    options.double_storage = storage;
    const Vec3Column u = solve(mesh, {1, 0.3}, load, options).solution.displacement;
    for (const auto& [size, mu, force] : {std::array{0x1p-10, 1.0, 1.0},
                                          {0x1p10, 1.0, 1.0},
                                          {1.0, 0x1p10, 1.0},
                                          {1.0, 0x1p40, 1.0},
                                          {1.0, 1.0, 0x1p-20},
                                          {1.0, 1.0, 0x1p30},
                                          {0x1p10, 0x1p40, 0x1p-20}}) {
      const Solved s = solve(transformed(mesh, Mat3::identity() * size), {mu, 0.3}, scaled(load, force), options);
      ASSERT_TRUE(s.solution.ok) << s.solution.reason;
      const Real factor = size * force / mu;
      for (std::size_t v = 0; v < u.size(); ++v)
        ASSERT_EQ(s.solution.displacement[v], u[v] * factor) << size << " " << mu << " " << force;
    }
  }
}

TEST(RobustSolver, ScalesToRoundingByAnyFactor) {
  const SurfaceMesh mesh = make_sphere(0.5, 0.25);
  const Load load = traction_load(mesh, bending);
  const Vec3Column u = solve(mesh, {1, 0.3}, load, precise()).solution.displacement;
  for (const auto& [size, young, force] : {std::array{1e-3, 1e3, 1e-4}, {1e3, 1e12, 1e9}, {7.0, 3e10, 13.0}}) {
    const Elastic m{young / 2.6, 0.3};
    const Solved s = solve(transformed(mesh, Mat3::identity() * size), m, scaled(load, force), precise());
    ASSERT_TRUE(s.solution.ok) << s.solution.reason;
    Real error = 0, largest_u = 0;
    for (std::size_t v = 0; v < u.size(); ++v) {
      error = std::max(error, norm(s.solution.displacement[v] * (m.mu / (size * force)) - u[v]));
      largest_u = std::max(largest_u, norm(u[v]));
    }
    EXPECT_LT(error, 1e-11 * largest_u);  // the solver's own tolerance, ten times
  }
}

// Coordinates lose four digits at a distance of 1e4 sizes: 1e-12 of the size, 1e-11 of an edge.
TEST(RobustSolver, KeepsEightDigitsFarFromTheOrigin) {
  const SurfaceMesh mesh = make_box({1, 0.8, 0.6}, 0.25);
  const Load load = traction_load(mesh, bending);  // the same tractions, face by face
  const Vec3Column u = solve(mesh, {1, 0.3}, load, precise()).solution.displacement;
  const SurfaceMesh moved = transformed(mesh, Mat3::identity(), {1e4, -0.7e4, 0.4e4});
  const Vec3Column w = solve(moved, {1, 0.3}, load, precise()).solution.displacement;
  Real error = 0, size = 0;
  for (std::size_t v = 0; v < u.size(); ++v)
    error = std::max(error, norm(u[v] - w[v])), size = std::max(size, norm(u[v]));
  EXPECT_LT(error, 1e-8 * size);
}

TEST(RobustSolver, TurnsWithTheBody) {
  Random random(21);
  for (const SurfaceMesh& mesh : {make_sphere(0.5, 0.2), make_box({1, 0.8, 0.6}, 0.2)}) {
    const Load load = traction_load(mesh, bending);
    const Vec3Column u = solve(mesh, {1, 0.3}, load, precise()).solution.displacement;
    const Mat3 q = random_rotation(random);
    Load turned = load;
    for (std::size_t i = 0; i < load.quadratic_traction.size(); ++i)
      turned.quadratic_traction.set(i, q * load.quadratic_traction[i]);
    const Vec3Column w = solve(transformed(mesh, q), {1, 0.3}, turned, precise()).solution.displacement;
    Real error = 0, size = 0;
    for (std::size_t v = 0; v < u.size(); ++v)
      error = std::max(error, norm(q * u[v] - w[v])), size = std::max(size, norm(u[v]));
    EXPECT_LT(error, 1e-10 * size);
  }
}

// Against the exact displacement: linear stress, bodies with flat faces, and no mean stress taken out.
TEST(RobustSolver, SolvesForEveryPoissonRatio) {
  for (const SurfaceMesh& mesh : {make_box({1, 0.8, 0.6}, 0.2), make_plate(1, 1, 0.4, 0.2)})
    for (const Real nu : {-0.5, 0.0, 0.3, 0.49, 0.499}) {
      const Elastic material{1, nu};
      const QuadraticField field(material, 31);
      const ElasticBody body(mesh, material, precise(1e-10));
      const Load load = traction_load(mesh, [&](const Vec3& x) { return field.stress(x); });
      const ElasticSolution s = body.solve(load, ParticularSolution({}, material));
      ASSERT_TRUE(s.ok) << nu << " " << s.reason;
      // Both without their rigid part.
      const RigidModes modes(mesh.vertices, body.boundary().vertex_area);
      std::vector<Real> exact = interleaved(sample(mesh, [&](const Vec3& x) { return field.displacement(x); }));
      std::vector<Real> error = interleaved(s.displacement);
      for (std::size_t i = 0; i < exact.size(); ++i) error[i] -= exact[i];
      modes.add(error, modes.coefficients(error), -1);
      // The far rules' 6e-6 a panel, averaging down.
      EXPECT_LT(largest(error), 2e-6 * largest(exact)) << nu << ", " << mesh.triangle_count() << " triangles";
    }
}

}  // namespace
}  // namespace sherd
