// Broad phase: which bodies may come near within a time, by sweep and prune over their world boxes.
#pragma once
#include <span>
#include <utility>
#include <vector>

#include "engine/contact/cache.h"

namespace sherd {

// Numbers of two bodies, the smaller first; the ground counts as the one past the last.
using BodyPair = std::pair<std::uint32_t, std::uint32_t>;

// A body's world box now and how far it may get.
struct Proxy {
  Box box;
  Real reach = 0;     // farthest any of its points moves within the time, m
  Real turn = 0;      // the part of it by rotation
  Real speed = 0;     // of its fastest point, at most, m/s
  Real diagonal = 0;  // of its material box, m
};

struct SweepOptions {
  Real time = 0;    // s
  Real margin = 0;  // gap at which bodies count as near anyway, relative to the smaller one's diagonal
  // Per body, or empty: nothing is asked about a pair of two resting bodies.
  std::span<const std::uint8_t> resting = {};

  bool rests(std::span<const Body> bodies, std::size_t i) const {
    return bodies[i].fixed || (!resting.empty() && resting[i] != 0);
  }
};

// The cache knows the bodies (ContactCache::update).
std::vector<Proxy> make_proxies(std::span<const Body> bodies, const ContactCache& cache, Real time);
// Gap that the pair may close within the time, m.
Real pair_margin(const Body& a, const Body& b, const Proxy& pa, const Proxy& pb, const SweepOptions& options);
// Pairs (i < j) of body indices whose boxes come within pair_margin(), ascending.
std::vector<BodyPair> near_pairs(std::span<const Body> bodies, std::span<const Proxy> proxies,
                                 const SweepOptions& options);

}  // namespace sherd
