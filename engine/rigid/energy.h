// The balance of mechanical energy over a step: it never grows.
#pragma once
#include <span>

#include "engine/rigid/step.h"

namespace sherd {

struct Energy {
  Real kinetic = 0, potential = 0;  // J; potential of `gravity`, zero at the world's origin
  Real total() const { return kinetic + potential; }
};
Energy energy(const Body& body, const Vec3& gravity);
Energy energy(std::span<const Body> bodies, const Vec3& gravity);  // of those that are not fixed

struct EnergyBalance {
  Energy before, after;
  Real recovered = 0;  // J, that pushing out of penetration added (RigidStats)
  Real tolerance = 0;  // J
  // What the step added beyond recovery, J; restitution and friction make it negative.
  Real growth() const { return after.total() - before.total() - recovered; }
  bool holds() const { return growth() <= tolerance; }
};

// Of one rigid_step() from `before` to `after`, the same bodies in the same order. Work of impulses is bounded whatever
// the residual of the contact solves, so the tolerance is for rounding: 1e-9 of m v^2 (thousands of sums, of impulses
// that cancel between masses of 1 to 1e4), and of the potential.
EnergyBalance energy_balance(std::span<const Body> before, std::span<const Body> after, const RigidOptions& options,
                             const RigidStats& stats);

}  // namespace sherd
