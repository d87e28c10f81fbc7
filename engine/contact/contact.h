// Contacts between bodies, found by the contact stage, solved by the rigid stage, read by the load stage.
#pragma once
#include "engine/body/body.h"

namespace sherd {

// One point contact. `a` is always a body with a mesh; `b` is another body or kGround.
struct Contact {
  BodyId a, b;
  Vec3 point;      // world, m
  Vec3 normal;     // unit, world, from b towards a
  Real depth = 0;  // penetration, m; negative while still apart
  // Filled by the rigid stage:
  Real approach_speed = 0;  // normal closing speed before the solve, m/s, >= 0
  Vec3 impulse;             // on a (b gets the opposite), N s, world, normal and friction part together
  // The point in the coordinates of a's mesh and of b's (not of the ground) when it was found: bodies move on until the
  // step ends, farther than walls are thick.
  Vec3 at_a, at_b;
};

}  // namespace sherd
