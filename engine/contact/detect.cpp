#include "engine/contact/detect.h"

#include <algorithm>

#include "kernels/core/error.h"
#include "kernels/core/parallel.h"

namespace sherd {
namespace {

// A sample whose own normal points the way it would be pushed lies on the far side of its body: not a contact.
constexpr Real kFarSide = 0.3;

// Exact distances cost a microsecond each, and touching crack faces have hundreds of samples: where there are many,
// each chunk sends the few that stand for its neighbourhood.
constexpr std::size_t kFew = 64, kOfAChunk = 4, kOfAShell = 32;

// Numbers of the samples the field does not reject, thinned.
std::vector<std::uint32_t> rough_samples(const PointShell& shell, const SignedDistanceField& field,
                                         const Placement& place, Real reject) {
  std::vector<Contact> rough, chunk_rough;
  std::vector<std::size_t> ends;
  for (const PointShell::Chunk& chunk : shell.chunks) {
    if (field.beyond(place(chunk.centre), reject + chunk.radius)) continue;
    for (std::uint32_t i = chunk.first; i < chunk.first + chunk.count; ++i) {
      const Real value = field.value(place(shell.points[i]));
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
  const Placement place = placement(owner, other);
  const PointShell& shell = shell_shape.shell();
  const SignedDistanceField& field = field_shape.field();
  // Between nodes the field overestimates by little, except at the other's tips, and those are in the other's shell.
  for (const std::uint32_t i : rough_samples(shell, field, place, margin + 0.5 * field.spacing())) {
    const Vec3 p = place(shell.points[i]);
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

// Edges that cross without a sample nearby; deeper than a quarter of the thinner wall they belong to its far side.
void edges_against_edges(const Body& a, const ContactCache& cache, const Body& b, Real margin,
                         std::vector<Contact>& found) {
  const CollisionShape &sa = cache.shape(a), &sb = cache.shape(b);
  const Real depth = 0.25 * std::min(cache.bounds(a).thickness, cache.bounds(b).thickness);
  std::vector<EdgeCrossing> crossings;
  edge_crossings(sa.edges(), sb.edges(), placement(a, b), sa.field(), sb.field(), margin, depth, crossings);
  for (const EdgeCrossing& e : crossings) {
    Contact c;
    c.a = a.id, c.b = b.id;
    c.point = to_world(b, e.point);
    c.normal = rotate(b.pose.orientation, e.normal);
    c.depth = -e.distance;
    found.push_back(c);
  }
}

// Whether the material boxes, `a`'s placed into the coordinates of `b` and the other way round, come within the margin:
// world boxes of turned plates overlap long before the plates do.
bool boxes_near(const Box& a, const Box& b, const Placement& place, Real margin) {
  const auto misses = [&](const Box& own, const Box& other, const Placement& p) {
    const Vec3 centre = p(own.centre()), half = 0.5 * (own.high - own.low);
    for (int i = 0; i < 3; ++i) {
      const Real extent = std::abs(p.rotation[i][0]) * half.x + std::abs(p.rotation[i][1]) * half.y +
                          std::abs(p.rotation[i][2]) * half.z + margin;
      if (centre[i] - extent > other.high[i] || centre[i] + extent < other.low[i]) return true;
    }
    return false;
  };
  return !misses(a, b, place) && !misses(b, a, inverse(place));
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
  const SweepOptions sweep{options.dt, options.margin, options.resting};
  const std::vector<Proxy> proxies = make_proxies(bodies, cache, options.dt);
  std::vector<BodyPair> pairs = near_pairs(bodies, proxies, sweep);
  const auto known_apart = [&](const BodyPair& p) {
    return std::binary_search(options.apart.begin(), options.apart.end(), p);
  };
  std::erase_if(pairs, known_apart);
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
      if (!sweep.rests(bodies, i) && !known_apart({i, plane}) &&
          p.box.low.y <= ground.height + p.reach + options.margin * p.diagonal)
        pairs.emplace_back(i, plane);
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
      const Real margin = pair_margin(a, b, proxies[i], proxies[j], sweep);
      if (!boxes_near(cache.bounds(a).box, cache.bounds(b).box, placement(a, b), margin)) return;
      const CollisionShape &sa = cache.shape(a), &sb = cache.shape(b);
      shell_against_field(a, sa, b, sb, margin, true, found[n]);
      shell_against_field(b, sb, a, sa, margin, false, found[n]);
      edges_against_edges(a, cache, b, margin, found[n]);
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
