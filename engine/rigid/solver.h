// Velocity-level contact problem (mixed complementarity with Coulomb's cone) by projected Gauss-Seidel.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/core/vec3.h"

namespace sherd {

struct Motion {
  Vec3 v, w;              // m/s of the centre of mass, rad/s, world
  Real inverse_mass = 0;  // 0 with a zero tensor: does not move
  Mat3 inverse_inertia;   // world
};

// One contact point between motions a and b. Velocities and impulses are of a relative to b; the normal points from b
// to a.
struct ContactRow {
  std::uint32_t a = 0, b = 0;
  Vec3 arm_a, arm_b;  // from the centres of mass to the point, m
  Vec3 axis[3];       // normal and two tangents, orthonormal
  Real friction = 0;
  Real impulse[3] =
      {};  // along the axes, N s: start value and result; impulse[0] >= 0, tangents within friction * impulse[0]
};

struct SolveReport {
  int iterations = 0;
  Real change = 0;  // largest change of a contact velocity in the last sweep, m/s
};

// Finds impulses so that each normal velocity is >= target[i] with impulse only where equal, tangential velocity is
// opposed by friction. Adds the start impulses to the motions first (warm start). Stops after `iterations` sweeps or
// when no contact velocity changes by more than `tolerance` (m/s). Serial, in row order, forwards and backwards in
// turn.
SolveReport solve_contacts(std::span<Motion> motions, std::span<ContactRow> rows, std::span<const Real> target,
                           int iterations, Real tolerance);

inline Vec3 relative_velocity(const Motion& a, const Motion& b, const ContactRow& r) {
  return a.v + cross(a.w, r.arm_a) - b.v - cross(b.w, r.arm_b);
}

}  // namespace sherd
