#include <gtest/gtest.h>

#include "engine/contact/shape.h"
#include "engine/mesh/shapes.h"
#include "kernels/core/parallel.h"
#include "kernels/core/random.h"

namespace sherd {
namespace {

SignedDistanceField field_of(const SurfaceMesh& mesh, const FieldOptions& options = {}) {
  return SignedDistanceField(mesh, TriangleBvh(mesh), options);
}

Vec3 random_point(Random& random, Real half) {
  return {random.uniform(-half, half), random.uniform(-half, half), random.uniform(-half, half)};
}

Real box_distance(const Vec3& p, const Vec3& half) {
  const Vec3 q{std::abs(p.x) - half.x, std::abs(p.y) - half.y, std::abs(p.z) - half.z};
  return norm(max(q, Vec3{})) + std::min(0.0, std::max({q.x, q.y, q.z}));
}

TEST(DistanceField, SphereWithinAGridStepAndItsGradientPointsOut) {
  const SurfaceMesh mesh = make_sphere(0.1, 0.01);
  const SignedDistanceField f = field_of(mesh);
  Random random(1);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p = random_point(random, 0.11);
    const Real exact = norm(p) - 0.1;
    // Near the surface: trilinear error h^2 / (8 r) per axis plus the facets' sagitta edge^2 / (8 r); beyond, the
    // carried face may miss the nearest one.
    ASSERT_NEAR(f.value(p), exact, std::abs(exact) < f.spacing() ? 0.2 * f.spacing() : 1.0 * f.spacing());
    if (std::abs(exact) < 0.02) {
      ASSERT_GT(dot(normalized(f.gradient(p)), normalized(p)), 0.97);
    }
  }
}

TEST(DistanceField, BoxWithinAGridStepAndExactBeforeItsFaces) {
  const Vec3 half{0.1, 0.06, 0.03};
  const SignedDistanceField f = field_of(make_box(2.0 * half, 0.03));
  Random random(2);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p = min(max(random_point(random, 0.12), f.box().low), f.box().high);
    // 1-Lipschitz nodes at most half a cell diagonal away: sqrt(3)/2 h, and the carried faces' error beyond the band.
    ASSERT_NEAR(f.value(p), box_distance(p, half), f.spacing());
  }
  for (int i = 0; i < 500; ++i) {  // over the middle of the top face distance is linear: float rounding only
    const Vec3 p{random.uniform(-0.08, 0.08), 0.06 + random.uniform(-0.5, 0.5) * f.spacing(),
                 random.uniform(-0.01, 0.01)};
    ASSERT_NEAR(f.value(p), p.y - 0.06, 1e-6 * 0.1);
  }
}

TEST(DistanceField, FarOutsideTheGridTheValueIsALowerBound) {
  const Vec3 half{0.1, 0.06, 0.03};
  const SignedDistanceField f = field_of(make_box(2.0 * half, 0.03));
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = random_point(random, 1.0);
    const Real exact = box_distance(p, half);
    ASSERT_LT(f.value(p), exact + f.spacing());
    ASSERT_GT(f.value(p), 0.5 * exact - f.spacing());
  }
}

TEST(DistanceField, HollowSphereKnowsItsCavity) {
  const SurfaceMesh mesh = make_hollow_sphere(0.1, 0.07, 0.015);
  const SignedDistanceField f = field_of(mesh);
  Random random(4);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p = random_point(random, 0.1);
    const Real r = norm(p), exact = std::max(r - 0.1, 0.07 - r);
    // Facets of edge 0.015 lie up to 0.4 mm inside the spheres.
    if (std::abs(exact) > 0.5e-3 + f.spacing()) {
      ASSERT_EQ(f.value(p) < 0, exact < 0) << r;
    }
  }
}

TEST(DistanceField, ThinPlateHasAnInside) {
  const SignedDistanceField f = field_of(make_plate(0.2, 0.2, 0.004, 0.02));
  EXPECT_LT(f.value({0.013, 0, 0.027}), -0.001);
  EXPECT_GT(f.value({0.013, 0.004, 0.027}), 0.001);
  EXPECT_LE(f.node_count(), 300'000u);
}

TEST(DistanceField, SameBitsForAnyNumberOfThreads) {
  const SurfaceMesh mesh = make_sphere(0.1, 0.02);
  std::vector<Real> values[2];
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    const SignedDistanceField f = field_of(mesh);
    Random random(5);
    for (int i = 0; i < 2000; ++i) values[threads == 4].push_back(f.value(random_point(random, 0.12)));
  }
  EXPECT_EQ(values[0], values[1]);
}

TEST(CollisionShape, NearestIsSignedExactlyNearEdgesAndCorners) {
  const Vec3 half{0.1, 0.06, 0.03};
  const CollisionShape shape(std::make_shared<const SurfaceMesh>(make_box(2.0 * half, 0.05)));
  Random random(6);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 corner{half.x * (i & 1 ? 1 : -1), half.y * (i & 2 ? 1 : -1), half.z * (i & 4 ? 1 : -1)};
    const Vec3 p = (i % 3 ? corner : Vec3{corner.x, corner.y, 0.01}) + random_point(random, 0.004);
    const CollisionShape::Nearest near = shape.nearest(p, 1);
    ASSERT_TRUE(near.found);
    ASSERT_NEAR(near.distance, box_distance(p, half), 1e-14);
    ASSERT_NEAR(norm(p - near.point - near.normal * near.distance), 0, 1e-14);
  }
}

TEST(PointShell, ChunksHoldEverySampleAndNormalsPointOut) {
  const SurfaceMesh mesh = make_box({0.2, 0.12, 0.06}, 1.0);  // 12 triangles: edges and faces are sampled
  const PointShell shell = point_shell(mesh, pseudo_normals(mesh), 0.02);
  EXPECT_GT(shell.points.size(), 100u);
  std::size_t covered = 0;
  for (const PointShell::Chunk& c : shell.chunks) {
    covered += c.count;
    for (std::uint32_t i = c.first; i < c.first + c.count; ++i)
      EXPECT_LE(distance(shell.points[i], c.centre), c.radius * (1 + 1e-12));
  }
  EXPECT_EQ(covered, shell.points.size());
  for (std::size_t i = 0; i < shell.points.size(); ++i) {
    EXPECT_NEAR(box_distance(shell.points[i], {0.1, 0.06, 0.03}), 0, 1e-15);
    EXPECT_NEAR(norm(shell.normals[i]), 1, 1e-12);
    EXPECT_GT(box_distance(shell.points[i] + shell.normals[i] * 1e-4, {0.1, 0.06, 0.03}), 0);
  }
}

}  // namespace
}  // namespace sherd
