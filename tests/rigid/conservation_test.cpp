#include <gtest/gtest.h>

#include "kernels/core/random.h"
#include "tests/rigid/bodies.h"

namespace sherd {
namespace {

SurfaceMesh shape_of(int kind) {
  switch (kind % 4) {
    case 0:
      return make_box({0.1, 0.06, 0.08}, 0.03);
    case 1:
      return make_sphere(0.05, 0.02);
    case 2:
      return make_plate(0.2, 0.12, 0.006, 0.03);
    default:
      return make_cylinder(0.03, 0.12, 0.02);
  }
}

// Eight bodies flying and spinning at a common centre, so that they meet, several at once, again and again.
Sim swarm(std::uint64_t seed, Real friction, Real restitution) {
  Random random(seed);
  const auto vector = [&](Real size) {
    return Vec3{random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
  };
  Sim run;
  run.options.gravity = {0, 0, 0};
  for (std::uint32_t i = 0; i < 8; ++i) {
    const Vec3 place{0.3 * (i & 1 ? 1 : -1), 0.3 * (i & 2 ? 1 : -1), 0.3 * (i & 4 ? 1 : -1)};
    run.bodies.push_back(make_body(i, shape_of(static_cast<int>(i)), place + vector(0.05), place * -10.0 + vector(1)));
    Body& b = run.bodies.back();
    b.pose.orientation = from_rotation_vector(vector(2)), b.angular_velocity = vector(20);
    b.material.friction = friction, b.material.restitution = restitution;
  }
  return run;
}

TEST(Conservation, CollisionsKeepLinearAndAngularMomentumAndLoseEnergy) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Sim run = swarm(seed, seed % 3 == 0 ? 0 : 0.5, 0.2 * static_cast<Real>(seed % 5));
    Real linear = 0, angular = 0;  // sizes of what cancels
    for (const Body& b : run.bodies) {
      linear += norm(b.velocity) * b.mass.mass;
      angular += norm(b.pose.position) * norm(b.velocity) * b.mass.mass + norm(spin_momentum(b));
    }
    const Vec3 p = momentum(run), l = angular_momentum(run);
    const Real e = kinetic_energy(run);
    std::size_t hits = 0;
    for (int i = 0; i < 100; ++i) {
      run.step();  // which checks that the energy does not grow
      hits += run.contacts.size();
    }
    EXPECT_GT(hits, 8u);
    // Impulses are equal, opposite and at common points, so rounding alone is left: at most some 1e4 sums.
    EXPECT_LT(norm(momentum(run) - p), 1e-12 * linear) << seed;
    EXPECT_LT(norm(angular_momentum(run) - l), 1e-11 * angular) << seed;
    EXPECT_LT(kinetic_energy(run), e);
  }
}

// At rest with spin about an axis through the common centre: pushing the halves of a body apart may not spin them.
TEST(Conservation, PushingOutOfPenetrationKeepsAngularMomentum) {
  Sim run;
  run.options.gravity = {0, 0, 0};
  run.bodies = {make_body(1, make_box({0.1, 0.1, 0.1}, 0.02), {-0.0495, 0, 0}),
                make_body(2, make_box({0.1, 0.08, 0.08}, 0.02), {0.0495, 0.001, 0.002})};
  const Vec3 spin{0, 3, 1};
  for (Body& b : run.bodies) b.angular_velocity = spin, b.velocity = cross(spin, b.pose.position) + Vec3{1, 2, 3};
  const Vec3 p = momentum(run), l = angular_momentum(run);
  run.steps(50);
  EXPECT_GT(distance(run.bodies[0].pose.position, run.bodies[1].pose.position), 0.0995);
  EXPECT_LT(norm(momentum(run) - p), 1e-12 * norm(p));
  EXPECT_LT(norm(angular_momentum(run) - l), 1e-11 * norm(l));
}

}  // namespace
}  // namespace sherd
