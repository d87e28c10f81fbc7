#include "engine/mesh/embree_scene.h"

#include <gtest/gtest.h>

#include "engine/mesh/bvh.h"
#include "engine/mesh/shapes.h"
#include "kernels/core/random.h"

namespace sherd {
namespace {

TEST(EmbreeScene, ClosestPointsAgreeWithTheDoublePrecisionHierarchy) {
  SurfaceMesh mesh = make_torus(0.1, 0.03, 0.01);
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i)
    mesh.vertices.add(i, {1000, -500, 20});  // float would lose 1e-4 m here
  const TriangleBvh bvh(mesh);
  const EmbreeScene scene(mesh);
  Random random(1);
  Vec3Column points;
  for (int i = 0; i < 3000; ++i) {
    const Real far = i % 10 == 0 ? 50 : 0.2;
    points.push_back(Vec3{1000, -500, 20} +
                     Vec3{random.uniform(-far, far), random.uniform(-far, far), random.uniform(-far, far)});
  }
  std::vector<EmbreeScene::Closest> found;
  scene.closest(points, std::numeric_limits<Real>::infinity(), found);
  for (std::size_t i = 0; i < points.size(); ++i) ASSERT_EQ(found[i].distance2, bvh.closest(points[i]).distance2);
}

TEST(EmbreeScene, NothingWithinTheDistanceIsNoFace) {
  const EmbreeScene scene(make_sphere(1, 0.3));
  EXPECT_EQ(scene.closest({2, 0, 0}, 0.5).face, kNone);
  EXPECT_NE(scene.closest({2, 0, 0}, 1.1).face, kNone);
}

TEST(EmbreeScene, RaysHitTheFirstFaceOfAHollowSphere) {
  const SurfaceMesh mesh = make_hollow_sphere(0.1, 0.07, 0.02);
  const TriangleBvh bvh(mesh);
  const EmbreeScene scene(mesh);
  Random random(2);
  std::vector<TriangleBvh::Hit> hits;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 o{random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 0.4},
        d{random.uniform(-1, 1), random.uniform(-1, 1), -1.5};
    bvh.all_hits(o, d, 0, 10, hits);
    const EmbreeScene::Hit hit = scene.first_hit(o, d, 0, 10);
    ASSERT_EQ(hit.face != kNone, !hits.empty());
    if (!hits.empty()) {
      ASSERT_NEAR(hit.t, hits[0].t, 1e-6);
    }
  }
}

}  // namespace
}  // namespace sherd
