// Continuous collision detection: how long bodies move freely before two of them meet.
#pragma once
#include <span>

#include "engine/contact/detect.h"

namespace sherd {

// m, a motion of a pair that counts for nothing: a quarter of the thinner wall or 4 % of the smaller body, what is
// less. `b` null stands for the ground. The cache knows the bodies.
Real coarse_motion(const ContactCache& cache, const Body& a, const Body* b);

struct FreeTimeOptions {
  Real time = 0;    // s, the most
  Real floor = 0;   // s, the least returned
  Real margin = 0;  // gap at which bodies count as touching, relative to the smaller one's diagonal
  Vec3 gravity;     // m/s^2
  std::span<const std::uint8_t> resting = {};  // as in DetectOptions
};

struct FreeTime {
  Real time = 0;                // s, from floor to FreeTimeOptions::time
  std::vector<BodyPair> apart;  // fast pairs that surely do not meet within it, ascending
};

// The time until the first pair that moves fast comes within the margin, by conservative advancement of each pair
// (Mirtich and Canny 1995): the gap over the bound on the speed at which it can close is free. A pair is fast when it
// moves more than coarse_motion() within options.time; slower ones cannot tunnel. Nothing asks for steps in which it
// moves less than that. Pairs that touch already may move by a wall, within 5 and 10 % of the size. Builds the shapes
// of fast pairs; the cache knows the bodies.
FreeTime free_time(std::span<const Body> bodies, const GroundPlane& ground, const FreeTimeOptions& options,
                   ContactCache& cache);

}  // namespace sherd
