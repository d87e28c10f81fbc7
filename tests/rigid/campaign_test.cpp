#include "kernels/core/random.h"
#include "tests/rigid/fragments.h"

namespace sherd {
namespace {

SurfaceMesh random_shape(Random& random, Real size) {
  switch (random.next() % 5) {
    case 0:
      return make_box({size, size * random.uniform(0.3, 1), size * random.uniform(0.3, 1)}, 0.5 * size);
    case 1:
      return make_sphere(0.5 * size, 0.2 * size);
    case 2:
      return make_plate(size, size * random.uniform(0.4, 1), size * random.uniform(0.02, 0.1), 0.25 * size);
    case 3:
      return make_dinner_plate(0.6 * size, 0.03 * size, 0.15 * size);
    default: {
      const std::vector<SurfaceMesh> pieces = broken_box(1e-4);
      SurfaceMesh shard = pieces[random.next() % pieces.size()];
      for (std::size_t i = 0; i < shard.vertex_count(); ++i) shard.vertices.set(i, shard.vertices[i] * (size / 0.05));
      return shard;
    }
  }
}

// Four to eight bodies of any shape, material, speed and size over the ground, or far from it, thrown at one another.
Sim random_run(std::uint64_t seed) {
  Random random(seed);
  const auto vector = [&](Real s) { return Vec3{random.uniform(-s, s), random.uniform(-s, s), random.uniform(-s, s)}; };
  Sim run;
  const Real scale = std::pow(10.0, random.uniform(-3, 2)), speed = std::pow(10.0, random.uniform(-1, 2));
  run.options.dt = std::pow(10.0, random.uniform(-4, -2));
  run.ground.enabled = random.uniform() < 0.7;
  run.ground.restitution = random.uniform(), run.ground.friction = random.uniform(0, 1);
  if (random.uniform() < 0.2) run.options.gravity = {0, 0, 0};
  const auto count = static_cast<std::uint32_t>(4 + random.next() % 5);
  for (std::uint32_t i = 0; i < count; ++i) {
    Body b = make_body(i, random_shape(random, scale * random.uniform(0.3, 1)), {});
    b.density = std::pow(10.0, random.uniform(2, 4.5));
    b.mass = mass_properties(*b.mesh, b.density);
    b.material.restitution = random.uniform(), b.material.friction = random.uniform(0, 1.2);
    b.pose.position =
        Vec3{1.5 * scale * (i % 3), 1.2 * scale * (1 + i / 3), 0.3 * scale * (i % 2)} + vector(0.2 * scale);
    b.pose.orientation = from_rotation_vector(vector(3));
    b.velocity = vector(speed) - (b.pose.position - Vec3{1.5, 1.5, 0} * scale) * (0.5 * speed / scale);
    b.angular_velocity = vector(speed / scale);
    b.fixed = random.uniform() < 0.08;
    run.bodies.push_back(std::move(b));
  }
  return run;
}

// Sim::step() checks the balance of energy; none may end above it, and nothing may be lost or sink.
void expect_sound(std::uint64_t first, std::uint64_t last, int steps) {
  std::size_t unconverged = 0, problems = 0;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    Sim run = random_run(seed);
    for (int i = 0; i < steps; ++i) {
      run.step();
      unconverged += run.stats.unconverged, problems += static_cast<std::size_t>(run.stats.parts);
      if (::testing::Test::HasFailure()) FAIL() << "seed " << seed << " step " << i;
      for (const Body& b : run.bodies) {
        ASSERT_TRUE(is_finite(b.pose.position)) << seed;
        ASSERT_TRUE(!run.ground.enabled || b.fixed || b.pose.position.y > 0) << seed << " step " << i << ' ' << b.name;
      }
    }
  }
  EXPECT_LT(unconverged, problems / 50) << unconverged << " of " << problems;
}

TEST(Campaign, RandomBodiesNeverGainEnergyNorSinkNorGetLost) {
  expect_sound(1, 6, 40);
}
TEST(SlowCampaign, RandomBodiesNeverGainEnergyNorSinkNorGetLost) {
  expect_sound(7, 150, 120);
}

}  // namespace
}  // namespace sherd
