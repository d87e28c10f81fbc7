#include "engine/rigid/step.h"

#include <algorithm>

#include "engine/rigid/part.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

constexpr Real kSamePlace = 0.01;  // contacts of two parts within this share of the body's size are one

// Adds a part's contacts to those of the parts before; drops those that were only gaps.
void collect(const StepWorld& world, const std::vector<Contact>& part, std::vector<Contact>& all) {
  const std::size_t earlier = all.size();
  for (const Contact& c : part) {
    if (c.depth < 0 && norm2(c.impulse) == 0) continue;
    const Real near = kSamePlace * world.pair_size(c);
    const auto last = all.begin() + static_cast<std::ptrdiff_t>(earlier);
    const auto same = std::find_if(all.begin(), last, [&](const Contact& o) {
      return o.a == c.a && o.b == c.b && distance2(o.at_a, c.at_a) < near * near;
    });
    if (same == last) {
      all.push_back(c);
      continue;
    }
    same->impulse += c.impulse;
    same->depth = std::max(same->depth, c.depth);
    same->approach_speed = std::max(same->approach_speed, c.approach_speed);
  }
}

void rest(StepWorld& world, const PartResult& last, RigidStats& stats) {
  const RigidOptions& o = world.options;
  std::vector<char> still(world.bodies.size(), 0);
  for (std::uint32_t i = 0; i < world.bodies.size(); ++i) {
    const Body& b = world.bodies[i];
    still[i] = world.moves(i) && norm2(o.gravity) > 0 &&
               norm(b.velocity) + norm(b.angular_velocity) * world.cache.bounds(b).radius < o.sleep_speed;
  }
  put_to_sleep(world.bodies, last.contacts, last.touches, still, o.dt, o.sleep_time, world.state);
  for (const auto& [id, b] : world.state.bodies) stats.asleep += b.asleep ? 1 : 0;
}

}  // namespace

void rigid_step(std::span<Body> bodies, const GroundPlane& ground, const RigidOptions& options, ContactCache& cache,
                RigidState& state, std::vector<Contact>& contacts, RigidStats& stats) {
  SHERD_CHECK(options.dt > 0 && std::isfinite(options.dt), "time step {} s", options.dt);
  SHERD_CHECK(options.max_parts > 0, "a step has {} parts", options.max_parts);
  stats = {};
  contacts.clear();
  cache.update(bodies);
  update_state(bodies, ground.enabled, state);
  StepWorld world{bodies, ground, options, cache, state};
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    const Body& b = bodies[i];
    world.index[b.id] = i;
    SHERD_CHECK(is_finite(b.pose.position) && is_finite(b.velocity) && is_finite(b.angular_velocity),
                "body '{}' has a pose or velocity that is not finite", b.name);
    SHERD_CHECK(b.fixed || (b.mass.mass > 0 && std::isfinite(b.mass.mass)), "body '{}' has mass {} kg", b.name,
                b.mass.mass);
  }
  PartResult part;
  for (Real left = options.dt; left > 0; left -= part.time) {
    // The floor rises as parts are used up, so that the last one reaches the end.
    part = step_part(world, left, left / (options.max_parts - stats.parts), stats);
    ++stats.parts;
    collect(world, part.contacts, contacts);
    if (left - part.time <= 1e-9 * options.dt) break;
  }
  rest(world, part, stats);
}

}  // namespace sherd
