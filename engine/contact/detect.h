// Contact detection: sweep and prune over world boxes, then the point shell of each body of a pair against the signed
// distance of the other (both ways), their sharp edges against each other, and vertices against the ground plane (the
// paper's section 7: distance field versus point shell). Contacts still apart are reported when the bodies may meet
// within the step, so that thin shards do not tunnel.
#pragma once
#include <span>
#include <vector>

#include "engine/contact/contact.h"
#include "engine/contact/near_pairs.h"

namespace sherd {

// The half-space y <= height.
struct GroundPlane {
  bool enabled = false;
  Real height = 0;  // m
  Real restitution = 0.2;
  Real friction = 0.5;
};

struct DetectOptions {
  Real dt = 1e-3;  // s; bodies are swept by their speed times dt
  Real margin =
      1e-3;  // gap at which resting contacts are already reported, relative to the smaller body's box diagonal
  std::size_t max_contacts = 12;  // kept of a pair
  // Per body, or empty: a pair of two resting bodies is skipped, and a resting body against the ground.
  std::span<const std::uint8_t> resting = {};
  std::span<const BodyPair> apart = {};  // ascending; pairs that are known not to meet, and are not asked
};

// Counts are of the last call, except fields_built (of the cache, in all).
struct ContactStats {
  std::size_t pairs_near = 0;      // swept boxes overlap
  std::size_t pairs_touching = 0;  // with contacts
  std::size_t candidates = 0;      // points within the margin before reduction
  std::size_t contacts = 0;        // after
  std::size_t fields_built = 0;
  std::size_t fields_skipped = 0;  // bodies that need no field (so far): nothing came near
};

// `contacts` is replaced; sorted by (index of a, index of b) in `bodies`, the ground after the bodies; a comes before b
// in `bodies`. Fixed bodies are not tested against each other or the ground. Updates the cache.
void detect_contacts(std::span<const Body> bodies, const GroundPlane& ground, const DetectOptions& options,
                     ContactCache& cache, std::vector<Contact>& contacts, ContactStats& stats);

// Keeps at most `limit` contacts of one pair: the deepest, then again and again the one farthest from those kept, in
// position and (times the patch size) in normal, far gaps counting less. Deterministic; keeps the input order.
void reduce_contacts(std::vector<Contact>& contacts, std::size_t limit);

}  // namespace sherd
