// Motion between impulses: no force, no torque.
#pragma once
#include "engine/body/body.h"

namespace sherd {

// Moves the body for `t` seconds. Turning is the implicit midpoint rule for Euler's equations with its Cayley map: it
// keeps the angular momentum and the kinetic energy to rounding for any inertia, in turns of at most a quarter radian.
void move_freely(Body& body, Real t);

// I w in world axes, kg m^2/s; spin_of() is its inverse.
Vec3 spin_momentum(const Body& body);
Vec3 spin_of(const Body& body, const Vec3& spin_momentum);

}  // namespace sherd
