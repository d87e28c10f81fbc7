// Bodies and runs for the tests of the rigid stage.
#pragma once
#include <fmt/format.h>

#include <memory>
#include <vector>

#include "engine/mesh/shapes.h"
#include "engine/rigid/step.h"

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

  void step() { rigid_step(bodies, ground, options, cache, state, contacts, stats); }
  void steps(int n) {
    for (int i = 0; i < n; ++i) step();
  }
};

inline Vec3 momentum(const Sim& run) {
  Vec3 p;
  for (const Body& b : run.bodies) p += b.velocity * b.mass.mass;
  return p;
}
inline Vec3 angular_momentum(const Body& b) {
  return world_inertia(b) * b.angular_velocity;
}
inline Real kinetic_energy(const Body& b) {
  return 0.5 * b.mass.mass * norm2(b.velocity) + 0.5 * dot(b.angular_velocity, angular_momentum(b));
}
inline Real kinetic_energy(const Sim& run) {
  Real e = 0;
  for (const Body& b : run.bodies) e += kinetic_energy(b);
  return e;
}

}  // namespace sherd
