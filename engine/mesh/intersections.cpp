#include "engine/mesh/intersections.h"

#include <algorithm>
#include <cmath>

#include "engine/mesh/bvh.h"
#include "kernels/core/parallel.h"
#include "kernels/core/predicates.h"

namespace sherd {
namespace {

using Corners = std::array<Vec3, 3>;

struct Point2 {
  Real x, y;
};

// Drops coordinate `axis`.
Point2 project(const Vec3& p, int axis) {
  return {p[(axis + 1) % 3], p[(axis + 2) % 3]};
}

int turn(const Point2& a, const Point2& b, const Point2& c) {
  return orient2d(a.x, a.y, b.x, b.y, c.x, c.y);
}

// c is known to lie on the line ab.
bool between(const Point2& a, const Point2& b, const Point2& c) {
  return std::min(a.x, b.x) <= c.x && c.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= c.y &&
         c.y <= std::max(a.y, b.y);
}

bool segments_meet_2d(const Point2& p, const Point2& q, const Point2& a, const Point2& b) {
  const int sa = turn(p, q, a), sb = turn(p, q, b), sp = turn(a, b, p), sq = turn(a, b, q);
  if (sa * sb < 0 && sp * sq < 0) return true;
  return (sa == 0 && between(p, q, a)) || (sb == 0 && between(p, q, b)) || (sp == 0 && between(a, b, p)) ||
         (sq == 0 && between(a, b, q));
}

// Strict or not, but never "inside" a triangle that projects to a segment: its edges decide then.
bool inside_2d(const Point2& p, const Point2& a, const Point2& b, const Point2& c) {
  const int s[3] = {turn(a, b, p), turn(b, c, p), turn(c, a, p)};
  const int low = std::min({s[0], s[1], s[2]}), high = std::max({s[0], s[1], s[2]});
  return (low >= 0 && high > 0) || (high <= 0 && low < 0);
}

// All five points lie in one plane. At least one coordinate projection is injective on it and decides; the others can
// only say yes too, so the conjunction over the three needs no choice of a dominant axis.
bool coplanar_segment_meets(const Vec3& p, const Vec3& q, const Corners& t) {
  for (int axis = 0; axis < 3; ++axis) {
    const Point2 p2 = project(p, axis), q2 = project(q, axis);
    const Point2 a = project(t[0], axis), b = project(t[1], axis), c = project(t[2], axis);
    if (!segments_meet_2d(p2, q2, a, b) && !segments_meet_2d(p2, q2, b, c) && !segments_meet_2d(p2, q2, c, a) &&
        !inside_2d(p2, a, b, c))
      return false;
  }
  return true;
}

// sp, sq: sides of p and q to the plane of t.
bool segment_meets_triangle(const Vec3& p, const Vec3& q, int sp, int sq, const Corners& t) {
  if (sp * sq > 0) return false;
  const int s[3] = {orient3d(p, q, t[0], t[1]), orient3d(p, q, t[1], t[2]), orient3d(p, q, t[2], t[0])};
  if (sp == 0 && sq == 0) return s[0] == 0 && s[1] == 0 && s[2] == 0 && coplanar_segment_meets(p, q, t);
  return std::min({s[0], s[1], s[2]}) >= 0 || std::max({s[0], s[1], s[2]}) <= 0;
}

std::array<int, 3> sides(const Corners& t, const Corners& points) {
  return {orient3d(t[0], t[1], t[2], points[0]), orient3d(t[0], t[1], t[2], points[1]),
          orient3d(t[0], t[1], t[2], points[2])};
}

bool same_strict_side(const std::array<int, 3>& s) {
  return s[0] != 0 && s[0] == s[1] && s[1] == s[2];
}

bool disjoint_indices_intersect(const Corners& a, const Corners& b) {
  const std::array<int, 3> sb = sides(a, b);
  if (same_strict_side(sb)) return false;
  const std::array<int, 3> sa = sides(b, a);
  if (same_strict_side(sa)) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3;
    if (segment_meets_triangle(b[k], b[l], sb[k], sb[l], a)) return true;
    if (segment_meets_triangle(a[k], a[l], sa[k], sa[l], b)) return true;
  }
  return false;
}

// a[i] and b[j] are the same vertex. The intersection is convex and contains it; when it is more than that point, it
// reaches the edge of one triangle opposite to the vertex, so those two edges decide.
bool vertex_pair_intersects(const Corners& a, std::size_t i, const Corners& b, std::size_t j) {
  const Vec3 &a1 = a[(i + 1) % 3], &a2 = a[(i + 2) % 3], &b1 = b[(j + 1) % 3], &b2 = b[(j + 2) % 3];
  const int sb1 = orient3d(a[0], a[1], a[2], b1), sb2 = orient3d(a[0], a[1], a[2], b2);
  if (sb1 * sb2 > 0) return false;
  const int sa1 = orient3d(b[0], b[1], b[2], a1), sa2 = orient3d(b[0], b[1], b[2], a2);
  if (sa1 * sa2 > 0) return false;
  return segment_meets_triangle(b1, b2, sb1, sb2, a) || segment_meets_triangle(a1, a2, sa1, sa2, b);
}

// Triangles (v, w, p) and (v, w, q): more than the edge in common only when coplanar with p and q on the same side.
bool edge_pair_intersects(const Vec3& v, const Vec3& w, const Vec3& p, const Vec3& q) {
  if (orient3d(v, w, p, q) != 0) return false;
  bool decided = false;
  for (int axis = 0; axis < 3; ++axis) {
    const Point2 v2 = project(v, axis), w2 = project(w, axis);
    const int sp = turn(v2, w2, project(p, axis)), sq = turn(v2, w2, project(q, axis));
    if (sp * sq < 0) return false;
    if (sp != 0 && sq != 0) decided = true;
  }
  return decided;
}

// The filters below only ever answer "certainly apart"; they spare exact arithmetic on the coplanar neighbours of flat
// faces. kMargin is far above the rounding of a difference and a dot product, relative to the vectors' lengths.
constexpr Real kMargin = 1e-13;

// Separating direction from a to b through the middle between their centroids.
bool clearly_apart(const Corners& a, const Corners& b) {
  const Vec3 ca = (a[0] + a[1] + a[2]) / 3.0, cb = (b[0] + b[1] + b[2]) / 3.0, o = 0.5 * (ca + cb), d = cb - ca;
  const Real margin = kMargin * norm(d);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 u = a[k] - o, v = b[k] - o;
    if (dot(u, d) >= -margin * norm(u) || dot(v, d) <= margin * norm(v)) return false;
  }
  return true;
}

// A plane through an edge of a and perpendicular to a: in one plane, one of these or of b's parts whatever is apart.
bool edges_part(const Corners& a, const Corners& b) {
  const auto size = [](const Vec3& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); };
  const Vec3 n = cross(a[1] - a[0], a[2] - a[0]);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &o = a[k], e = a[(k + 1) % 3] - o, w = a[(k + 2) % 3] - o, d = cross(e, n);
    const Vec3 v[3] = {b[0] - o, b[1] - o, b[2] - o};
    const Real high = std::max({0.0, dot(e, d), dot(w, d)});
    const Real low = std::min({dot(v[0], d), dot(v[1], d), dot(v[2], d)});
    const Real longest = std::max({size(e), size(w), size(v[0]), size(v[1]), size(v[2])});
    if (low - high > kMargin * size(d) * longest) return true;
  }
  return false;
}

// The triangles (o, a1, a2) and (o, b1, b2): a plane through o with each strictly on its side. Tried are the one
// between their middles and those between each edge of one and each of the other: enough for most of what is apart in a
// plane.
bool clearly_only_vertex(const Vec3& o, const Vec3& a1, const Vec3& a2, const Vec3& b1, const Vec3& b2) {
  const Vec3 p[4] = {a1 - o, a2 - o, b1 - o, b2 - o};
  const Real l[4] = {norm(p[0]), norm(p[1]), norm(p[2]), norm(p[3])};
  if (!(l[0] > 0 && l[1] > 0 && l[2] > 0 && l[3] > 0)) return false;
  const Vec3 e[4] = {p[0] / l[0], p[1] / l[1], p[2] / l[2], p[3] / l[3]};
  const auto parts = [&](const Vec3& d) {
    const Real margin = kMargin * norm(d);
    return dot(e[0], d) < -margin && dot(e[1], d) < -margin && dot(e[2], d) > margin && dot(e[3], d) > margin;
  };
  return parts(e[2] + e[3] - e[0] - e[1]) || parts(e[2] - e[0]) || parts(e[2] - e[1]) || parts(e[3] - e[0]) ||
         parts(e[3] - e[1]);
}

// p and q seen along the edge vw lie in opposite half planes.
bool clearly_only_edge(const Vec3& v, const Vec3& w, const Vec3& p, const Vec3& q) {
  const Vec3 e = w - v, vp = p - v, vq = q - v;
  return dot(vp, vq) * norm2(e) - dot(vp, e) * dot(vq, e) < -kMargin * norm(vp) * norm(vq) * norm2(e);
}

}  // namespace

bool triangles_intersect(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  return !clearly_apart(a, b) && !edges_part(a, b) && !edges_part(b, a) && disjoint_indices_intersect(a, b);
}

bool triangles_intersect(const Triangle& ia, const std::array<Vec3, 3>& a, const Triangle& ib,
                         const std::array<Vec3, 3>& b) {
  std::size_t shared = 0, i = 0, j = 0;
  std::array<bool, 3> in_b{}, in_a{};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t l = 0; l < 3; ++l)
      if (ia[k] == ib[l]) ++shared, i = k, j = l, in_b[k] = true, in_a[l] = true;
  if (shared == 0) return triangles_intersect(a, b);
  if (shared == 1)
    return !clearly_only_vertex(a[i], a[(i + 1) % 3], a[(i + 2) % 3], b[(j + 1) % 3], b[(j + 2) % 3]) &&
           vertex_pair_intersects(a, i, b, j);
  if (shared > 2) return true;
  const std::size_t p = !in_b[0] ? 0 : (!in_b[1] ? 1 : 2), q = !in_a[0] ? 0 : (!in_a[1] ? 1 : 2);
  const Vec3 &v = a[(p + 1) % 3], &w = a[(p + 2) % 3];
  return !clearly_only_edge(v, w, a[p], b[q]) && edge_pair_intersects(v, w, a[p], b[q]);
}

bool faces_intersect(const SurfaceMesh& mesh, std::size_t t0, std::size_t t1) {
  const auto corners = [&](std::size_t t) { return Corners{mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)}; };
  return triangles_intersect(mesh.triangles[t0], corners(t0), mesh.triangles[t1], corners(t1));
}

std::size_t count_self_intersections(const SurfaceMesh& mesh, std::size_t limit,
                                     std::vector<std::pair<std::uint32_t, std::uint32_t>>* examples) {
  if (examples) examples->clear();
  if (limit == 0) return 0;
  // Blocks one after the other bound the work after the limit is reached; the grain fixes the chunks for any thread
  // count.
  constexpr std::size_t kBlock = 16384, kGrain = 256;
  const TriangleBvh bvh(mesh);
  const std::size_t n = mesh.triangle_count();
  std::size_t count = 0;
  std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> found(kBlock / kGrain);
  for (std::size_t first = 0; first < n && count < limit; first += kBlock) {
    const std::size_t size = std::min(kBlock, n - first);
    parallel_for_chunks(size, kGrain, [&](std::size_t begin, std::size_t end) {
      auto& pairs = found[begin / kGrain];
      pairs.clear();
      std::vector<std::uint32_t> near;
      for (std::size_t i = first + begin; i < first + end; ++i) {
        const auto t = static_cast<std::uint32_t>(i);
        Box box;
        for (const Vec3& p : bvh.corners(t)) box.grow(p);
        bvh.overlapping(box, near);
        for (const std::uint32_t u : near)
          if (u > t && triangles_intersect(mesh.triangles[t], bvh.corners(t), mesh.triangles[u], bvh.corners(u)))
            pairs.emplace_back(t, u);
      }
    });
    for (std::size_t c = 0; c < (size + kGrain - 1) / kGrain; ++c)
      for (const auto& pair : found[c]) {
        if (count == limit) return count;
        ++count;
        if (examples) examples->push_back(pair);
      }
  }
  return count;
}

}  // namespace sherd
