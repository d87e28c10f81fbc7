// What fragments inherit: density, velocities, poses.
#pragma once
#include <vector>

#include "engine/body/body.h"

namespace sherd {

// Sets density, mass properties, pose and velocities of `fragments` (mesh set, material space of the parent) so that
// mass, linear and angular momentum equal the parent's: the volume the cracks remove is made up by density, and all
// fragments move with the one rigid motion that has the parent's momenta. Exact to rounding.
void inherit_motion(const Body& parent, std::vector<Body>& fragments);

struct Momenta {
  Real mass = 0;
  Vec3 linear, angular;  // kg m/s; about the world origin, kg m^2/s
  Momenta& operator+=(const Momenta& b) {
    mass += b.mass, linear += b.linear, angular += b.angular;
    return *this;
  }
};
Momenta momenta(const Body& body);

}  // namespace sherd
