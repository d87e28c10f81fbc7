#include "engine/contact/free_time.h"

#include <algorithm>

#include "engine/contact/near_pairs.h"
#include "kernels/core/parallel.h"

namespace sherd {
namespace {

constexpr Real kWallShare = 0.25, kSizeShare = 0.04;  // that a fast pair moves
constexpr Real kTouchingShare = 0.05;                 // of the size, that touching ones may move at least
constexpr int kMaxAdvances = 128;

struct Scales {
  Real wall, size;  // m
  Real coarse() const { return std::min(kWallShare * wall, kSizeShare * size); }
  // Turning further leaves the straight lines by which contacts are foreseen.
  Real touching() const { return std::clamp(wall, kTouchingShare * size, 2 * kTouchingShare * size); }
};

Scales scales(const ContactCache& cache, const Body& a, const Body* b) {
  const ContactCache::Bounds &own = cache.bounds(a), &other = cache.bounds(b ? *b : a);
  return {std::min(own.thickness, other.thickness), std::min(own.box.diagonal(), other.box.diagonal())};
}

Body flown(const Body& b, bool rests, const Vec3& gravity, Real t) {
  Body moved = b;
  if (rests) return moved;
  moved.pose.position += b.velocity * t + gravity * (0.5 * t * t);
  moved.pose.orientation = normalized(from_rotation_vector(b.angular_velocity * t) * b.pose.orientation);
  return moved;
}

// How long a pair may move, and how long it surely stays apart.
struct Passage {
  Real time, apart;
};

// `gap(t, limit)`: signed distance after t, or `limit` if it is that or more. `speed`: at which it closes at most.
template <class Gap>
Passage passage(const Gap& gap, Real speed, const Scales& scales, Real tolerance, Real time) {
  const Real least = scales.coarse() / speed;
  Real t = 0, apart = 0;  // apart: the last time with a gap
  for (int n = 0; n < kMaxAdvances && t < time; ++n) {
    const Real limit = speed * (time - t) + tolerance, g = gap(t, limit);
    if (g >= limit) return {time, time};
    if (g > 0) apart = t;
    if (g <= tolerance) return {n == 0 ? std::min(time, scales.touching() / speed) : std::max(apart, least), apart};
    // At least a share of the smallest motion that counts, so that a grazing pass ends.
    t += std::max((g - 0.5 * tolerance) / speed, 0.25 * least);
  }
  return {std::max(std::min(t, time), least), std::min(t, time)};
}

Real height_over(const Body& b, Real height, Real limit) {
  const Mat3 r = to_matrix(b.pose.orientation);
  const Vec3Column& v = b.mesh->vertices;
  const Vec3& c = b.mass.centre;
  Real low = std::numeric_limits<Real>::infinity();
  for (std::size_t i = 0; i < v.size(); ++i)
    low = std::min(low, r[1][0] * (v.x[i] - c.x) + r[1][1] * (v.y[i] - c.y) + r[1][2] * (v.z[i] - c.z));
  return std::min(limit, low + b.pose.position.y - height);
}

// A pair that moves far within the time; b is the one past the last body for the ground.
struct FastPair {
  std::uint32_t a, b;
  Real speed;  // at which it closes at most, m/s
  Scales scales;
};

std::vector<FastPair> fast_pairs(std::span<const Body> bodies, const GroundPlane& ground, const SweepOptions& sweep,
                                 const Vec3& gravity, const ContactCache& cache) {
  const std::vector<Proxy> proxies = make_proxies(bodies, cache, sweep.time);
  const Real fall = norm(gravity) * sweep.time;
  std::vector<FastPair> fast;
  const auto consider = [&](std::uint32_t a, std::uint32_t b, Real speed, const Scales& s) {
    if (speed * sweep.time > s.coarse()) fast.push_back({a, b, speed, s});
  };
  const auto velocity = [&](std::uint32_t i) { return sweep.rests(bodies, i) ? Vec3{} : bodies[i].velocity; };
  const auto spin = [&](std::uint32_t i) { return proxies[i].speed - norm(velocity(i)); };
  for (const auto& [a, b] : near_pairs(bodies, proxies, sweep)) {
    const bool alike = !sweep.rests(bodies, a) && !sweep.rests(bodies, b);  // they fall alike
    consider(a, b, norm(velocity(a) - velocity(b)) + spin(a) + spin(b) + (alike ? 0 : fall),
             scales(cache, bodies[a], &bodies[b]));
  }
  const auto plane = static_cast<std::uint32_t>(bodies.size());
  for (std::uint32_t i = 0; ground.enabled && i < plane; ++i) {
    const Proxy& p = proxies[i];
    const Real reach = p.reach + fall * sweep.time + sweep.margin * p.diagonal;
    if (sweep.rests(bodies, i) || p.box.low.y > ground.height + reach) continue;
    consider(i, plane, std::max(0.0, -bodies[i].velocity.y) + spin(i) + fall, scales(cache, bodies[i], nullptr));
  }
  return fast;
}

}  // namespace

Real coarse_motion(const ContactCache& cache, const Body& a, const Body* b) {
  return scales(cache, a, b).coarse();
}

FreeTime free_time(std::span<const Body> bodies, const GroundPlane& ground, const FreeTimeOptions& options,
                   ContactCache& cache) {
  const SweepOptions sweep{options.time, options.margin, options.resting};
  const std::vector<FastPair> fast = fast_pairs(bodies, ground, sweep, options.gravity, cache);
  const auto plane = static_cast<std::uint32_t>(bodies.size());
  std::vector<std::size_t> needed;
  for (const FastPair& f : fast)
    if (f.b != plane) needed.push_back(f.a), needed.push_back(f.b);
  cache.build(bodies, needed);
  std::vector<Passage> passages(fast.size());
  parallel_for(fast.size(), 1, [&](std::size_t n) {
    const auto& [a, b, speed, size] = fast[n];
    const auto at = [&](std::uint32_t i, Real t) {
      return flown(bodies[i], sweep.rests(bodies, i), options.gravity, t);
    };
    const auto gap = [&](Real t, Real limit) {
      const Body moved = at(a, t);
      if (b == plane) return height_over(moved, ground.height, limit);
      return gap_between(cache.shape(bodies[a]), cache.shape(bodies[b]), placement(moved, at(b, t)), limit);
    };
    passages[n] = passage(gap, speed, size, options.margin * size.size, options.time);
  });
  FreeTime free{options.time, {}};
  for (const Passage& p : passages) free.time = std::min(free.time, p.time);
  free.time = std::clamp(free.time, std::min(options.floor, options.time), options.time);
  for (std::size_t n = 0; n < fast.size(); ++n)
    if (passages[n].apart >= free.time) free.apart.emplace_back(fast[n].a, fast[n].b);
  std::sort(free.apart.begin(), free.apart.end());
  return free;
}

}  // namespace sherd
