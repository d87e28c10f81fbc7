#include "engine/step/inherit.h"

namespace sherd {

Momenta momenta(const Body& b) {
  const Vec3 p = b.velocity * b.mass.mass;
  return {b.mass.mass, p, cross(b.pose.position, p) + world_inertia(b) * b.angular_velocity};
}

void inherit_motion(const Body& parent, std::vector<Body>& fragments) {
  Real volume = 0;
  for (Body& f : fragments) {
    f.mass = mass_properties(*f.mesh, 1);
    volume += f.mass.volume;
  }
  const Real density = parent.mass.mass / volume;
  Vec3 centre;
  for (Body& f : fragments) {
    f.density = density;
    f.mass.mass = f.mass.volume * density, f.mass.inertia *= density;
    f.pose.orientation = parent.pose.orientation;
    f.pose.position = to_world(parent, f.mass.centre);
    centre += f.pose.position * (f.mass.mass / parent.mass.mass);
  }
  // One rigid motion about the common centre of mass with the parent's momenta.
  const Momenta before = momenta(parent);
  Mat3 inertia;
  for (const Body& f : fragments) {
    const Vec3 d = f.pose.position - centre;
    inertia += world_inertia(f) + (Mat3::identity() * norm2(d) - outer(d, d)) * f.mass.mass;
  }
  const Vec3 velocity = before.linear / parent.mass.mass;
  const Vec3 spin = inverse(inertia) * (before.angular - cross(centre, before.linear));
  for (Body& f : fragments) {
    f.angular_velocity = spin;
    f.velocity = velocity + cross(spin, f.pose.position - centre);
  }
}

}  // namespace sherd
