#include "engine/contact/detect.h"

#include <gtest/gtest.h>

#include "engine/mesh/shapes.h"

namespace sherd {
namespace {

Body body_of(std::uint32_t id, const SurfaceMesh& mesh, const Vec3& position) {
  Body b;
  b.id = b.parent = BodyId{id};
  b.mesh = std::make_shared<const SurfaceMesh>(mesh);
  b.mass = mass_properties(mesh, 1000);
  b.pose.position = position;
  return b;
}

struct Found {
  ContactCache cache;
  std::vector<Contact> contacts;
  ContactStats stats;
  void run(std::span<const Body> bodies, const GroundPlane& ground = {}, const DetectOptions& options = {}) {
    detect_contacts(bodies, ground, options, cache, contacts, stats);
  }
};

TEST(Detect, OverlappingSpheresGiveDepthAndNormal) {
  const SurfaceMesh sphere = make_sphere(0.1, 0.01);
  std::vector<Body> bodies{body_of(1, sphere, {0, 0, 0}), body_of(2, sphere, {0.12, 0.15, 0})};
  bodies[1].pose.orientation = from_rotation_vector({0.4, 0.1, -0.9});
  Found f;
  f.run(bodies);
  ASSERT_FALSE(f.contacts.empty());
  const Vec3 axis = normalized(bodies[0].pose.position - bodies[1].pose.position);
  Real deepest = 0;
  for (const Contact& c : f.contacts) {
    EXPECT_EQ(c.a.value, 1u);
    EXPECT_EQ(c.b.value, 2u);
    EXPECT_GT(dot(c.normal, axis), 0.9);  // the overlap's lens spans 0.3 rad
    deepest = std::max(deepest, c.depth);
  }
  // True depth 0.2 - 0.1921; samples 0.01 apart and facets miss up to edge^2 / (2 r) = 0.5 mm on either side.
  EXPECT_NEAR(deepest, 0.2 - norm(bodies[1].pose.position), 1e-3);
}

TEST(Detect, FarBodiesNeedNoFields) {
  const SurfaceMesh box = make_box({0.1, 0.1, 0.1}, 0.05);
  std::vector<Body> bodies{body_of(1, box, {0, 0.05, 0}), body_of(2, box, {0.5, 0.05, 0}),
                           body_of(3, box, {0.5, 0.151, 0})};
  GroundPlane ground;
  ground.enabled = true;
  bodies[2].velocity = {0, -2, 0};
  Found f;
  f.run(bodies, ground);
  EXPECT_EQ(f.stats.pairs_near, 1u);
  EXPECT_EQ(f.stats.fields_built, 2u);
  EXPECT_EQ(f.stats.fields_skipped, 1u);
  f.run(bodies, ground);  // nothing new to build
  EXPECT_EQ(f.cache.builds(), 2u);
  bodies[1].mesh = std::make_shared<const SurfaceMesh>(make_box({0.1, 0.1, 0.08}, 0.05));
  bodies[1].mesh_version = 1;
  f.run(bodies, ground);
  EXPECT_EQ(f.cache.builds(), 3u);
  bodies.pop_back();
  f.run(bodies, ground);
  EXPECT_EQ(f.cache.shapes(), 1u);
}

TEST(Detect, GapsAreReportedOnlyWhenTheStepMayCloseThem) {
  const SurfaceMesh box = make_box({0.1, 0.1, 0.1}, 0.05);
  std::vector<Body> bodies{body_of(1, box, {0, 0, 0}), body_of(2, box, {0.003, 0.105, 0.002})};
  Found f;
  f.run(bodies);
  EXPECT_TRUE(f.contacts.empty());
  bodies[1].velocity = {0, -6, 0};
  f.run(bodies);
  ASSERT_FALSE(f.contacts.empty());
  // Samples beside the other box see its edge, 3 mm away at most; those above it the face.
  std::size_t facing = 0;
  for (const Contact& c : f.contacts) {
    EXPECT_LE(c.depth, -0.005 + 1e-12);
    EXPECT_GE(c.depth, -std::hypot(0.005, 0.003, 0.002) - 1e-12);
    if (c.depth > -0.005 - 1e-12 && c.normal.y < -1 + 1e-9) ++facing;
  }
  EXPECT_GE(facing, 4u);
}

TEST(Detect, GroundContactsAreTheLowVertices) {
  std::vector<Body> bodies{body_of(1, make_box({0.1, 0.1, 0.1}, 0.05), {0, 0.0499, 0})};
  GroundPlane ground;
  ground.enabled = true;
  Found f;
  f.run(bodies, ground);
  ASSERT_EQ(f.contacts.size(), 9u);
  for (const Contact& c : f.contacts) {
    EXPECT_EQ(c.b, kGround);
    EXPECT_NEAR(c.depth, 1e-4, 1e-15);
    EXPECT_EQ(c.normal, (Vec3{0, 1, 0}));
  }
}

TEST(Detect, ReductionKeepsTheDeepestAndTheExtremes) {
  std::vector<Contact> contacts;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) {
      Contact c;
      c.point = {0.01 * i, 0, 0.01 * j};
      c.normal = {0, 1, 0};
      c.depth = i == 7 && j == 11 ? 1.1e-4 : 1e-4;
      contacts.push_back(c);
    }
  reduce_contacts(contacts, 5);
  ASSERT_EQ(contacts.size(), 5u);
  Box box;
  bool deepest = false;
  for (const Contact& c : contacts) box.grow(c.point), deepest = deepest || c.depth > 1.05e-4;
  EXPECT_TRUE(deepest);
  EXPECT_NEAR(box.diagonal(), 0.19 * std::sqrt(2.0), 1e-12);
}

}  // namespace
}  // namespace sherd
