// Velocity-level contact problem (mixed complementarity with Coulomb's cone) by projected Gauss-Seidel sweeps that a
// nonlinear conjugate gradient method accelerates (Silcowitz, Niebe and Erleben 2010): sweeps alone take as many as the
// ratio of masses to stand a heavy body on a light one.
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
  Real target = 0;  // least normal velocity, m/s
  Real impulse[3] =
      {};  // along the axes, N s: start value and result; impulse[0] >= 0, tangents within friction * impulse[0]

  Vec3 total() const { return axis[0] * impulse[0] + axis[1] * impulse[1] + axis[2] * impulse[2]; }
};

// Residual: the largest violation of a contact's conditions, in m/s. With k the velocity a unit of impulse gives the
// contact: |p - max(0, p - (v - target) / k)| k along the normal, |q - disc(q - v / k)| k along the tangents, disc the
// projection to friction * p. Zero exactly at a solution.
struct SolveReport {
  int iterations = 0;           // the most of an island; one is a sweep forwards and one back
  Real residual = 0;            // the largest, over the tolerance
  std::size_t unconverged = 0;  // islands whose residual stayed above the tolerance

  SolveReport& operator+=(const SolveReport& b) {
    iterations = iterations > b.iterations ? iterations : b.iterations;
    residual = residual > b.residual ? residual : b.residual;
    unconverged += b.unconverged;
    return *this;
  }
};

// Beyond these many motions Newton's method, whose cost grows faster, is for what sweeps leave far from done.
constexpr std::size_t kFewMotions = 16;

// Finds impulses so that each normal velocity is >= its target with impulse only where equal, tangential velocity is
// opposed by friction. Adds the start impulses to the motions first (warm start). Stops when the residual is at most
// `tolerance` (m/s) or after `iterations`. Serial, in row order.
SolveReport solve_contacts(std::span<Motion> motions, std::span<ContactRow> rows, int iterations, Real tolerance);

inline Vec3 relative_velocity(const Motion& a, const Motion& b, const ContactRow& r) {
  return a.v + cross(a.w, r.arm_a) - b.v - cross(b.w, r.arm_b);
}
inline Real normal_velocity(std::span<const Motion> motions, const ContactRow& r) {
  return dot(r.axis[0], relative_velocity(motions[r.a], motions[r.b], r));
}

}  // namespace sherd
