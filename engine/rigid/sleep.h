// What the rigid stage remembers of each body between steps, and the sleep of islands at rest.
#pragma once
#include <map>
#include <span>
#include <vector>

#include "engine/body/body.h"
#include "engine/contact/contact.h"

namespace sherd {

// Cold, one entry a body, read and written once a step.
struct BodyRigidState {
  std::uint32_t mesh_version = 0;
  int age = 0;     // steps since first seen, stops counting at a few
  Real still = 0;  // s the body has been at rest, touching something
  bool asleep = false;
  Pose pose;                     // where it fell asleep
  std::vector<BodyId> partners;  // touched when it fell asleep, ascending
};

// Impulse of the last step at a contact, from which the next solve starts.
struct WarmContact {
  BodyId a, b;
  Vec3 place;    // material coordinates of a, m
  Vec3 impulse;  // on a, world, N s
};

// Copyable: a copy with the bodies' poses and velocities restarts a run exactly.
struct RigidState {
  std::map<BodyId, BodyRigidState> bodies;
  std::vector<WarmContact> warm;  // by (a, b)
  Real warm_dt = 0;               // s, step of those impulses
};

// Forgets bodies that are gone, adds new ones, and wakes sleepers that were moved or lost or changed what they rest on.
void update_state(std::span<const Body> bodies, bool ground, RigidState& state);
// Wakes the sleepers touched by awake bodies, with everything asleep they lean on; returns how many woke. `touches[i]`
// says whether contacts[i] counts (or is a mere gap).
std::size_t wake_touched(std::span<const Body> bodies, std::span<const Contact> contacts,
                         const std::vector<char>& touches, RigidState& state);
// After the step: counts the time at rest (still[i]: body i is slow) and puts islands to sleep whose every body has
// been still for `sleep_time` (s); their velocities become zero.
void put_to_sleep(std::span<Body> bodies, std::span<const Contact> contacts, const std::vector<char>& touches,
                  const std::vector<char>& still, Real dt, Real sleep_time, RigidState& state);

}  // namespace sherd
