#include "engine/rigid/recover.h"

#include <algorithm>

#include "engine/rigid/energy.h"
#include "engine/rigid/free_motion.h"

namespace sherd {
namespace {

constexpr Real kTolerance = 1e-3;  // of the solve, relative to the fastest displacement

Vec3 angular_momentum(const Body& b) {
  return cross(b.pose.position, b.velocity * b.mass.mass) + spin_momentum(b);
}

// Turns a group of free bodies as one, without moving its centre of mass, until it has the angular momentum `wanted`.
void restore_angular_momentum(std::span<Body> bodies, const std::vector<std::uint32_t>& group, const Vec3& wanted) {
  Vec3 centre, now;
  Real mass = 0;
  for (const std::uint32_t i : group)
    centre += bodies[i].pose.position * bodies[i].mass.mass, mass += bodies[i].mass.mass;
  centre = centre / mass;
  Mat3 inertia;
  for (const std::uint32_t i : group) {
    const Body& b = bodies[i];
    const Vec3 d = b.pose.position - centre;
    inertia += world_inertia(b) + (Mat3::identity() * norm2(d) - outer(d, d)) * b.mass.mass;
    now += angular_momentum(b);
  }
  const Vec3 spin = inverse(inertia) * (wanted - now);
  for (const std::uint32_t i : group) {
    bodies[i].angular_velocity += spin;
    bodies[i].velocity += cross(spin, bodies[i].pose.position - centre);
  }
}

void displace(Body& b, const Motion& m, Real time) {
  const Vec3 kept = spin_momentum(b);
  b.pose.position += m.v * time;
  b.pose.orientation = normalized(from_rotation_vector(m.w * time) * b.pose.orientation);
  b.angular_velocity = spin_of(b, kept);
}

}  // namespace

Real recover(StepWorld& world, std::span<const Contact> contacts, std::span<const ContactRow> rows,
             std::span<const Real> gaps, Real time) {
  const RigidOptions& o = world.options;
  std::vector<ContactRow> pushes(rows.begin(), rows.end());
  Real fastest = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ContactRow& r = pushes[i];
    r.friction = 0, r.impulse[0] = r.impulse[1] = r.impulse[2] = 0;
    const Real excess = -gaps[i] - o.slop * world.pair_size(contacts[i]);
    r.target = excess > 0 ? std::min(o.recovery_speed, o.recovery * excess / o.dt) : -std::max(0.0, gaps[i]) / time;
    fastest = std::max(fastest, r.target);
  }
  if (fastest == 0) return 0;
  std::vector<Motion> motions = world.motions();
  for (Motion& m : motions) m.v = m.w = {};
  Real change = 0;
  for (const Island& island : islands(motions, pushes)) {
    IslandProblem problem = isolate(island, motions, pushes);
    if (std::none_of(problem.rows.begin(), problem.rows.end(), [](const ContactRow& r) { return r.target > 0; }))
      continue;
    solve_contacts(problem.motions, problem.rows, o.iterations, kTolerance * fastest);
    Vec3 before;
    for (const std::uint32_t i : island.motions) {
      change -= energy(world.bodies[i], o.gravity).total();
      before += angular_momentum(world.bodies[i]);
    }
    for (std::size_t k = 0; k < island.motions.size(); ++k)
      displace(world.bodies[island.motions[k]], problem.motions[k], time);
    if (!island.anchored) restore_angular_momentum(world.bodies, island.motions, before);
    for (const std::uint32_t i : island.motions) change += energy(world.bodies[i], o.gravity).total();
  }
  return change;
}

}  // namespace sherd
