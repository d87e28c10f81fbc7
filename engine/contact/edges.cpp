#include "engine/contact/edges.h"

#include <algorithm>
#include <numeric>
#include <optional>

namespace sherd {
namespace {

constexpr std::uint32_t kChunk = 12;
constexpr Real kSharp = 0.94;     // cosine of the turn of an edge's faces
constexpr Real kInside = 1e-6;    // share of an edge from its end: ends are samples of the shell
constexpr Real kCone = 1e-6;      // of the normal cone
constexpr Real kParallel = 1e-4;  // sine below which edges have no crossing

Vec3 middle(const SharpEdge& e) {
  return 0.5 * (e.from + e.to);
}

void make_chunks(EdgeSet& set, std::uint32_t first, std::uint32_t count) {
  Box box;
  for (std::uint32_t i = first; i < first + count; ++i) box.grow(set.edges[i].from), box.grow(set.edges[i].to);
  if (count <= kChunk) {
    EdgeSet::Chunk chunk{box.centre(), 0, first, count};
    for (std::uint32_t i = first; i < first + count; ++i)
      chunk.radius =
          std::max({chunk.radius, distance(chunk.centre, set.edges[i].from), distance(chunk.centre, set.edges[i].to)});
    set.chunks.push_back(chunk);
    return;
  }
  const Vec3 e = box.high - box.low;
  const int axis = e.x >= e.y && e.x >= e.z ? 0 : (e.y >= e.z ? 1 : 2);
  // Stable: edges with the same middle keep the order of the mesh.
  std::stable_sort(set.edges.begin() + first, set.edges.begin() + first + count,
                   [&](const SharpEdge& a, const SharpEdge& b) { return middle(a)[axis] < middle(b)[axis]; });
  make_chunks(set, first, count / 2);
  make_chunks(set, first + count / 2, count - count / 2);
}

bool in_cone(const SharpEdge& e, const Vec3& n) {
  return dot(n, e.inward[0]) <= kCone && dot(n, e.inward[1]) <= kCone;
}

std::optional<EdgeCrossing> crossing(const SharpEdge& a, const SharpEdge& b, Real margin, Real depth) {
  const Vec3 u = a.to - a.from, v = b.to - b.from, w = a.from - b.from, across = cross(u, v);
  const Real uu = norm2(u), vv = norm2(v), uv = dot(u, v), area2 = norm2(across);
  if (area2 <= kParallel * kParallel * uu * vv) return {};
  const Real s = (uv * dot(v, w) - vv * dot(u, w)) / area2, t = (uu * dot(v, w) - uv * dot(u, w)) / area2;
  if (s < kInside || s > 1 - kInside || t < kInside || t > 1 - kInside) return {};
  const Vec3 p = a.from + u * s, q = b.from + v * t;
  Vec3 n = across / std::sqrt(area2);  // outward from b
  if (!in_cone(b, n)) n = -n;
  if (!in_cone(b, n) || !in_cone(a, -n)) return {};
  const Real d = dot(p - q, n);
  if (d > margin || d < -depth) return {};
  return EdgeCrossing{0.5 * (p + q), n, d};
}

std::vector<EdgeSet::Chunk> chunks_near(const EdgeSet& set, const Placement& place, const SignedDistanceField& field,
                                        Real margin) {
  std::vector<EdgeSet::Chunk> near;
  for (EdgeSet::Chunk c : set.chunks) {
    // Between nodes the field errs by a grid step at most.
    if (!field.beyond(place(c.centre), margin + c.radius + field.spacing())) near.push_back(c);
  }
  return near;
}

}  // namespace

EdgeSet sharp_edges(const SurfaceMesh& mesh) {
  EdgeSet set;
  const std::vector<std::uint32_t> twins = build_twins(mesh);
  for (std::uint32_t e = 0; e < twins.size(); ++e) {
    const std::uint32_t twin = twins[e];
    if (twin == kNone || e > twin) continue;
    const std::uint32_t t = e / 3, o = twin / 3;
    const int k = static_cast<int>(e % 3), m = static_cast<int>(twin % 3);
    const Vec3 n0 = normalized(mesh.area_normal2(t)), n1 = normalized(mesh.area_normal2(o));
    const Vec3 from = mesh.corner(t, k), to = mesh.corner(t, (k + 1) % 3);
    if (dot(n0, n1) > kSharp || dot(n0, mesh.corner(o, (m + 2) % 3) - from) >= 0) continue;
    const Vec3 along = normalized(to - from);
    set.edges.push_back({from, to, {cross(n0, along), cross(along, n1)}});
  }
  if (!set.edges.empty()) make_chunks(set, 0, static_cast<std::uint32_t>(set.edges.size()));
  return set;
}

void edge_crossings(const EdgeSet& own, const EdgeSet& other, const Placement& place,
                    const SignedDistanceField& own_field, const SignedDistanceField& other_field, Real margin,
                    Real depth, std::vector<EdgeCrossing>& found) {
  if (own.edges.empty() || other.edges.empty()) return;
  const std::vector<EdgeSet::Chunk> mine = chunks_near(own, place, other_field, margin);
  if (mine.empty()) return;
  const std::vector<EdgeSet::Chunk> theirs = chunks_near(other, inverse(place), own_field, margin);
  for (const EdgeSet::Chunk& a : mine) {
    const Vec3 centre = place(a.centre);
    SharpEdge placed[kChunk];
    bool ready = false;
    for (const EdgeSet::Chunk& b : theirs) {
      const Real near = a.radius + b.radius + std::max(margin, depth);
      if (distance2(centre, b.centre) > near * near) continue;
      for (std::uint32_t i = 0; i < a.count && !ready; ++i) {
        const SharpEdge& e = own.edges[a.first + i];
        placed[i] = {place(e.from), place(e.to), {place.rotation * e.inward[0], place.rotation * e.inward[1]}};
      }
      ready = true;
      for (std::uint32_t i = 0; i < a.count; ++i)
        for (std::uint32_t j = b.first; j < b.first + b.count; ++j)
          if (const auto c = crossing(placed[i], other.edges[j], margin, depth)) found.push_back(*c);
    }
  }
}

}  // namespace sherd
