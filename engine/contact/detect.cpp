#include "engine/contact/detect.h"

#include <algorithm>

#include "kernels/core/error.h"
#include "kernels/core/parallel.h"

namespace sherd {
namespace {

// A sample whose own normal points the way it would be pushed lies on the far side of its body: not a contact.
constexpr Real kFarSide = 0.3;

struct Proxy {
  Box box;         // world, unswept
  Real reach = 0;  // farthest any point moves in the step, m
  Real turn = 0;   // the part of it by rotation
  Real diagonal = 0;
};

Proxy make_proxy(const Body& body, const ContactCache::Bounds& bounds, Real dt) {
  const Mat3 r = to_matrix(body.pose.orientation);
  const Vec3 centre = to_world(body, bounds.box.centre()), half = 0.5 * (bounds.box.high - bounds.box.low);
  Vec3 extent;
  for (int i = 0; i < 3; ++i)
    extent[i] = std::abs(r[i][0]) * half.x + std::abs(r[i][1]) * half.y + std::abs(r[i][2]) * half.z;
  Proxy p;
  p.box.low = centre - extent, p.box.high = centre + extent;
  p.diagonal = bounds.box.diagonal();
  if (body.fixed) return p;
  p.turn = norm(body.angular_velocity) * bounds.radius * dt;
  p.reach = norm(body.velocity) * dt + p.turn;
  return p;
}

// Gap that the step may close. Not by the relative velocity alone: of fragments flying together one may be stopped in
// the step.
Real pair_margin(const Body& a, const Body& b, const Proxy& pa, const Proxy& pb, const DetectOptions& options) {
  const Vec3 va = a.fixed ? Vec3{} : a.velocity, vb = b.fixed ? Vec3{} : b.velocity;
  return std::max({norm(va - vb), norm(va), norm(vb)}) * options.dt + pa.turn + pb.turn +
         options.margin * std::min(pa.diagonal, pb.diagonal);
}

using Pair = std::pair<std::uint32_t, std::uint32_t>;

// Sweep along x over the boxes grown by each body's own share of the margin; then the exact margin of the pair.
std::vector<Pair> near_pairs(std::span<const Body> bodies, const std::vector<Proxy>& proxies,
                             const DetectOptions& options) {
  std::vector<std::uint32_t> order(bodies.size());
  std::vector<Box> grown(bodies.size());
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    const Real m = proxies[i].reach + options.margin * proxies[i].diagonal;
    order[i] = i;
    grown[i].low = proxies[i].box.low - Vec3{m, m, m}, grown[i].high = proxies[i].box.high + Vec3{m, m, m};
  }
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return grown[a].low.x != grown[b].low.x ? grown[a].low.x < grown[b].low.x : a < b;
  });
  std::vector<Pair> pairs;
  for (std::size_t s = 0; s < order.size(); ++s)
    for (std::size_t t = s + 1; t < order.size() && grown[order[t]].low.x <= grown[order[s]].high.x; ++t) {
      const std::uint32_t a = std::min(order[s], order[t]), b = std::max(order[s], order[t]);
      if (bodies[a].fixed && bodies[b].fixed) continue;
      const auto rests = [&](std::uint32_t i) {
        return bodies[i].fixed || (!options.resting.empty() && options.resting[i] != 0);
      };
      if (!options.resting.empty() && rests(a) && rests(b)) continue;
      if (!grown[a].overlaps(grown[b])) continue;
      const Real m = pair_margin(bodies[a], bodies[b], proxies[a], proxies[b], options);
      Box box = proxies[a].box;
      box.low -= Vec3{m, m, m}, box.high += Vec3{m, m, m};
      if (box.overlaps(proxies[b].box)) pairs.emplace_back(a, b);
    }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

struct Placement {  // maps the shell's material space to the field's: y = rotation x + shift
  Mat3 rotation;
  Vec3 shift;
};

Placement between(const Body& from, const Body& to) {
  const Mat3 a = to_matrix(from.pose.orientation), bt = transpose(to_matrix(to.pose.orientation));
  Placement p;
  p.rotation = bt * a;
  p.shift = bt * (from.pose.position - a * from.mass.centre - to.pose.position) + to.mass.centre;
  return p;
}

// Exact distances cost a microsecond each, and touching crack faces have hundreds of samples: where there are many,
// each chunk sends the few that stand for its neighbourhood.
constexpr std::size_t kFew = 64, kOfAChunk = 4, kOfAShell = 32;

// Numbers of the samples the field does not reject, thinned.
std::vector<std::uint32_t> rough_samples(const PointShell& shell, const SignedDistanceField& field,
                                         const Placement& place, Real reject) {
  std::vector<Contact> rough, chunk_rough;
  std::vector<std::size_t> ends;
  for (const PointShell::Chunk& chunk : shell.chunks) {
    if (field.value(place.rotation * chunk.centre + place.shift) > reject + chunk.radius) continue;
    for (std::uint32_t i = chunk.first; i < chunk.first + chunk.count; ++i) {
      const Real value = field.value(place.rotation * shell.points[i] + place.shift);
      if (value > reject) continue;
      Contact c;
      c.a = BodyId{i};
      c.point = shell.points[i], c.normal = shell.normals[i], c.depth = -value;
      rough.push_back(c);
    }
    ends.push_back(rough.size());
  }
  if (rough.size() > kFew) {
    std::vector<Contact> thinned;
    for (std::size_t e = 0, first = 0; e < ends.size(); first = ends[e++]) {
      chunk_rough.assign(rough.begin() + static_cast<std::ptrdiff_t>(first),
                         rough.begin() + static_cast<std::ptrdiff_t>(ends[e]));
      reduce_contacts(chunk_rough, kOfAChunk);
      thinned.insert(thinned.end(), chunk_rough.begin(), chunk_rough.end());
    }
    reduce_contacts(thinned, kOfAShell);
    rough.swap(thinned);
  }
  std::vector<std::uint32_t> samples;
  for (const Contact& c : rough) samples.push_back(c.a.value);
  return samples;
}

// Shell of `owner` against the distance of `other`; contacts are named (a, b) as the pair, normals point from b to a.
void shell_against_field(const Body& owner, const CollisionShape& shell_shape, const Body& other,
                         const CollisionShape& field_shape, Real margin, bool owner_is_a, std::vector<Contact>& found) {
  const Placement place = between(owner, other);
  const PointShell& shell = shell_shape.shell();
  const SignedDistanceField& field = field_shape.field();
  // Between nodes the field overestimates by little, except at the other's tips, and those are in the other's shell.
  for (const std::uint32_t i : rough_samples(shell, field, place, margin + 0.5 * field.spacing())) {
    const Vec3 p = place.rotation * shell.points[i] + place.shift;
    const CollisionShape::Nearest near = field_shape.nearest(p, std::max(margin, 2 * field.spacing() - field.value(p)));
    if (!near.found || near.distance > margin) continue;
    if (dot(place.rotation * shell.normals[i], near.normal) > kFarSide) continue;
    const Vec3 n = rotate(other.pose.orientation, near.normal);
    Contact c;
    c.a = owner_is_a ? owner.id : other.id, c.b = owner_is_a ? other.id : owner.id;
    c.point = to_world(other, 0.5 * (p + near.point));
    c.normal = owner_is_a ? n : -n;
    c.depth = -near.distance;
    found.push_back(c);
  }
}

void ground_contacts(const Body& body, Real height, Real margin, std::vector<Contact>& found) {
  const Mat3 r = to_matrix(body.pose.orientation);
  const Vec3 shift = body.pose.position - r * body.mass.centre;
  const Vec3Column& v = body.mesh->vertices;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const Real y = r[1][0] * v.x[i] + r[1][1] * v.y[i] + r[1][2] * v.z[i] + shift.y;
    if (y > height + margin) continue;
    Contact c;
    c.a = body.id, c.b = kGround;
    c.point = r * v[i] + shift;
    c.point.y = 0.5 * (y + height);
    c.normal = {0, 1, 0};
    c.depth = height - y;
    found.push_back(c);
  }
}

void check_bodies(std::span<const Body> bodies) {
  for (const Body& b : bodies)
    SHERD_CHECK(
        is_finite(b.pose.position) && is_finite(b.velocity) && is_finite(b.angular_velocity) &&
            std::isfinite(b.pose.orientation.w + b.pose.orientation.x + b.pose.orientation.y + b.pose.orientation.z),
        "body '{}' has a pose or velocity that is not finite", b.name);
}

}  // namespace

void detect_contacts(std::span<const Body> bodies, const GroundPlane& ground, const DetectOptions& options,
                     ContactCache& cache, std::vector<Contact>& contacts, ContactStats& stats) {
  SHERD_CHECK(options.resting.empty() || options.resting.size() == bodies.size(), "one resting flag a body");
  check_bodies(bodies);
  cache.update(bodies);
  std::vector<Proxy> proxies(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i)
    proxies[i] = make_proxy(bodies[i], cache.bounds(bodies[i]), options.dt);
  std::vector<Pair> pairs = near_pairs(bodies, proxies, options);
  std::vector<std::size_t> needed;
  for (const auto& [a, b] : pairs) needed.push_back(a), needed.push_back(b);
  cache.build(bodies, needed);
  stats = {};
  stats.pairs_near = pairs.size();

  // The ground is a partner with the index past the last body.
  const auto plane = static_cast<std::uint32_t>(bodies.size());
  if (ground.enabled)
    for (std::uint32_t i = 0; i < plane; ++i) {
      const Proxy& p = proxies[i];
      const bool rests = bodies[i].fixed || (!options.resting.empty() && options.resting[i] != 0);
      if (!rests && p.box.low.y <= ground.height + p.reach + options.margin * p.diagonal) pairs.emplace_back(i, plane);
    }
  std::sort(pairs.begin(), pairs.end());
  std::vector<std::vector<Contact>> found(pairs.size());
  std::vector<std::size_t> candidates(pairs.size());
  parallel_for(pairs.size(), 1, [&](std::size_t n) {
    const auto [i, j] = pairs[n];
    const Body& a = bodies[i];
    if (j == plane) {
      ground_contacts(a, ground.height, proxies[i].reach + options.margin * proxies[i].diagonal, found[n]);
    } else {
      const Body& b = bodies[j];
      const Real margin = pair_margin(a, b, proxies[i], proxies[j], options);
      const CollisionShape &sa = cache.shape(a), &sb = cache.shape(b);
      shell_against_field(a, sa, b, sb, margin, true, found[n]);
      shell_against_field(b, sb, a, sa, margin, false, found[n]);
    }
    candidates[n] = found[n].size();
    reduce_contacts(found[n], options.max_contacts);
  });
  contacts.clear();
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    contacts.insert(contacts.end(), found[n].begin(), found[n].end());
    stats.candidates += candidates[n];
    if (!found[n].empty()) ++stats.pairs_touching;
  }
  stats.contacts = contacts.size();
  stats.fields_built = cache.builds();
  stats.fields_skipped = bodies.size() - cache.shapes();
}

}  // namespace sherd
