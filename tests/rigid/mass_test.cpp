#include "engine/body/mass.h"

#include <gtest/gtest.h>

#include <numbers>

#include "engine/body/pose.h"
#include "engine/mesh/shapes.h"

namespace sherd {
namespace {

void expect_near(const Mat3& a, const Mat3& b, Real tolerance) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(a[i][j], b[i][j], tolerance) << i << j;
}

SurfaceMesh placed(SurfaceMesh mesh, const Quat& turn, const Vec3& shift) {
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) mesh.vertices.set(i, rotate(turn, mesh.vertices[i]) + shift);
  return mesh;
}

// The integrals are exact for polyhedra; a few hundred roundings of numbers up to 100 leave 1e-11.
TEST(Mass, BoxIsExact) {
  const Real a = 1, b = 2, c = 3, density = 2.5, m = density * a * b * c;
  const MassProperties p = mass_properties(placed(make_box({a, b, c}, 0.7), {}, {5, -3, 1}), density);
  EXPECT_NEAR(p.volume, 6, 1e-11);
  EXPECT_NEAR(p.mass, m, 1e-11);
  EXPECT_LT(distance(p.centre, {5, -3, 1}), 1e-12);
  Mat3 exact;
  exact[0][0] = m / 12 * (b * b + c * c), exact[1][1] = m / 12 * (a * a + c * c),
  exact[2][2] = m / 12 * (a * a + b * b);
  expect_near(p.inertia, exact, 1e-10);
}

// Inscribed facets: volume error of order e^2, inertia 5/3 of it in relative terms; 4 of error ratio when e halves.
TEST(Mass, SphereConvergesWithSecondOrder) {
  const Real exact_mass = 4 * std::numbers::pi / 3, exact_inertia = 0.4 * exact_mass;
  const MassProperties coarse = mass_properties(make_sphere(1, 0.2), 1), fine = mass_properties(make_sphere(1, 0.1), 1);
  EXPECT_NEAR((exact_mass - coarse.mass) / (exact_mass - fine.mass), 4.0, 0.7);
  EXPECT_NEAR((exact_inertia - coarse.inertia[0][0]) / (exact_inertia - fine.inertia[0][0]), 4.0, 0.7);
  EXPECT_LT(std::abs(fine.inertia[0][0] - exact_inertia), 0.01 * exact_inertia);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(fine.inertia[i][i], fine.inertia[0][0], 1e-12);
  EXPECT_NEAR(fine.inertia[0][1], 0, 1e-12);
  EXPECT_LT(norm(fine.centre), 1e-13);
}

TEST(Mass, CavityIsSubtracted) {
  const MassProperties hollow = mass_properties(make_hollow_sphere(1, 0.5, 0.2), 3);
  const MassProperties outer = mass_properties(make_sphere(1, 0.2), 3),
                       inner = mass_properties(make_sphere(0.5, 0.2), 3);
  EXPECT_NEAR(hollow.mass, outer.mass - inner.mass, 1e-12);
  expect_near(hollow.inertia, outer.inertia + inner.inertia * -1.0, 1e-12);
}

// I' = R I R^T, centre' = R centre + shift, for a shape without symmetry in the turned axes.
TEST(Mass, TurnsAndMovesWithTheMesh) {
  const SurfaceMesh goblet = make_goblet(1, 0.3, 0.01, 0.05);
  const Quat turn = from_rotation_vector({0.3, -1.1, 0.7});
  const Vec3 shift{4, -2, 7};
  const MassProperties p = mass_properties(goblet, 2500), q = mass_properties(placed(goblet, turn, shift), 2500);
  EXPECT_NEAR(q.mass, p.mass, 1e-10 * p.mass);
  EXPECT_LT(distance(q.centre, rotate(turn, p.centre) + shift), 1e-12);
  const Mat3 r = to_matrix(turn);
  expect_near(q.inertia, r * p.inertia * transpose(r), 1e-11 * trace(p.inertia));
}

TEST(Mass, ScalesWithDensityAndSize) {
  const MassProperties p = mass_properties(make_box({1, 2, 3}, 1), 1), q = mass_properties(make_box({2, 4, 6}, 2), 5);
  EXPECT_NEAR(q.mass, 5 * 8 * p.mass, 1e-10);
  expect_near(q.inertia, p.inertia * (5.0 * 32), 1e-9);
}

}  // namespace
}  // namespace sherd
