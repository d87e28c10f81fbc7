#include <gtest/gtest.h>

#include "tests/rigid/bodies.h"

namespace sherd {
namespace {

enum class Ware { kFlat, kDinner };

// Ten plates on the ground; plate shapes differ a little in the way they lie.
Sim plates(Ware ware, Real sleep_speed) {
  Sim run;
  run.ground.enabled = true;
  run.options.sleep_speed = sleep_speed;
  for (std::uint32_t i = 0; i < 10; ++i) {
    SurfaceMesh mesh = ware == Ware::kFlat ? make_plate(0.2, 0.2, 0.008, 0.025) : make_dinner_plate(0.12, 0.006, 0.02);
    const Real pitch = ware == Ware::kFlat ? 0.008 : 0.006 / std::cos(3.14159265358979 / 6);
    Body b = make_body(i, std::move(mesh), {0.002 * std::cos(2.0 * i), 0, 0.002 * std::sin(3.0 * i)});
    if (ware == Ware::kDinner) b.pose.position.x = b.pose.position.z = 0;
    b.pose.orientation = from_rotation_vector({0, 0.3 * i, 0});
    const Box box = bounding_box(*b.mesh);
    b.pose.position.y = b.mass.centre.y - box.low.y + pitch * i;
    run.bodies.push_back(std::move(b));
  }
  return run;
}

// At rest nothing moves by more than 1 mm in ten seconds, no kinetic energy is left, the ground bears the weight.
void expect_rest(Sim run) {
  const std::vector<Body> start = run.bodies;
  Real most = 0;
  const Real weight = [&] {
    Real sum = 0;
    for (const Body& b : run.bodies) sum += 9.81 * b.mass.mass;
    return sum;
  }();
  for (int i = 0; i < 10000; ++i) {
    run.step();
    if (i >= 2000) most = std::max(most, kinetic_energy(run));
    if (run.options.sleep_speed > 0 || i < 2000 || i % 100 != 0) continue;
    for (std::size_t k = 0; k < run.bodies.size(); ++k) {
      Vec3 sum;  // each plate bears what lies on it
      Real above = 0;
      for (const Contact& c : run.contacts)
        if (c.a == run.bodies[k].id && (c.b == kGround || c.b < c.a))
          sum += c.impulse;
        else if (c.b == run.bodies[k].id && c.a < c.b)
          sum -= c.impulse;
      for (std::size_t j = k; j < run.bodies.size(); ++j) above += 9.81 * run.bodies[j].mass.mass;
      EXPECT_NEAR(sum.y, above * run.options.dt, 0.01 * above * run.options.dt) << k;
    }
  }
  for (std::size_t k = 0; k < run.bodies.size(); ++k)
    EXPECT_LT(distance(run.bodies[k].pose.position, start[k].pose.position), 1e-3) << k;
  // Of the energy a fall by a hundredth of a millimetre gives.
  EXPECT_LT(most, weight * 1e-5);
}

TEST(SlowStack, TenFlatPlatesStandAwake) {
  expect_rest(plates(Ware::kFlat, 0));
}
TEST(SlowStack, TenFlatPlatesStandAndSleep) {
  expect_rest(plates(Ware::kFlat, 0.01));
}
TEST(SlowStack, TenDinnerPlatesStandAwake) {
  expect_rest(plates(Ware::kDinner, 0));
}
TEST(SlowStack, TenDinnerPlatesStandAndSleep) {
  expect_rest(plates(Ware::kDinner, 0.01));
}

// Masses 1 to 1e4, both ways; the light body between the heavy one and the ground bears both.
TEST(Stack, MassesOneToTenThousandStand) {
  for (const bool heavy_above : {false, true}) {
    Sim run;
    run.ground.enabled = true;
    run.options.sleep_speed = 0;
    run.bodies = {make_body(1, make_box({0.1, 0.1, 0.1}, 0.05), {0, 0.05, 0}),
                  make_body(2, make_box({0.12, 0.1, 0.12}, 0.05), {0.004, 0.15, -0.003})};
    Body& heavy = run.bodies[heavy_above ? 1 : 0];
    heavy.mass.mass *= 1e4, heavy.mass.inertia *= 1e4, heavy.density *= 1e4;
    const std::vector<Body> start = run.bodies;
    run.steps(2000);
    for (std::size_t k = 0; k < 2; ++k)
      EXPECT_LT(distance(run.bodies[k].pose.position, start[k].pose.position), 1e-4) << heavy_above << k;
    EXPECT_EQ(run.stats.unconverged, 0u);
    Real ground = 0, between = 0;
    for (const Contact& c : run.contacts) (c.b == kGround ? ground : between) += std::abs(c.impulse.y);
    const Real g = 9.81 * run.options.dt, upper = run.bodies[1].mass.mass, both = upper + run.bodies[0].mass.mass;
    EXPECT_NEAR(between, upper * g, 0.01 * upper * g);
    EXPECT_NEAR(ground, both * g, 0.01 * both * g);
  }
}

}  // namespace
}  // namespace sherd
