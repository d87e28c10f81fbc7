#include "engine/contact/near_pairs.h"

#include <algorithm>

namespace sherd {
namespace {

Proxy make_proxy(const Body& body, const ContactCache::Bounds& bounds, Real time) {
  const Mat3 r = to_matrix(body.pose.orientation);
  const Vec3 centre = to_world(body, bounds.box.centre()), half = 0.5 * (bounds.box.high - bounds.box.low);
  Vec3 extent;
  for (int i = 0; i < 3; ++i)
    extent[i] = std::abs(r[i][0]) * half.x + std::abs(r[i][1]) * half.y + std::abs(r[i][2]) * half.z;
  Proxy p;
  p.box.low = centre - extent, p.box.high = centre + extent;
  p.diagonal = bounds.box.diagonal();
  if (body.fixed) return p;
  const Real spin = norm(body.angular_velocity) * bounds.radius;
  p.speed = norm(body.velocity) + spin;
  // No point gets farther by turning than across its circle.
  p.turn = std::min(spin * time, 2 * bounds.radius);
  p.reach = norm(body.velocity) * time + p.turn;
  return p;
}

Box grown(const Box& box, Real m) {
  return {box.low - Vec3{m, m, m}, box.high + Vec3{m, m, m}};
}

}  // namespace

std::vector<Proxy> make_proxies(std::span<const Body> bodies, const ContactCache& cache, Real time) {
  std::vector<Proxy> proxies;
  for (const Body& b : bodies) proxies.push_back(make_proxy(b, cache.bounds(b), time));
  return proxies;
}

// Not by the relative velocity alone: of fragments flying together one may be stopped in the step.
Real pair_margin(const Body& a, const Body& b, const Proxy& pa, const Proxy& pb, const SweepOptions& options) {
  const Vec3 va = a.fixed ? Vec3{} : a.velocity, vb = b.fixed ? Vec3{} : b.velocity;
  return std::max({norm(va - vb), norm(va), norm(vb)}) * options.time + pa.turn + pb.turn +
         options.margin * std::min(pa.diagonal, pb.diagonal);
}

std::vector<BodyPair> near_pairs(std::span<const Body> bodies, std::span<const Proxy> proxies,
                                 const SweepOptions& options) {
  // Along x over the boxes grown by each body's own share of the margin; then the exact margin of the pair.
  std::vector<std::uint32_t> order(bodies.size());
  std::vector<Box> swept(bodies.size());
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    order[i] = i;
    swept[i] = grown(proxies[i].box, proxies[i].reach + options.margin * proxies[i].diagonal);
  }
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return swept[a].low.x != swept[b].low.x ? swept[a].low.x < swept[b].low.x : a < b;
  });
  std::vector<BodyPair> pairs;
  for (std::size_t s = 0; s < order.size(); ++s)
    for (std::size_t t = s + 1; t < order.size() && swept[order[t]].low.x <= swept[order[s]].high.x; ++t) {
      const std::uint32_t a = std::min(order[s], order[t]), b = std::max(order[s], order[t]);
      if (!swept[a].overlaps(swept[b]) || (options.rests(bodies, a) && options.rests(bodies, b))) continue;
      if (grown(proxies[a].box, pair_margin(bodies[a], bodies[b], proxies[a], proxies[b], options))
              .overlaps(proxies[b].box))
        pairs.emplace_back(a, b);
    }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace sherd
