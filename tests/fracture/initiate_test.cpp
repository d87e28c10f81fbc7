// Which vertices start cracks.
#include "engine/fracture/initiate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/elastostatic/solver.h"
#include "engine/fracture/guide.h"
#include "engine/fragment/cut.h"
#include "engine/mesh/remesh.h"
#include "engine/mesh/shapes.h"
#include "kernels/core/random.h"

namespace sherd {
namespace {

std::vector<Real> values(const SurfaceMesh& mesh, Real (*f)(const Vec3&)) {
  std::vector<Real> value;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) value.push_back(f(mesh.vertices[v]));
  return value;
}

TEST(FindPeaks, EachHillIsFoundOnceHighestFirst) {
  const SurfaceMesh mesh = make_sphere(1, 0.1);
  // Hills at +x (height 2), -x (1.5) and +y (1.2).
  const auto hills = values(mesh, [](const Vec3& p) {
    const auto hill = [&](const Vec3& c) { return std::exp(-8 * distance2(p, c)); };
    return 2 * hill({1, 0, 0}) + 1.5 * hill({-1, 0, 0}) + 1.2 * hill({0, 1, 0});
  });
  const std::vector<std::uint32_t> peaks = find_peaks(mesh, hills, 1);
  ASSERT_EQ(peaks.size(), 3u);
  const Vec3 expected[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}};
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(distance(mesh.vertices[peaks[i]], expected[i]), 0.1) << i;
  EXPECT_EQ(find_peaks(mesh, hills, 1.3).size(), 2u);
  EXPECT_TRUE(find_peaks(mesh, hills, 2.5).empty());
}

TEST(FindPeaks, APlateauIsOnePeakAtItsMiddle) {
  const SurfaceMesh mesh = make_box({4, 1, 1}, 0.125);
  // The band |x - 1| <= 0.5 of the bar's surface; its centre lies on the axis, so any side's middle is as near.
  const auto band = values(mesh, [](const Vec3& p) { return std::abs(p.x - 1) <= 0.5 ? 3.0 : 1.0; });
  const std::vector<std::uint32_t> peaks = find_peaks(mesh, band, 2);
  ASSERT_EQ(peaks.size(), 1u);
  const Vec3 at = mesh.vertices[peaks[0]];
  EXPECT_NEAR(at.x, 1, 0.125);
  EXPECT_NEAR(norm(Vec3{0, at.y, at.z}), 0.5, 0.125);
}

TEST(FindPeaks, RoundingOnAPlateauMakesNoMorePeaks) {
  const SurfaceMesh mesh = make_sphere(1, 0.1);
  Random random(3);
  std::vector<Real> noisy(mesh.vertex_count());
  for (Real& v : noisy) v = 5 * (1 + 0.9 * kPlateau * random.uniform());
  EXPECT_EQ(find_peaks(mesh, noisy, 1).size(), 1u);
  for (Real& v : noisy) v = 5 * (1 + 100 * kPlateau * random.uniform());
  EXPECT_GT(find_peaks(mesh, noisy, 1).size(), 10u) << "differences beyond the plateau are hills";
}

TEST(FindPeaks, AShoulderOfAHigherHillIsNoPeak) {
  const SurfaceMesh mesh = make_sphere(1, 0.1);
  const auto stairs = values(mesh, [](const Vec3& p) { return p.x > 0.8 ? 3.0 : p.x > 0.3 ? 2.0 : 0.5; });
  const std::vector<std::uint32_t> peaks = find_peaks(mesh, stairs, 1);
  ASSERT_EQ(peaks.size(), 1u);
  EXPECT_GT(mesh.vertices[peaks[0]].x, 0.8);
}

TEST(FindPeaks, TheOrderOfFacesMeansNothing) {
  SurfaceMesh mesh = make_sphere(1, 0.15);
  const auto waves =
      values(mesh, [](const Vec3& p) { return std::sin(4 * p.x + 1) + std::sin(5 * p.y) + std::sin(6 * p.z + 2); });
  const std::vector<std::uint32_t> peaks = find_peaks(mesh, waves, 0.5);
  EXPECT_GT(peaks.size(), 1u);
  std::reverse(mesh.triangles.begin(), mesh.triangles.end());
  EXPECT_EQ(find_peaks(mesh, waves, 0.5), peaks);
}

constexpr Real kPull = 1e6;  // Pa

// A body pulled along x by its faces that look that way.
struct Pulled {
  explicit Pulled(const SurfaceMesh& m) : mesh(m) {}
  SurfaceMesh mesh;
  TriangleBvh bvh{mesh};
  ElasticBody body{mesh, Elastic{.mu = 3e10, .nu = 0.22}, {}};
  SurfaceRecovery recovery{mesh, {}};
  Load load = pull();
  ParticularSolution particular = body.particular(load);
  ElasticSolution solution = body.solve(load, particular);
  StressState state{body, recovery, bvh, load, particular, solution};

 private:
  Load pull() const {
    Load l;
    l.face_traction.resize(mesh.triangle_count());
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
      if (const Real x = normalized(mesh.area_normal2(t)).x; std::abs(x) > 0.99)
        l.face_traction.set(t, {std::copysign(kPull, x), 0, 0});
    return l;
  }
};

// Uniform stress, so the strength alone decides where the crack starts.
class PulledBar : public testing::Test, public Pulled {
 protected:
  PulledBar() : Pulled(make_box({4, 1, 1}, 0.25)) {}
  // Strength with a dip of relative depth 0.2 at x = `weak`.
  struct Weak final : ScalarField {
    explicit Weak(Real weak_) : weak(weak_) {}
    Real at(const Vec3& x) const override { return kPull * (1 - 0.2 * std::exp(-20 * (x.x - weak) * (x.x - weak))); }
    Real lower() const override { return 0.8 * kPull; }
    Real upper() const override { return kPull; }
    Real weak;
  };
};

TEST_F(PulledBar, UniformStressStartsOneCrackInTheMiddle) {
  ASSERT_TRUE(solution.ok);
  const auto seeds = find_seeds(mesh, recovery, state, *constant_field(0.9 * kPull));
  ASSERT_EQ(seeds.size(), 1u);
  EXPECT_NEAR(seeds[0].position.x, 0, 0.26);
  EXPECT_NEAR(seeds[0].stress.value, kPull, 2e-3 * kPull);
  EXPECT_GT(std::abs(seeds[0].stress.direction.x), 0.999);
  EXPECT_TRUE(find_seeds(mesh, recovery, state, *constant_field(1.1 * kPull)).empty());
}

TEST_F(PulledBar, TheWeakPlaceBreaksUnderUniformStress) {
  for (const Real weak : {-1.25, 0.5, 1.5}) {
    const Weak strength(weak);
    const auto seeds = find_seeds(mesh, recovery, state, strength);
    ASSERT_FALSE(seeds.empty());
    EXPECT_NEAR(seeds[0].position.x, weak, 0.26);
    EXPECT_EQ(strongest_point(mesh, recovery, state, strength).position.x, seeds[0].position.x);
  }
}

// The flanks of a sharp notch are free surfaces: their own stress points along them, 60 degrees from the bar's axis.
TEST(NotchedBar, ASeedAtTheTipOpensAlongTheBar) {
  const Real h = 0.13;
  const SurfaceMesh bar = make_box({2, 1, 0.4}, h);
  // 60 degrees between the flanks.
  const Real depth = 0.25, width = 2 * depth * std::tan(std::numbers::pi / 6);
  const auto wedge = notch_wedge(GuidePlane{{0.013, -0.5, 0}, {1, 0, 0}, depth}, TriangleBvh(bar), width, h);
  ASSERT_TRUE(wedge);
  const CutResult notched = cut(bar, *wedge, {.edge_length = h});
  ASSERT_TRUE(notched.ok) << notched.reason;
  SurfaceMesh mesh;
  ASSERT_EQ(remesh(notched.fragments[0], {.edge_length = h}, mesh).status, RemeshStatus::kOk);
  const Pulled pulled(mesh);
  ASSERT_TRUE(pulled.solution.ok);
  const auto seeds = find_seeds(mesh, pulled.recovery, pulled.state, *constant_field(1.5 * kPull));
  ASSERT_FALSE(seeds.empty());
  std::size_t at_tip = 0;
  for (const CrackSeed& seed : seeds) {
    if (std::abs(seed.position.x - 0.013) > 0.01 || seed.position.y > -0.2) continue;
    ++at_tip;
    EXPECT_GT(std::abs(seed.stress.direction.x), std::cos(10 * std::numbers::pi / 180));
    EXPECT_GT(seed.stress.value, 2 * kPull);
  }
  EXPECT_GT(at_tip, 0u);
}

}  // namespace
}  // namespace sherd
