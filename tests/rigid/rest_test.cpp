#include <gtest/gtest.h>

#include "kernels/core/parallel.h"
#include "tests/rigid/bodies.h"

namespace sherd {
namespace {

TEST(Rest, BoxOnTheGroundStays) {
  Sim run;
  run.ground.enabled = true;
  run.options.sleep_speed = 0;  // it must be the contacts that hold it
  run.bodies = {make_body(1, make_box({0.1, 0.1, 0.1}, 0.02), {0, 0.05, 0})};
  run.steps(2000);
  EXPECT_LT(norm(run.bodies[0].pose.position - Vec3{0, 0.05, 0}), 1e-3);
  Vec3 impulse;
  for (const Contact& c : run.contacts) impulse += c.impulse;
  // At rest the contacts carry the weight; the solve leaves 1e-5 of g dt a contact.
  EXPECT_NEAR(impulse.y, run.bodies[0].mass.mass * 9.81 * run.options.dt,
              1e-3 * run.bodies[0].mass.mass * 9.81 * run.options.dt);
}

Sim stack() {
  Sim run;
  run.ground.enabled = true;
  run.bodies = {make_body(1, make_box({0.1, 0.1, 0.1}, 0.05), {0, 0.05, 0}),
                make_body(2, make_box({0.1, 0.1, 0.1}, 0.05), {0.01, 0.15, 0.005}),
                make_body(3, make_box({0.1, 0.1, 0.1}, 0.05), {0, 0.25, 0})};
  return run;
}

TEST(Rest, StackOfThreeBoxesStands) {
  Sim run = stack();
  run.options.sleep_speed = 0;
  run.steps(2000);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(run.bodies[static_cast<std::size_t>(i)].pose.position.y, 0.05 + 0.1 * i, 1e-3);
    EXPECT_NEAR(run.bodies[static_cast<std::size_t>(i)].pose.position.x, i == 1 ? 0.01 : 0, 1e-3);
  }
}

TEST(Rest, AlignedStackStands) {
  Sim run = stack();
  run.options.sleep_speed = 0;
  run.bodies[1].pose.position = {0, 0.15, 0};
  run.steps(2000);
  for (int i = 0; i < 3; ++i)
    EXPECT_LT(norm(run.bodies[static_cast<std::size_t>(i)].pose.position - Vec3{0, 0.05 + 0.1 * i, 0}), 1e-3);
}

TEST(Rest, StackFallsAsleepAndATouchWakesIt) {
  Sim run = stack();
  run.steps(1000);
  EXPECT_EQ(run.stats.asleep, 3u);
  EXPECT_TRUE(run.contacts.empty());
  run.bodies.push_back(make_body(4, make_sphere(0.03, 0.02), {0.02, 0.4, 0}));
  run.steps(100);  // falls 0.05 m, has 0.07 m to go
  EXPECT_EQ(run.stats.asleep, 3u);
  std::size_t woken = 0;
  for (int i = 0; i < 40; ++i) run.step(), woken += run.stats.woken;
  EXPECT_EQ(woken, 3u);
  EXPECT_EQ(run.stats.asleep, 0u);
}

TEST(Rest, SleeperFallsWhenItsSupportIsRemoved) {
  Sim run = stack();
  run.steps(1000);
  ASSERT_EQ(run.stats.asleep, 3u);
  run.bodies.erase(run.bodies.begin() + 1);
  run.steps(100);
  EXPECT_NEAR(run.bodies[1].pose.position.y, 0.25 - 0.5 * 9.81 * 0.01, 1e-3);
}

TEST(Rest, OverlappingSiblingsSeparateSlowly) {
  // Two halves that overlap by 1 mm, as if a crack surface had crossed itself.
  Sim run;
  run.options.gravity = {0, 0, 0};
  run.bodies = {make_body(1, make_box({0.1, 0.1, 0.1}, 0.02), {-0.0495, 0, 0}),
                make_body(2, make_box({0.1, 0.08, 0.08}, 0.02), {0.0495, 0.001, 0.002})};
  for (Body& b : run.bodies) b.parent = BodyId{0}, b.generation = 1, b.material.restitution = 0.9;
  Real fastest = 0;
  for (int i = 0; i < 300; ++i) {
    run.step();
    for (const Body& b : run.bodies) fastest = std::max(fastest, norm(b.velocity) + 0.1 * norm(b.angular_velocity));
  }
  EXPECT_LT(fastest, 1e-9);  // recovery moves them but gives no velocity
  EXPECT_GT(run.bodies[1].pose.position.x - run.bodies[0].pose.position.x, 0.0998);
}

TEST(Rest, NewbornSiblingsDoNotBounce) {
  Sim run;
  run.options.gravity = {0, 0, 0};
  run.bodies = {make_body(1, make_box({0.1, 0.1, 0.1}, 0.02), {-0.05, 0, 0}, {1, 0, 0}),
                make_body(2, make_box({0.1, 0.1, 0.1}, 0.02), {0.0501, 0, 0}, {-1, 0, 0})};
  for (Body& b : run.bodies) b.parent = BodyId{0}, b.generation = 1, b.material.restitution = 0.9;
  run.steps(2);
  EXPECT_LT(kinetic_energy(run), 1e-6 * run.bodies[0].mass.mass);
}

TEST(Rest, SameBitsForAnyNumberOfThreads) {
  std::vector<std::vector<Body>> results;
  for (const int threads : {1, 2, 4}) {
    const ThreadLimit limit(threads);
    Sim run;
    run.ground.enabled = true;
    for (std::uint32_t i = 0; i < 8; ++i) {
      const Real a = 0.7 * i;
      SurfaceMesh mesh = i % 2 ? make_box({0.06, 0.04, 0.08}, 0.02) : make_sphere(0.03, 0.01);
      run.bodies.push_back(make_body(i, std::move(mesh), {0.02 * std::cos(a), 0.05 + 0.06 * i, 0.02 * std::sin(a)}));
      run.bodies.back().pose.orientation = from_rotation_vector({a, -a, 0.3});
    }
    run.steps(300);
    results.push_back(run.bodies);
  }
  for (std::size_t r = 1; r < results.size(); ++r)
    for (std::size_t i = 0; i < results[0].size(); ++i) {
      EXPECT_EQ(results[r][i].pose, results[0][i].pose);
      EXPECT_EQ(results[r][i].velocity, results[0][i].velocity);
      EXPECT_EQ(results[r][i].angular_velocity, results[0][i].angular_velocity);
    }
}

}  // namespace
}  // namespace sherd
