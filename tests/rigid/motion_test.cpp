#include <gtest/gtest.h>

#include "kernels/core/error.h"
#include "kernels/core/random.h"
#include "tests/rigid/bodies.h"

namespace sherd {
namespace {

TEST(Motion, FreeFallIsTheParabola) {
  Sim run;
  run.bodies = {make_body(1, make_box({0.1, 0.1, 0.1}, 0.1), {0, 10, 0}, {1, 0, 0})};
  const int n = 500;
  run.steps(n);
  // Gravity acts in the middle of a step, so positions are exact; n additions round by at most n ulp each.
  const Real g = 9.81, dt = run.options.dt;
  EXPECT_NEAR(run.bodies[0].velocity.y, -g * dt * n, 1e-12);
  EXPECT_NEAR(run.bodies[0].pose.position.y, 10 - 0.5 * g * dt * dt * n * n, 1e-11);
  EXPECT_NEAR(run.bodies[0].pose.position.x, dt * n, 1e-12);
  EXPECT_EQ(run.contacts.size(), 0u);
}

TEST(Motion, TumblingBodyKeepsAngularMomentumAndEnergy) {
  Sim run;
  run.options.gravity = {0, 0, 0};
  run.bodies = {make_body(1, make_box({0.1, 0.2, 0.4}, 0.1), {0, 0, 0})};
  run.bodies[0].angular_velocity = {3, 20, 1};  // about the unstable middle axis: it flips over
  const Vec3 l = angular_momentum(run.bodies[0]);
  const Real e = kinetic_energy(run);
  Real least = 1;
  for (int i = 0; i < 1000; ++i) {
    run.step();
    least = std::min(least, rotate(run.bodies[0].pose.orientation, {0, 1, 0}).y);
  }
  EXPECT_LT(least, -0.5);
  // Both are invariants of the scheme: 1000 steps of a few ulp.
  EXPECT_LT(norm(angular_momentum(run.bodies[0]) - l), 1e-11 * norm(l));
  EXPECT_NEAR(kinetic_energy(run), e, 1e-11 * e);
}

// Chips of a broken plate may be needles of 1 to 300; a fixed point for the middle momentum diverges there, which gave
// one of them 5e-8 J in a step (fuzz seed 7040).
TEST(Motion, NeedlesKeepAngularMomentumAndEnergy) {
  Random random(42);
  for (int n = 0; n < 2000; ++n) {
    const Real thin = std::pow(10, random.uniform(-3, 0));
    const Vec3 edge{1, thin, thin * random.uniform(0.05, 1)},
        spin = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    Body b;
    b.mass.mass = 12;
    for (int k = 0; k < 3; ++k) b.mass.inertia[k][k] = norm2(edge) - edge[k] * edge[k];
    b.angular_velocity = spin * 1000;
    const Vec3 l = spin_momentum(b);
    const Real e = energy(b, {}).kinetic;
    move_freely(b, 0.1);  // some 200 turns of a quarter radian
    // A few ulp a turn, at worst all to the same side: 200 times 3e-16, and in the energy squared, with a margin of 5.
    EXPECT_LT(norm(spin_momentum(b) - l), 1e-13 * norm(l));
    EXPECT_NEAR(energy(b, {}).kinetic, e, 6e-13 * e) << n;
  }
}

TEST(Motion, FixedBodyNeverMoves) {
  Sim run;
  run.bodies = {make_body(1, make_box({1, 0.1, 1}, 1), {0, 0, 0}),
                make_body(2, make_box({0.1, 0.1, 0.1}, 0.1), {0, 0.12, 0})};
  run.bodies[0].fixed = true;
  run.steps(200);
  EXPECT_EQ(run.bodies[0].pose, Pose{});
  EXPECT_EQ(run.bodies[0].velocity, Vec3{});
  EXPECT_GT(run.bodies[1].pose.position.y, 0.0995);
}

TEST(Motion, NonFiniteVelocityIsRefused) {
  Sim run;
  run.bodies = {make_body(1, make_box({0.1, 0.1, 0.1}, 0.1), {0, 1, 0}, {std::nan(""), 0, 0})};
  EXPECT_THROW(run.step(), InternalError);
}

}  // namespace
}  // namespace sherd
