// Laws of the stress at convex sharp edges.
#include "engine/stress/rim.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "engine/stress/recovery.h"
#include "tests/elastostatic/robust_support.h"

namespace sherd {
namespace {

const Elastic kMaterial{2.0, 0.28};

// Prism along z over a convex or non-convex outline (counter-clockwise), fanned from vertex 0 at both ends: the outline
// must be visible from there.
SurfaceMesh prism(const std::vector<Vec3>& outline, Real height) {
  SurfaceMesh m;
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (const Real z : {0.0, height})
    for (const Vec3& p : outline) m.vertices.push_back({p.x, p.y, z});
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    m.add_triangle(i, j, n + j), m.add_triangle(i, n + j, n + i);
    if (i > 0 && j > 0) m.add_triangle(0, j, i), m.add_triangle(n, n + i, n + j);
  }
  return m;
}

// Edges between the sides that turn by 360 / n degrees: the solid's angle is 180 less that.
SurfaceMesh regular_prism(int n) {
  std::vector<Vec3> outline;
  for (int i = 0; i < n; ++i) {
    const Real a = 2 * std::numbers::pi * i / n;
    outline.push_back({std::cos(a), std::sin(a), 0});
  }
  return prism(outline, 1.3);
}

Real recovery_error(const SurfaceMesh& mesh, const Elastic& material, const Mat3& g) {
  const Sym3 sigma = kelvin::hooke(g, material);
  const SurfaceRecovery recovery(mesh, {});
  Vec3Column traction;
  for (const StressCorner& c : recovery.corners()) traction.push_back(sigma * c.normal);
  Real error = 0;
  for (const Sym3& s : recovery.stress(sample(mesh, [&](const Vec3& x) { return g * x; }), traction, material))
    error = std::max(error, largest(s - sigma));
  return error / largest(sigma);
}

TEST(Rim, UniformStressIsExactAtEveryConvexEdge) {
  Random random(4);
  for (const Real nu : {-0.5, 0.0, 0.28, 0.499})
    for (const SurfaceMesh& mesh : {make_box({1, 0.8, 0.6}, 0.3), regular_prism(3), regular_prism(4), regular_prism(6)})
      // Strains lose what the largest modulus, 1 / (1 - 2 nu), multiplies.
      EXPECT_LT(recovery_error(mesh, {2.0, nu}, random_matrix(random)), 1e-12 / (1 - 2 * nu)) << nu;
}

TEST(Rim, SidesGiveTheStressAtSixtyNinetyAndAHundredAndTwentyDegrees) {
  Random random(5);
  for (const Real degrees : {60.0, 90.0, 120.0, 150.0}) {
    const Real turn = (180 - degrees) * std::numbers::pi / 180;
    const Mat3 q = random_rotation(random), g = random_matrix(random);
    const Sym3 sigma = kelvin::hooke(g, kMaterial);
    std::vector<RimSide> sides;
    for (const Vec3& n : {q * Vec3{1, 0, 0}, q * Vec3{std::cos(turn), std::sin(turn), 0}})
      sides.push_back({n, sigma * n, g - outer(g * n, n)});
    Sym3 out;
    ASSERT_TRUE(rim_stress(sides, kMaterial, out)) << degrees;
    EXPECT_LT(largest(out - sigma), 1e-11)
        << degrees;  // normal equations: the square of the conditioning, sin(turn)^-2
  }
}

TEST(Rim, ParallelSidesSayNothing) {
  const Real turn = 15 * std::numbers::pi / 180;
  Sym3 out;
  EXPECT_FALSE(rim_stress({{{1, 0, 0}, {}, {}}, {{std::cos(turn), std::sin(turn), 0}, {}, {}}}, kMaterial, out));
  EXPECT_FALSE(rim_stress({{{1, 0, 0}, {}, {}}, {{-1, 0, 0}, {}, {}}}, kMaterial, out));
  EXPECT_FALSE(rim_stress({{{1, 0, 0}, {}, {}}}, kMaterial, out));
}

TEST(Rim, ReentrantEdgesAreLeftOut) {
  // An L: five convex corners, the sixth (the inner one) re-entrant; the ends touch every vertex.
  const SurfaceMesh mesh = prism({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}, 1);
  const SurfaceCorners corners = make_surface_corners(mesh, 35);
  std::vector<std::uint32_t> at;
  for (const Rim& r : convex_rims(mesh, corners)) {
    EXPECT_EQ(r.size(), 3u);
    for (const std::uint32_t c : r) EXPECT_EQ(corners.corner[c].vertex, corners.corner[r[0]].vertex);
    at.push_back(corners.corner[r[0]].vertex);
  }
  std::sort(at.begin(), at.end());
  EXPECT_EQ(at, (std::vector<std::uint32_t>{0, 1, 2, 4, 5, 6, 7, 8, 10, 11}));
  // All of a cavity's edges are re-entrant.
  const SurfaceMesh hollow = with_cavity(make_box({1, 1, 1}, 0.5), make_box({0.5, 0.5, 0.5}, 0.5));
  const SurfaceCorners both = make_surface_corners(hollow, 35);
  const std::size_t outer = make_box({1, 1, 1}, 0.5).vertex_count();
  for (const Rim& r : convex_rims(hollow, both)) EXPECT_LT(both.corner[r[0]].vertex, outer);
  EXPECT_TRUE(convex_rims(make_sphere(1, 0.3), make_surface_corners(make_sphere(1, 0.3), 35)).empty());
}

TEST(Rim, StressAtReentrantEdgesIsWhatTheFitsSay) {
  const SurfaceMesh mesh = with_cavity(make_box({1, 1, 1}, 0.3), make_box({0.5, 0.5, 0.5}, 0.25));
  const std::size_t outer = make_box({1, 1, 1}, 0.3).vertex_count();
  RecoveryOptions without;
  without.rims = false;
  const SurfaceRecovery a(mesh, {}), b(mesh, without);
  Random random(6);
  Vec3Column u, traction;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) u.push_back(random_vector(random));
  for (std::size_t c = 0; c < a.corners().size(); ++c) traction.push_back(random_vector(random));
  const std::vector<Sym3> s = a.stress(u, traction, kMaterial), t = b.stress(u, traction, kMaterial);
  std::size_t changed = 0;
  for (std::size_t c = 0; c < s.size(); ++c) {
    const bool same = s[c] == t[c];
    EXPECT_TRUE(same || a.corners()[c].vertex < outer) << c;
    changed += !same;
  }
  EXPECT_GT(changed, 0u);
}

// Tractions that no stress has (shear on one side alone) are met in the mean, not amplified: the normal equations have
// eigenvalues of sin^2 of half the turn at least.
TEST(Rim, InconsistentTractionsGiveStressOfTheirOwnSize) {
  Random random(7);
  for (const Real degrees : {30.0, 60.0, 90.0, 120.0, 150.0})
    for (int i = 0; i < 50; ++i) {
      const Real turn = (180 - degrees) * std::numbers::pi / 180, half = std::sin(turn / 2) * std::cos(turn / 2);
      const RimSide a{{1, 0, 0}, random_vector(random), {}};
      const RimSide b{{std::cos(turn), std::sin(turn), 0}, random_vector(random), {}};
      Sym3 out;
      ASSERT_TRUE(rim_stress({a, b}, kMaterial, out));
      EXPECT_LT(largest(out), 10 / (half * half)) << degrees;
    }
}

}  // namespace
}  // namespace sherd
