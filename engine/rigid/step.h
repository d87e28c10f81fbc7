// One time step of rigid bodies: gravity, contacts, impulses, motion (semi-implicit Euler).
//
// Two contact problems are solved from the same velocities. The *impact* problem gives the velocities after the step
// and the impulses: no approach where bodies touch or would meet within the step, Newton restitution above a threshold
// speed. The *advance* problem gives only the displacement of the step: gaps close but not further, and penetration is
// pushed out at a bounded speed. So recovery never becomes kinetic energy (split impulses), an impact delivers its
// whole impulse in one step, and thin shards do not tunnel.
#pragma once
#include <span>
#include <vector>

#include "engine/contact/detect.h"
#include "engine/rigid/sleep.h"

namespace sherd {

struct RigidOptions {
  Real dt = 1e-3;                 // s
  Vec3 gravity{0, -9.81, 0};      // m/s^2
  int iterations = 60;            // most sweeps of each contact problem
  Real restitution_speed = 0.1;   // m/s; slower approaches do not bounce
  Real recovery = 0.2;            // share of the penetration beyond the slop removed a step
  Real recovery_speed = 0.2;      // m/s, the most
  Real slop = 1e-4;               // penetration left alone, relative to the smaller body's box diagonal
  Real margin = 1e-3;             // as in DetectOptions
  std::size_t max_contacts = 12;  // a pair, as in DetectOptions
  Real sleep_speed = 0.01;        // m/s of the fastest point of a body at rest; 0 switches sleep off
  Real sleep_time = 0.5;          // s at rest before an island sleeps
};

struct RigidStats {
  ContactStats contact;
  int iterations = 0;      // of the impact problem
  Real change = 0;         // m/s, largest change of a contact velocity in its last sweep
  Real deepest = 0;        // m, penetration found
  std::size_t asleep = 0;  // bodies after the step
  std::size_t woken = 0;   // by touch in this step
};

// Restitution of a pair is the larger, friction the geometric mean of its materials' (the ground's from the plane).
// Fragments of one parent do not bounce off each other in their first steps: they start in contact. Fixed bodies have
// infinite mass. `contacts` receives every contact that overlaps or carried an impulse, with approach_speed (gravity of
// the step included) and the impulse of the whole step; sleeping islands report none. Bodies asleep keep zero velocity;
// setting one wakes it. Throws InternalError for bodies without a mesh, with equal ids, or with values that are not
// finite.
void rigid_step(std::span<Body> bodies, const GroundPlane& ground, const RigidOptions& options, ContactCache& cache,
                RigidState& state, std::vector<Contact>& contacts, RigidStats& stats);

}  // namespace sherd
