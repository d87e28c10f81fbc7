#include "engine/contact/free_time.h"

#include <gtest/gtest.h>

#include "engine/mesh/shapes.h"

namespace sherd {
namespace {

Body body_of(std::uint32_t id, const SurfaceMesh& mesh, const Vec3& position, const Vec3& velocity = {}) {
  Body b;
  b.id = b.parent = BodyId{id};
  b.mesh = std::make_shared<const SurfaceMesh>(mesh);
  b.mass = mass_properties(mesh, 1000);
  b.pose.position = position, b.velocity = velocity;
  return b;
}

FreeTime free_of(const std::vector<Body>& bodies, Real time, const GroundPlane& ground = {}, const Vec3& gravity = {}) {
  ContactCache cache;
  cache.update(bodies);
  return free_time(bodies, ground, {.time = time, .margin = 1e-3, .gravity = gravity}, cache);
}

TEST(FreeTime, EndsWhereFastBodiesMeet) {
  const SurfaceMesh box = make_box({0.1, 0.1, 0.1}, 0.05);
  const Real gap = 0.37, speed = 80;
  const FreeTime free =
      free_of({body_of(1, box, {0, 0, 0}), body_of(2, box, {0.1 + gap, 0.01, 0.02}, {-speed, 0, 0})}, 0.01);
  // Up to the margin, 1e-3 of the diagonal of 0.173 m, of the gap is left.
  EXPECT_LT(free.time, gap / speed);
  EXPECT_GT(free.time, (gap - 2e-4) / speed);
}

TEST(FreeTime, GravityCountsAgainstTheGround) {
  const SurfaceMesh box = make_box({0.1, 0.1, 0.1}, 0.05);
  GroundPlane ground;
  ground.enabled = true;
  const Real height = 0.1, g = 9.81;
  const FreeTime free = free_of({body_of(1, box, {0, 0.05 + height, 0})}, 1, ground, {0, -g, 0});
  const Real exact = std::sqrt(2 * height / g);
  EXPECT_LT(free.time, exact);
  EXPECT_GT(free.time, exact * (1 - 0.01));  // the least advance is a quarter of 4 % of the size: 1.7 mm at g exact
}

TEST(FreeTime, SlowBodiesAndThoseThatPassAskForNothing) {
  const SurfaceMesh box = make_box({0.1, 0.1, 0.1}, 0.05);
  EXPECT_EQ(free_of({body_of(1, box, {0, 0, 0}), body_of(2, box, {0.101, 0, 0}, {-1, 0, 0})}, 1e-3).time, 1e-3);
  const FreeTime passing = free_of({body_of(1, box, {0, 0, 0}), body_of(2, box, {-0.5, 0.11, 0}, {100, 0, 0})}, 0.01);
  EXPECT_EQ(passing.time, 0.01);
  ASSERT_EQ(passing.apart.size(), 1u);
  EXPECT_EQ(passing.apart[0], BodyPair(0, 1));
}

// Rims of 3 mm that cross at 90 degrees: vertices are 5 cm away.
TEST(Edges, CrossingRimsAreFoundWithTheirDistance) {
  const SurfaceMesh plate = make_box({0.15, 0.1, 0.003}, 0.15);
  for (const Real gap : {0.0004, -0.0004}) {
    std::vector<Body> bodies{body_of(1, plate, {0, 0, 0}), body_of(2, plate, {0.013, 0.1 + gap, 0.011})};
    bodies[1].pose.orientation = from_rotation_vector({0, 1.5707963267948966, 0});
    ContactCache cache;
    std::vector<Contact> contacts;
    ContactStats stats;
    detect_contacts(bodies, {}, {.dt = 1e-3, .margin = 5e-3}, cache, contacts, stats);
    std::size_t rims = 0;
    for (const Contact& c : contacts) {
      if (std::abs(c.normal.y + 1) > 1e-9) continue;
      EXPECT_NEAR(c.depth, -gap, 1e-12);
      ++rims;
    }
    EXPECT_GE(rims, 4u) << gap;  // two edges of either rim
  }
}

}  // namespace
}  // namespace sherd
