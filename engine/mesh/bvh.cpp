#include "engine/mesh/bvh.h"

#include <algorithm>
#include <numeric>

#include "kernels/core/expansion.h"

namespace sherd {
namespace {

constexpr std::uint32_t kLeafSize = 4;

Box box_of(const std::array<Vec3, 3>& c) {
  Box b;
  for (const Vec3& p : c) b.grow(p);
  return b;
}

Real box_distance2(const Box& b, const Vec3& p) {
  const Vec3 d = max(max(b.low - p, p - b.high), Vec3{0, 0, 0});
  return norm2(d);
}

// Slab test widened by a few rounding errors, so that a ray along a box face is never lost.
bool ray_hits_box(const Box& b, const Vec3& o, const Vec3& inverse, Real t0, Real t1) {
  for (int k = 0; k < 3; ++k) {
    if (std::isinf(inverse[k])) {  // parallel to the slab
      if (o[k] < b.low[k] || o[k] > b.high[k]) return false;
      continue;
    }
    Real a = (b.low[k] - o[k]) * inverse[k], c = (b.high[k] - o[k]) * inverse[k];
    if (a > c) std::swap(a, c);
    const Real slack = 1e-14 * (std::abs(a) + std::abs(c));
    t0 = std::max(t0, a - slack), t1 = std::min(t1, c + slack);
  }
  return t0 <= t1;
}

// Exact sign of d . ((p - o) x (q - o)).
int exact_side(const Vec3& o, const Vec3& d, const Vec3& p, const Vec3& q) {
  Expansion u[3], v[3];
  for (int k = 0; k < 3; ++k) u[k] = Expansion::difference(p[k], o[k]), v[k] = Expansion::difference(q[k], o[k]);
  const Expansion sum = (u[1] * v[2] - u[2] * v[1]) * d.x + (u[2] * v[0] - u[0] * v[2]) * d.y;
  return (sum + (u[0] * v[1] - u[1] * v[0]) * d.z).sign();
}

// A line that meets the edge exactly: sign of e . (d x (q - p)) for the infinitesimal shift e = (1, i, i^2) of the
// origin.
int perturbed_side(const Vec3& d, const Vec3& p, const Vec3& q) {
  Expansion e[3];
  for (int k = 0; k < 3; ++k) e[k] = Expansion::difference(q[k], p[k]);
  for (int k = 0; k < 3; ++k) {
    const int a = (k + 1) % 3, b = (k + 2) % 3, sign = (e[b] * d[a] - e[a] * d[b]).sign();
    if (sign != 0) return sign;
  }
  return 0;
}

// Sign of the volume spanned by the line (o, d) and the directed edge pq; 0 only for an edge parallel to the line.
int side_of_line(const Vec3& o, const Vec3& d, const Vec3& p, const Vec3& q) {
  const Vec3 u = p - o, v = q - o;
  const Real yz = u.y * v.z, zy = u.z * v.y, zx = u.z * v.x, xz = u.x * v.z, xy = u.x * v.y, yx = u.y * v.x;
  const Real value = (yz - zy) * d.x + (zx - xz) * d.y + (xy - yx) * d.z;
  const Real size = (std::abs(yz) + std::abs(zy)) * std::abs(d.x) + (std::abs(zx) + std::abs(xz)) * std::abs(d.y) +
                    (std::abs(xy) + std::abs(yx)) * std::abs(d.z);
  // At most seven roundings on the way to the value (Shewchuk's bound for orient3d, 7.0... eps).
  if (std::abs(value) > 8 * 0x1p-53 * size) return value > 0 ? 1 : -1;
  const int sign = exact_side(o, d, p, q);
  return sign != 0 ? sign : perturbed_side(d, p, q);
}

Vec3 closest_point_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const Real along = dot(ab, p - a), length2 = norm2(ab);
  if (along <= 0) return a;
  return along >= length2 ? b : a + ab * (along / length2);
}

// Of a triangle without area.
Vec3 closest_point_on_edges(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  Vec3 best = closest_point_on_segment(p, a, b);
  for (const Vec3& q : {closest_point_on_segment(p, b, c), closest_point_on_segment(p, c, a)})
    if (distance2(p, q) < distance2(p, best)) best = q;
  return best;
}

}  // namespace

Vec3 closest_point_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const Real d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3 bp = p - b;
  const Real d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const Real vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3) return a + ab * (d1 / (d1 - d3));
  const Vec3 cp = p - c;
  const Real d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const Real vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6) return a + ac * (d2 / (d2 - d6));
  const Real va = d3 * d6 - d5 * d4;
  const Real from_b = d4 - d3, from_c = d5 - d6;
  if (va <= 0 && from_b >= 0 && from_c >= 0 && from_b + from_c > 0) return b + (c - b) * (from_b / (from_b + from_c));
  // The area squared; of a triangle without area the sum of what was rounded away.
  const Real sum = va + vb + vc, rounded = 0x1p-44 * (std::abs(d1 * d4) + std::abs(d3 * d2) + std::abs(d5 * d2) +
                                                      std::abs(d1 * d6) + std::abs(d3 * d6) + std::abs(d5 * d4));
  if (!(sum > rounded)) return closest_point_on_edges(p, a, b, c);
  const Real s = 1 / sum;
  return a + ab * (vb * s) + ac * (vc * s);
}

TriangleBvh::TriangleBvh(const SurfaceMesh& mesh) {
  corners_.resize(mesh.triangle_count());
  for (std::size_t t = 0; t < corners_.size(); ++t)
    corners_[t] = {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
  order_.resize(corners_.size());
  std::iota(order_.begin(), order_.end(), 0u);
  if (!order_.empty()) build(0, static_cast<std::uint32_t>(order_.size()));
}

std::uint32_t TriangleBvh::build(std::uint32_t first, std::uint32_t count) {
  const auto id = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  Box box, centres;
  for (std::uint32_t i = first; i < first + count; ++i) {
    const Box b = box_of(corners_[order_[i]]);
    box.grow(b), centres.grow(b.centre());
  }
  nodes_[id].box = box;
  if (count <= kLeafSize) {
    nodes_[id].first = first, nodes_[id].count = count;
    return id;
  }
  const Vec3 extent = centres.high - centres.low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : (extent.y >= extent.z ? 1 : 2);
  const std::uint32_t half = count / 2;
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
    const Real ca = corners_[a][0][axis] + corners_[a][1][axis] + corners_[a][2][axis];
    const Real cb = corners_[b][0][axis] + corners_[b][1][axis] + corners_[b][2][axis];
    return ca != cb ? ca < cb : a < b;
  });
  build(first, half);
  const std::uint32_t right = build(first + half, count - half);
  nodes_[id].right = right;
  return id;
}

TriangleBvh::Closest TriangleBvh::closest(const Vec3& p, Real max_distance) const {
  Closest best;
  best.distance2 = max_distance * max_distance;
  if (nodes_.empty()) return best;
  std::uint32_t stack[128];
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const Node& node = nodes_[stack[--top]];
    if (box_distance2(node.box, p) > best.distance2) continue;
    if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        const std::uint32_t f = order_[i];
        const Vec3 q = closest_point_on_triangle(p, corners_[f][0], corners_[f][1], corners_[f][2]);
        const Real d2 = distance2(p, q);
        if (d2 < best.distance2 || (d2 == best.distance2 && f < best.face)) best = {q, f, d2};
      }
      continue;
    }
    const auto left = static_cast<std::uint32_t>(&node - nodes_.data()) + 1;
    const Real dl = box_distance2(nodes_[left].box, p), dr = box_distance2(nodes_[node.right].box, p);
    stack[top++] = dl < dr ? node.right : left;
    stack[top++] = dl < dr ? left : node.right;
  }
  return best;
}

void TriangleBvh::all_hits(const Vec3& origin, const Vec3& direction, Real t_min, Real t_max,
                           std::vector<Hit>& hits) const {
  hits.clear();
  if (nodes_.empty()) return;
  const Vec3 inverse{1 / direction.x, 1 / direction.y, 1 / direction.z};
  std::uint32_t stack[128];
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const std::uint32_t id = stack[--top];
    const Node& node = nodes_[id];
    if (!ray_hits_box(node.box, origin, inverse, t_min, t_max)) continue;
    if (node.count == 0) {
      stack[top++] = node.right;
      stack[top++] = id + 1;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const auto& c = corners_[order_[i]];
      // Which side of the line each edge passes. The signs are exact and ties follow one perturbation of the origin, so
      // a ray through an edge or a vertex crosses a closed surface as consistently as one beside it (watertight).
      int w[3];
      for (std::size_t k = 0; k < 3; ++k) w[k] = side_of_line(origin, direction, c[k], c[(k + 1) % 3]);
      const bool positive = w[0] > 0 && w[1] > 0 && w[2] > 0, negative = w[0] < 0 && w[1] < 0 && w[2] < 0;
      if (!positive && !negative) continue;
      const Vec3 n = cross(c[1] - c[0], c[2] - c[0]);
      const Real denominator = dot(direction, n);
      if (denominator == 0) continue;
      const Real t = dot(c[0] - origin, n) / denominator;
      if (t >= t_min && t <= t_max) hits.push_back({t, order_[i]});
    }
  }
  std::sort(hits.begin(), hits.end(),
            [](const Hit& a, const Hit& b) { return a.t != b.t ? a.t < b.t : a.face < b.face; });
}

bool TriangleBvh::inside(const Vec3& p) const {
  if (nodes_.empty()) return false;
  const Box& b = nodes_[0].box;
  if (p.x < b.low.x || p.y < b.low.y || p.z < b.low.z || p.x > b.high.x || p.y > b.high.y || p.z > b.high.z)
    return false;
  static const Vec3 directions[3] = {{0.5377, 0.1834, 0.8234}, {-0.7273, 0.6343, 0.2621}, {0.2192, -0.9413, -0.2570}};
  std::vector<Hit> hits;
  int votes = 0;
  for (const Vec3& d : directions) {
    all_hits(p, d, 0, std::numeric_limits<Real>::infinity(), hits);
    votes += static_cast<int>(hits.size() % 2);
  }
  return votes >= 2;
}

void TriangleBvh::overlapping(const Box& box, std::vector<std::uint32_t>& faces) const {
  faces.clear();
  if (nodes_.empty()) return;
  std::uint32_t stack[128];
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const std::uint32_t id = stack[--top];
    const Node& node = nodes_[id];
    if (!node.box.overlaps(box)) continue;
    if (node.count == 0) {
      stack[top++] = node.right;
      stack[top++] = id + 1;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      if (box_of(corners_[order_[i]]).overlaps(box)) faces.push_back(order_[i]);
  }
  std::sort(faces.begin(), faces.end());
}

void TriangleBvh::overlapping_pairs(const TriangleBvh& other,
                                    std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs) const {
  pairs.clear();
  if (nodes_.empty() || other.nodes_.empty()) return;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> stack{{0, 0}};
  while (!stack.empty()) {
    const auto [i, j] = stack.back();
    stack.pop_back();
    const Node &a = nodes_[i], &b = other.nodes_[j];
    if (!a.box.overlaps(b.box)) continue;
    if (a.count > 0 && b.count > 0) {
      for (std::uint32_t p = a.first; p < a.first + a.count; ++p)
        for (std::uint32_t q = b.first; q < b.first + b.count; ++q)
          if (box_of(corners_[order_[p]]).overlaps(box_of(other.corners_[other.order_[q]])))
            pairs.emplace_back(order_[p], other.order_[q]);
    } else if (b.count > 0 || (a.count == 0 && a.box.diagonal() >= b.box.diagonal())) {
      stack.emplace_back(i + 1, j), stack.emplace_back(a.right, j);
    } else {
      stack.emplace_back(i, j + 1), stack.emplace_back(i, b.right);
    }
  }
  std::sort(pairs.begin(), pairs.end());
}

}  // namespace sherd
