// Bodies and runs for the tests of the rigid stage.
#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "engine/mesh/shapes.h"
#include "engine/rigid/energy.h"
#include "engine/rigid/free_motion.h"

namespace sherd {

inline Body make_body(std::uint32_t id, SurfaceMesh mesh, const Vec3& position, const Vec3& velocity = {}) {
  Body b;
  b.id = b.parent = BodyId{id};
  b.name = fmt::format("body{}", id);
  b.mesh = std::make_shared<const SurfaceMesh>(std::move(mesh));
  b.density = 2000;
  b.mass = mass_properties(*b.mesh, b.density);
  b.pose.position = position;
  b.velocity = velocity;
  return b;
}

struct Sim {
  std::vector<Body> bodies;
  GroundPlane ground;
  RigidOptions options;
  ContactCache cache;
  RigidState state;
  std::vector<Contact> contacts;
  RigidStats stats;

  // Every step of every test keeps the balance of energy.
  void step() {
    const std::vector<Body> before = bodies;
    rigid_step(bodies, ground, options, cache, state, contacts, stats);
    const EnergyBalance balance = energy_balance(before, bodies, options, stats);
    EXPECT_TRUE(balance.holds()) << "grows by " << balance.growth() << " J, tolerance " << balance.tolerance;
  }
  void steps(int n) {
    for (int i = 0; i < n; ++i) step();
  }
};

inline Vec3 momentum(const Sim& run) {
  Vec3 p;
  for (const Body& b : run.bodies) p += b.velocity * b.mass.mass;
  return p;
}
// About the world's origin.
inline Vec3 angular_momentum(const Body& b) {
  return cross(b.pose.position, b.velocity * b.mass.mass) + spin_momentum(b);
}
inline Vec3 angular_momentum(const Sim& run) {
  Vec3 l;
  for (const Body& b : run.bodies) l += angular_momentum(b);
  return l;
}
inline Real kinetic_energy(const Sim& run) {
  return energy(run.bodies, {}).kinetic;
}

}  // namespace sherd
