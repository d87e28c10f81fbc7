// Random bodies, materials and loads through the solver: an answer that holds, or a reason.
#include <gtest/gtest.h>

#include "engine/mesh/remesh.h"
#include "engine/mesh/validate.h"
#include "tests/elastostatic/robust_support.h"

namespace sherd {
namespace {

SurfaceMesh random_shape(Random& random) {
  switch (random.next() % 7) {
    case 0:
      return make_box({1, random.uniform(0.3, 1), random.uniform(0.3, 1)}, 0.25);
    case 1:
      return make_sphere(0.5, 0.2);
    case 2:
      return make_hollow_sphere(0.5, random.uniform(0.2, 0.45), 0.2);
    case 3:
      return make_cylinder(0.4, random.uniform(0.2, 1.5), 0.2);
    case 4:
      return make_torus(0.5, random.uniform(0.1, 0.3), 0.15);
    case 5:
      return make_cylinder(0.2, 2, 0.25);
    default:
      return make_plate(1, 0.8, random.uniform(0.05, 0.3), 0.2);
  }
}

// Remeshed, slivers put in, stretched by up to 20, turned, of any size and away from the origin: a closed surface.
SurfaceMesh random_mesh(Random& random) {
  SurfaceMesh mesh = random_shape(random);
  if (random.uniform() < 0.4) {
    SurfaceMesh out;
    RemeshOptions options;
    options.edge_length = mean_edge_length(mesh) * random.uniform(0.9, 1.3), options.iterations = 3;
    if (remesh(mesh, options, out).status == RemeshStatus::kOk && out.triangle_count() < 900) mesh = std::move(out);
  }
  if (random.uniform() < 0.3) mesh = with_slivers(mesh, 5, std::pow(10, random.uniform(-4, -1)), random.next());
  Mat3 stretch = Mat3::identity();
  if (random.uniform() < 0.6)
    stretch[1][1] = std::pow(20, random.uniform(-1, 0)), stretch[2][2] = std::pow(20, random.uniform(-1, 0));
  const Real size = std::pow(10, random.uniform(-3, 3));
  const Vec3 shift = random_vector(random) * (10 * size);
  return transformed(mesh, random_rotation(random) * stretch * size, shift);
}

// Tractions of a random stress, linear and in equilibrium.
Load random_load(const SurfaceMesh& mesh, Real pressure, Random& random) {
  const Box box = bounding_box(mesh);
  const Vec3 centre = box.centre();
  const QuadraticField field({1, 0.25}, random.next());
  const Real scale = pressure / box.diagonal();
  return traction_load(mesh, [&](const Vec3& x) { return field.stress(x - centre) * scale; });
}

class Solver : public ::testing::TestWithParam<int> {};

TEST_P(Solver, SolvesWithAnHonestResidualOrSaysWhyNot) {
  Random random(static_cast<std::uint64_t>(1000 + GetParam()));
  const SurfaceMesh mesh = random_mesh(random);
  ASSERT_TRUE(is_valid(report_mesh(mesh)));
  const Elastic material{std::pow(10, random.uniform(3, 12)), random.uniform(-0.5, 0.499)};
  ElasticOptions options;
  options.double_storage = random.uniform() < 0.5;
  const ElasticBody body(mesh, material, options);
  const Load load = random_load(mesh, std::pow(10, random.uniform(-2, 8)), random);
  const ParticularSolution particular = body.particular(load);
  const ElasticSolution s = body.solve(load, particular);
  for (const Real v : interleaved(s.displacement)) ASSERT_TRUE(std::isfinite(v));
  EXPECT_EQ(s.ok, s.reason.empty()) << s.reason;
  // Recomputed: A u + what the completion absorbed = b, to the tolerance.
  const std::vector<Real> u = interleaved(s.displacement);
  std::vector<Real> r(u.size());
  body.system().apply(u, r);
  const std::vector<Real> b = interleaved(body.testing().apply(
      load_potential(body.boundary(), load, particular, material, options.quadrature, body.testing().points())));
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = b[i] - r[i];
  const RigidModes modes(mesh.vertices, body.boundary().vertex_area);
  Real left = 0, size = 0;
  // The completion adds only rigid motions: least squares over them leaves the true residual.
  std::vector<Real> rest = r;
  for (int pass = 0; pass < 3; ++pass) modes.add(rest, modes.coefficients(rest), -1);
  for (std::size_t i = 0; i < r.size(); ++i) left += rest[i] * rest[i], size += b[i] * b[i];
  const Real honest = std::sqrt(left / size);
  EXPECT_TRUE(!s.ok || honest < 2 * options.krylov.tolerance) << honest << " " << s.krylov.residual;
}

TEST_P(Solver, UniformStressTakesNoDisplacementBeyondItsStrain) {
  Random random(static_cast<std::uint64_t>(2000 + GetParam()));
  const SurfaceMesh mesh = random_mesh(random);
  const Elastic material{std::pow(10, random.uniform(3, 12)), random.uniform(-0.5, 0.499)};
  const Sym3 sigma = random_stress(random);
  const ElasticBody body(mesh, material, {});
  const Load load = traction_load(mesh, [&](const Vec3&) { return sigma; });
  const ParticularSolution particular = body.particular(load);
  const ElasticSolution s = body.solve(load, particular);
  ASSERT_TRUE(s.ok) << s.reason;
  // Rounding of the moments: coordinates ten sizes from the origin and a volume down to 1/400 of the box.
  EXPECT_LT(largest(particular.stress(mesh.vertices[0]) - sigma), 1e-10);
  const Real strain = bounding_box(mesh).diagonal() / material.mu;
  EXPECT_LT(largest(interleaved(s.displacement)), 1e-7 * strain);
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Solver, ::testing::Range(0, 12));

}  // namespace
}  // namespace sherd
