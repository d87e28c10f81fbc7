// The exact cases are exact: equilibrium, Hooke's law and boundary tractions of every field, numerically, independent
// of the engine's own particular solutions.
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/mesh/validate.h"
#include "kernels/core/random.h"
#include "tools/exact/case.h"
#include "tools/exact/navier_harmonic.h"

namespace sherd::exact {
namespace {

constexpr Real kStep = 1e-4;  // m, of bodies of size 1 to 10

// Central differences, fourth order: truncation step^4 (1e-16 of the fifth derivative), rounding 1e-16 / step = 1e-12
// of the value; factors of ten for high harmonics, whose fifth derivatives are some 1e4 of their values.
template <class F>
auto derivative(const F& f, const Vec3& x, int axis) {
  Vec3 d;
  d[axis] = kStep;
  return ((f(x + d) - f(x - d)) * 8.0 + (f(x - d * 2.0) - f(x + d * 2.0))) * (1 / (12 * kStep));
}

// Points of the solid, away from its surface by more than the differences reach.
std::vector<Vec3> points_inside(const ExactCase& c) {
  const Box box = bounding_box(c.mesh);
  Random random(5);
  std::vector<Vec3> points;
  for (int i = 0; i < 40; ++i) {
    const std::size_t t = random.next() % c.mesh.triangle_count();
    const Vec3 n = normalized(c.mesh.area_normal2(t));
    const Real thickness = c.thickness > 0 ? c.thickness : 0.3 * box.diagonal() / 3.5;
    points.push_back(c.mesh.centroid(t) - n * (thickness * random.uniform(0.05, 0.5)));
  }
  return points;
}

Real magnitude(const Sym3& s) {
  return std::max({std::abs(s.xx), std::abs(s.yy), std::abs(s.zz), std::abs(s.yz), std::abs(s.xz), std::abs(s.xy)});
}

class ExactCases : public ::testing::TestWithParam<CaseFamily> {};

TEST_P(ExactCases, StressBalancesTheBodyForce) {
  const ExactCase c = GetParam().make(GetParam().resolutions.front());
  for (const Vec3& x : points_inside(c)) {
    const Mat3 dx = to_matrix(derivative(c.stress, x, 0)), dy = to_matrix(derivative(c.stress, x, 1)),
               dz = to_matrix(derivative(c.stress, x, 2));
    const Vec3 divergence = dx.column(0) + dy.column(1) + dz.column(2);
    const Vec3 b = c.body_force.constant + c.body_force.linear * (x - c.body_force.origin);
    EXPECT_LT(norm(divergence + b), 1e-8 * std::max(c.peak, magnitude(c.stress(x)))) << c.name << " at " << norm(x);
  }
}

TEST_P(ExactCases, StressFollowsFromTheDisplacement) {
  const ExactCase c = GetParam().make(GetParam().resolutions.front());
  for (const Vec3& x : points_inside(c)) {
    const Mat3 g = Mat3::from_columns(derivative(c.displacement, x, 0), derivative(c.displacement, x, 1),
                                      derivative(c.displacement, x, 2));
    const Real p = c.material.lambda() * trace(g);
    const Sym3 hooke = symmetric_part(g) * (2 * c.material.mu) + Sym3{p, p, p, 0, 0, 0};
    const Real scale = std::max({c.peak, magnitude(c.stress(x)), 1e-3 * norm(c.displacement(x)) / kStep});
    EXPECT_LT(magnitude(hooke - c.stress(x)), 1e-8 * scale) << c.name << " at " << norm(x);
  }
}

TEST_P(ExactCases, MeshIsASolidOfTheSameCountEachTime) {
  for (const int r : GetParam().resolutions) {
    const ExactCase c = GetParam().make(r);
    EXPECT_TRUE(is_valid(report_mesh(c.mesh))) << to_text(report_mesh(c.mesh));
    EXPECT_EQ(c.mesh, GetParam().make(r).mesh);
  }
}

TEST_P(ExactCases, PeakBoundsThePrincipalStressesOfTheSurface) {
  const ExactCase c = GetParam().make(GetParam().resolutions.back());
  Real largest = 0;
  for (std::size_t i = 0; i < c.mesh.vertex_count(); ++i) {
    const Eigen3 e = eigen_symmetric(c.stress(c.mesh.vertices[i]));
    largest = std::max({largest, std::abs(e.value[0]), std::abs(e.value[2])});
  }
  EXPECT_LT(largest, c.peak * (1 + 1e-6)) << c.name;
  // Vertices miss the place of the peak by half an edge at most; the rotating sphere has it in its centre.
  EXPECT_GT(largest, c.peak * 0.4) << c.name;
}

INSTANTIATE_TEST_SUITE_P(Families, ExactCases, ::testing::ValuesIn(case_families()), [](const auto& family) {
  std::string name(family.param.name);
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '-' || c == '.'; }, '_');
  return name;
});

// Free surfaces of the curved (not faceted) bodies carry nothing; each load is what its name says.
TEST(ExactSpheres, TractionsOnTheTrueSurfacesAreTheLoads) {
  Random random(6);
  const ExactCase lame = hollow_sphere(4), hole = cavity(4, 4), spin = rotating_sphere(4),
                  shell = spherical_shell(4, 0.9);
  for (int i = 0; i < 50; ++i) {
    const Vec3 n = normalized(Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
    EXPECT_LT(norm(lame.stress(n) * n), 1e-12);
    EXPECT_LT(norm(lame.stress(n * 0.5) * n + n), 1e-12);
    EXPECT_LT(norm(hole.stress(n) * n), 1e-12);
    EXPECT_LT(norm(hole.stress(n * 1e6) * n - Vec3{0, 0, n.z}), 1e-12);
    EXPECT_LT(norm(spin.stress(n) * n), 1e-12);
    const Real p4 = evaluate(SolidHarmonic{4, false}, n).value;
    EXPECT_LT(norm(shell.stress(n * 0.9) * n + n * p4), 1e-11);
    EXPECT_LT(norm(shell.stress(n) * n), 1e-11);
  }
}

TEST(ExactSpheres, ConcentrationFactorsAreThoseOfTheLiterature) {
  const Real nu = 0.3;
  EXPECT_NEAR(cavity(4, 4).stress({1, 0, 0}).zz, (27 - 15 * nu) / (2 * (7 - 5 * nu)), 1e-12);
  // Lame: hoop stress p/2 (2 a^3 + b^3) / (b^3 - a^3) inside.
  EXPECT_NEAR(hollow_sphere(4).stress({0.5, 0, 0}).yy, 0.5 * (0.25 + 1) / 0.875, 1e-12);
}

TEST(ExactTorsion, SquareBarHasItsKnownPeakAndFreeSides) {
  const ExactCase c = square_torsion(4);
  EXPECT_NEAR(c.peak, 0.675314, 2e-6);  // k = 1.350629 mu theta a (Timoshenko and Goodier, table of article 109)
  for (const Real y : {-0.5, -0.49, -0.3, 0.0, 0.2, 0.45}) {
    EXPECT_LT(std::abs(c.stress({0.5, y, 0.3}).xz), 1e-12);
    EXPECT_LT(std::abs(c.stress({y, -0.5, 0.3}).yz), 1e-12);
    // The two halves of the series agree where they meet.
    const Sym3 a = c.stress({0.4, 0.4 * (1 + 1e-9), 0}), b = c.stress({0.4, 0.4 * (1 - 1e-9), 0});
    EXPECT_LT(magnitude(a - b), 1e-8);
  }
}

}  // namespace
}  // namespace sherd::exact
