#include "engine/contact/distance_field.h"

#include <algorithm>

#include "kernels/core/error.h"
#include "kernels/core/parallel.h"

namespace sherd {
namespace {

constexpr int kPad = 2;      // empty cells around the bounding box
constexpr Real kBand = 2.0;  // exact within this many steps
constexpr int kPasses = 3;   // of correction beyond the band
// Irrational part of a step by which the grid is shifted, so that grid lines miss the vertices and edges of boxes and
// plates.
constexpr Vec3 kShift{0.3819660112501051, 0.4142135623730950, 0.2360679774997897};

struct Grid {
  Vec3 origin;
  Real h;
  std::size_t n[3];
  std::size_t count() const { return n[0] * n[1] * n[2]; }
  std::size_t index(std::size_t i, std::size_t j, std::size_t k) const { return (k * n[1] + j) * n[0] + i; }
  Vec3 node(std::size_t i, std::size_t j, std::size_t k) const {
    return origin + Vec3{static_cast<Real>(i), static_cast<Real>(j), static_cast<Real>(k)} * h;
  }
  Vec3 node(std::size_t id) const { return node(id % n[0], (id / n[0]) % n[1], id / (n[0] * n[1])); }
};

Grid make_grid(const Box& box, Real h) {
  Grid g;
  g.h = h;
  g.origin = box.low - (Vec3{kPad, kPad, kPad} + kShift) * h;
  const Vec3 extent = box.high - g.origin;
  for (int k = 0; k < 3; ++k) g.n[k] = static_cast<std::size_t>(std::ceil(extent[k] / h)) + kPad + 1;
  return g;
}

// Squared distance and face of every node within the band, by running over the triangles slice by slice.
void fill_band(const SurfaceMesh& mesh, const Grid& g, std::vector<Real>& d2, std::vector<std::uint32_t>& face) {
  const Real band = kBand * g.h;
  struct Range {
    std::size_t low[3], high[3];
  };
  std::vector<Range> ranges(mesh.triangle_count());
  std::vector<std::vector<std::uint32_t>> slices(g.n[2]);
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    Box b;
    for (int k = 0; k < 3; ++k) b.grow(mesh.corner(t, k));
    for (int k = 0; k < 3; ++k) {
      ranges[t].low[k] = static_cast<std::size_t>(std::max(0.0, std::floor((b.low[k] - band - g.origin[k]) / g.h)));
      ranges[t].high[k] =
          std::min(g.n[k], static_cast<std::size_t>(std::max(0.0, (b.high[k] + band - g.origin[k]) / g.h)) + 2);
    }
    for (std::size_t k = ranges[t].low[2]; k < ranges[t].high[2]; ++k) slices[k].push_back(t);
  }
  parallel_for(g.n[2], 1, [&](std::size_t k) {
    for (const std::uint32_t t : slices[k]) {
      const Vec3 a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2),
                 n = normalized(mesh.area_normal2(t));
      for (std::size_t j = ranges[t].low[1]; j < ranges[t].high[1]; ++j)
        for (std::size_t i = ranges[t].low[0]; i < ranges[t].high[0]; ++i) {
          const Vec3 p = g.node(i, j, k);
          const Real height = dot(p - a, n);
          const std::size_t id = g.index(i, j, k);
          if (std::abs(height) > band * (1 + 1e-12) || height * height * (1 - 1e-12) >= d2[id]) continue;
          const Real q = distance2(p, closest_point_on_triangle(p, a, b, c));
          if (q <= band * band && q < d2[id]) d2[id] = q, face[id] = t;
        }
    }
  });
}

template <class F>
void for_neighbours(const Grid& g, std::size_t id, const F& visit) {
  const std::size_t i = id % g.n[0], j = (id / g.n[0]) % g.n[1], k = id / (g.n[0] * g.n[1]);
  if (i > 0) visit(id - 1);
  if (i + 1 < g.n[0]) visit(id + 1);
  if (j > 0) visit(id - g.n[0]);
  if (j + 1 < g.n[1]) visit(id + g.n[0]);
  if (k > 0) visit(id - g.n[0] * g.n[1]);
  if (k + 1 < g.n[2]) visit(id + g.n[0] * g.n[1]);
}

// For each of `nodes`: the nearest of the faces its neighbours know; written only after all have read.
void carry_faces(const SurfaceMesh& mesh, const Grid& g, const std::vector<std::size_t>& nodes, std::vector<Real>& d2,
                 std::vector<std::uint32_t>& face) {
  std::vector<std::uint32_t> found(nodes.size());
  parallel_for(nodes.size(), 512, [&](std::size_t l) {
    const std::size_t id = nodes[l];
    const Vec3 p = g.node(id);
    std::uint32_t tried[7] = {face[id]};
    int count = 1;
    found[l] = face[id];
    for_neighbours(g, id, [&](std::size_t m) {
      const std::uint32_t f = face[m];
      if (f == kNone || std::find(tried, tried + count, f) != tried + count) return;
      tried[count++] = f;
      const Real q =
          distance2(p, closest_point_on_triangle(p, mesh.corner(f, 0), mesh.corner(f, 1), mesh.corner(f, 2)));
      if (q < d2[id] || (q == d2[id] && f < found[l])) d2[id] = q, found[l] = f;
    });
  });
  for (std::size_t l = 0; l < nodes.size(); ++l) face[nodes[l]] = found[l];
}

// Nodes beyond the band, layer by layer; then again over all of them, since layers do not arrive in order of distance.
void fill_far(const SurfaceMesh& mesh, const Grid& g, std::vector<Real>& d2, std::vector<std::uint32_t>& face) {
  std::vector<char> seen(g.count(), 0);
  std::vector<std::size_t> settled, layer, far;
  for (std::size_t id = 0; id < g.count(); ++id)
    if (face[id] != kNone) settled.push_back(id), seen[id] = 1;
  while (!settled.empty()) {
    layer.clear();
    for (const std::size_t id : settled)
      for_neighbours(g, id, [&](std::size_t m) {
        if (!seen[m]) seen[m] = 1, layer.push_back(m);
      });
    carry_faces(mesh, g, layer, d2, face);
    far.insert(far.end(), layer.begin(), layer.end());
    settled.swap(layer);
  }
  for (int pass = 0; pass < kPasses; ++pass) carry_faces(mesh, g, far, d2, face);
}

// votes[node] += 1 where the parity of crossings along the grid line in direction `axis` says inside.
void vote_along(const TriangleBvh& bvh, const Grid& g, int axis, std::vector<std::uint8_t>& votes) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  Vec3 direction;
  direction[axis] = 1;
  parallel_for(g.n[u] * g.n[v], 32, [&](std::size_t line) {
    std::size_t at[3];
    at[axis] = 0, at[u] = line % g.n[u], at[v] = line / g.n[u];
    std::vector<TriangleBvh::Hit> hits;
    bvh.all_hits(g.node(at[0], at[1], at[2]), direction, 0, std::numeric_limits<Real>::infinity(), hits);
    std::size_t crossed = 0;
    for (std::size_t s = 0; s < g.n[axis] && crossed < hits.size() + 1; ++s) {
      while (crossed < hits.size() && hits[crossed].t < static_cast<Real>(s) * g.h) ++crossed;
      at[axis] = s;
      if (crossed % 2 == 1) ++votes[g.index(at[0], at[1], at[2])];
    }
  });
}

}  // namespace

Real field_spacing(const SurfaceMesh& mesh, const FieldOptions& options) {
  const Box box = bounding_box(mesh);
  const Vec3 extent = box.high - box.low;
  const Real longest = std::max({extent.x, extent.y, extent.z}), shortest = std::min({extent.x, extent.y, extent.z});
  Real h = options.spacing;
  if (h <= 0) {
    h = std::clamp(mean_edge_length(mesh), longest / 64, longest / 32);
    if (shortest > 0) h = std::min(h, std::max(shortest / 4, longest / 512));
  }
  while (make_grid(box, h).count() > options.max_nodes) h *= 1.05;
  return h;
}

SignedDistanceField::SignedDistanceField(const SurfaceMesh& mesh, const TriangleBvh& bvh, const FieldOptions& options) {
  SHERD_CHECK(mesh.triangle_count() > 0, "a distance field needs a mesh with triangles");
  SHERD_CHECK(options.max_nodes >= 1000, "a distance field needs room for 1000 nodes, not {}", options.max_nodes);
  const Box box = bounding_box(mesh);
  SHERD_CHECK(is_finite(box.low) && is_finite(box.high) && box.diagonal() > 0,
              "a distance field needs a finite, extended mesh");
  const Grid g = make_grid(box, field_spacing(mesh, options));
  origin_ = g.origin, h_ = g.h, inverse_h_ = 1 / g.h;
  high_ = g.node(g.n[0] - 1, g.n[1] - 1, g.n[2] - 1);
  std::copy(g.n, g.n + 3, n_);
  std::vector<Real> d2(g.count(), std::numeric_limits<Real>::infinity());
  std::vector<std::uint32_t> face(g.count(), kNone);
  fill_band(mesh, g, d2, face);
  fill_far(mesh, g, d2, face);
  std::vector<std::uint8_t> votes(g.count(), 0);
  for (int axis = 0; axis < 3; ++axis) vote_along(bvh, g, axis, votes);
  values_.resize(g.count());
  parallel_for(g.count(), 4096, [&](std::size_t id) {
    const bool inside = votes[id] == 0 ? false : (votes[id] == 3 ? true : bvh.inside(g.node(id)));
    const Real d = std::sqrt(d2[id]);
    values_[id] = static_cast<float>(inside ? -d : d);
  });
}

Vec3 SignedDistanceField::clamp(const Vec3& p) const {
  return min(max(p, origin_), high_);
}

SignedDistanceField::Cell SignedDistanceField::locate(const Vec3& clamped) const {
  const Vec3 s = (clamped - origin_) * inverse_h_;
  std::size_t i[3];
  Vec3 f;
  for (int k = 0; k < 3; ++k) {
    i[k] = std::min(static_cast<std::size_t>(std::max(0.0, s[k])), n_[k] - 2);
    f[k] = s[k] - static_cast<Real>(i[k]);
  }
  return {(i[2] * n_[1] + i[1]) * n_[0] + i[0], f};
}

Real SignedDistanceField::value(const Vec3& p) const {
  const Vec3 c = clamp(p);
  const auto [n, f] = locate(c);
  const std::size_t dy = n_[0], dz = n_[0] * n_[1];
  const auto along_x = [&](std::size_t m) {
    const Real a = values_[m], b = values_[m + 1];
    return a + f.x * (b - a);
  };
  const Real a = along_x(n), b = along_x(n + dy), e = along_x(n + dz), d = along_x(n + dy + dz);
  const Real low = a + f.y * (b - a), high = e + f.y * (d - e), v = low + f.z * (high - low);
  // The mesh lies in the (convex) grid box, so the way from p to it is at least the hypotenuse over the clamped point.
  const Real out2 = distance2(p, c);
  return out2 > 0 ? std::sqrt(out2 + v * v) : v;
}

Vec3 SignedDistanceField::gradient(const Vec3& p) const {
  const auto [n, f] = locate(clamp(p));
  const std::size_t dy = n_[0], dz = n_[0] * n_[1];
  const auto at = [&](std::size_t x, std::size_t y, std::size_t z) {
    return static_cast<Real>(values_[n + x + y * dy + z * dz]);
  };
  const auto mix = [](Real a, Real b, Real t) { return a + t * (b - a); };
  Vec3 g;
  g.x = mix(mix(at(1, 0, 0) - at(0, 0, 0), at(1, 1, 0) - at(0, 1, 0), f.y),
            mix(at(1, 0, 1) - at(0, 0, 1), at(1, 1, 1) - at(0, 1, 1), f.y), f.z);
  g.y = mix(mix(at(0, 1, 0) - at(0, 0, 0), at(1, 1, 0) - at(1, 0, 0), f.x),
            mix(at(0, 1, 1) - at(0, 0, 1), at(1, 1, 1) - at(1, 0, 1), f.x), f.z);
  g.z = mix(mix(at(0, 0, 1) - at(0, 0, 0), at(1, 0, 1) - at(1, 0, 0), f.x),
            mix(at(0, 1, 1) - at(0, 1, 0), at(1, 1, 1) - at(1, 1, 0), f.x), f.y);
  return g / h_;
}

}  // namespace sherd
