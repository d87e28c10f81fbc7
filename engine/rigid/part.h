// A part of a time step (step.h): its contacts, the impact and the push, the motion.
#pragma once
#include <map>

#include "engine/rigid/islands.h"
#include "engine/rigid/step.h"

namespace sherd {

// What all parts of a step work on. The ground is the motion past the last body.
struct StepWorld {
  std::span<Body> bodies;
  const GroundPlane& ground;
  const RigidOptions& options;
  ContactCache& cache;
  RigidState& state;
  std::map<BodyId, std::uint32_t> index = {};

  bool moves(std::uint32_t i) const { return !bodies[i].fixed && !state.bodies.at(bodies[i].id).asleep; }
  Real pair_size(const Contact& c) const;  // box diagonal of the smaller body, m
  std::vector<std::uint8_t> resting() const;
  // Velocities as they are, one a body and the ground.
  std::vector<Motion> motions() const;
  // Impulses of rows between these motions onto the bodies, by momentum: velocities of the solve carry its rounding.
  void add_impulses(std::span<const ContactRow> rows);
};

struct PartResult {
  Real time = 0;                  // s, its length
  std::vector<Contact> contacts;  // all near ones; impulse and approach speed filled in
  std::vector<char> touches;      // the bodies touch, meet within the part, or push each other
};

// Moves the bodies by as much of `remaining` as they can go without a fast pair meeting, at least `floor`, unless that
// is more. Adds to stats.
PartResult step_part(StepWorld& world, Real remaining, Real floor, RigidStats& stats);

}  // namespace sherd
