// One time step of rigid bodies: gravity, contacts, impulses, motion.
//
// The step is cut where fast bodies meet (free_time), so nothing tunnels. In each part, of length h, the velocities see
// two contact problems. *Impact*, at the poses of its start: where a pair touches, or first meets within h, it bounces
// with Newton's restitution; the part ends before the points it would meet later, if the bounce lets it. *Push*, at the
// poses of its middle: gravity, and what keeps bodies apart, so that no gap at the end is negative. Between, bodies fly
// freely. Every impulse acts on both bodies at one common point of one time, hence linear and angular momentum are kept
// to rounding; the work of an impulse is its product with the mean of the velocities before and after, which is never
// positive for either problem, and free motion keeps the energy to rounding, hence energy never grows
// (engine/rigid/energy.h). What penetrates all the same is pushed out by displacement alone.
#pragma once
#include <span>
#include <vector>

#include "engine/contact/detect.h"
#include "engine/rigid/sleep.h"

namespace sherd {

struct RigidOptions {
  Real dt = 1e-3;                 // s
  Vec3 gravity{0, -9.81, 0};      // m/s^2
  int iterations = 150;           // most sweeps of each contact problem, before Newton's method
  Real restitution_speed = 0.1;   // m/s; slower approaches do not bounce
  Real recovery = 0.2;            // share of the penetration beyond the slop removed a step
  Real recovery_speed = 0.2;      // m/s, the most
  Real slop = 1e-4;               // penetration left alone, relative to the smaller body's box diagonal
  Real margin = 1e-3;             // as in DetectOptions
  std::size_t max_contacts = 12;  // a pair, as in DetectOptions
  int max_parts = 64;             // of a step
  Real sleep_speed = 0.01;        // m/s of the fastest point of a body at rest; 0 switches sleep off
  Real sleep_time = 0.5;          // s at rest before an island sleeps
};

struct RigidStats {
  ContactStats contact;         // of the last part
  int parts = 0;                // the step was cut into
  int iterations = 0;           // the most of a contact problem
  Real residual = 0;            // the largest of a contact problem, over its tolerance
  std::size_t unconverged = 0;  // contact problems (of an island and a part) that ended above their tolerance
  Real recovery_work = 0;       // J, by which pushing out of penetration changed the energy
  Real deepest = 0;             // m, penetration found
  std::size_t asleep = 0;       // bodies after the step
  std::size_t woken = 0;        // by touch in this step
};

// Restitution of a pair is the larger, friction the geometric mean of its materials' (the ground's from the plane).
// Fragments of one parent do not bounce off each other in their first steps: they start in contact. Fixed bodies have
// infinite mass. `contacts` receives every contact that overlaps or carried an impulse, with the speed of approach in
// the part of the step where it was first met and the impulse of the whole step; sleeping islands report none. Bodies
// asleep keep zero velocity; setting one wakes it. Throws InternalError for bodies without a mesh, with equal ids, or
// with values that are not finite.
void rigid_step(std::span<Body> bodies, const GroundPlane& ground, const RigidOptions& options, ContactCache& cache,
                RigidState& state, std::vector<Contact>& contacts, RigidStats& stats);

}  // namespace sherd
