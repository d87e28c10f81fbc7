#include "engine/contact/shape.h"

#include <algorithm>
#include <numeric>

namespace sherd {
namespace {

constexpr std::uint32_t kChunk = 32;

Real corner_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, v = c - a;
  return std::atan2(norm(cross(u, v)), dot(u, v));
}

int pieces(Real length, Real spacing) {
  return static_cast<int>(std::min(64.0, std::ceil(length / spacing)));
}

void add_edge_samples(const SurfaceMesh& m, const PseudoNormals& n, Real spacing, PointShell& shell) {
  for (std::size_t t = 0; t < m.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t i = m.triangles[t][static_cast<std::size_t>(k)],
                          j = m.triangles[t][static_cast<std::size_t>((k + 1) % 3)];
      if (i > j) continue;  // the twin, seen from the other triangle
      const Vec3 a = m.vertices[i], b = m.vertices[j];
      const int parts = pieces(distance(a, b), spacing);
      for (int s = 1; s < parts; ++s) {
        shell.points.push_back(a + (b - a) * (static_cast<Real>(s) / parts));
        shell.normals.push_back(n.edge[3 * t + static_cast<std::size_t>(k)]);
      }
    }
}

void add_face_samples(const SurfaceMesh& m, const PseudoNormals& n, Real spacing, PointShell& shell) {
  for (std::size_t t = 0; t < m.triangle_count(); ++t) {
    const Vec3 a = m.corner(t, 0), b = m.corner(t, 1), c = m.corner(t, 2);
    const Real longest = std::max({distance(a, b), distance(b, c), distance(c, a)});
    if (0.5 * norm(m.area_normal2(t)) < spacing * spacing) continue;
    const int parts = pieces(longest, spacing);
    for (int u = 1; u < parts; ++u)
      for (int v = 1; u + v < parts; ++v) {
        shell.points.push_back(a + (b - a) * (static_cast<Real>(u) / parts) + (c - a) * (static_cast<Real>(v) / parts));
        shell.normals.push_back(n.face[t]);
      }
  }
}

void make_chunks(const Vec3Column& points, std::vector<std::uint32_t>& order, std::uint32_t first, std::uint32_t count,
                 std::vector<PointShell::Chunk>& chunks) {
  Box box;
  for (std::uint32_t i = first; i < first + count; ++i) box.grow(points[order[i]]);
  if (count <= kChunk) {
    PointShell::Chunk chunk{box.centre(), 0, first, count};
    for (std::uint32_t i = first; i < first + count; ++i)
      chunk.radius = std::max(chunk.radius, distance(chunk.centre, points[order[i]]));
    chunks.push_back(chunk);
    return;
  }
  const Vec3 e = box.high - box.low;
  const int axis = e.x >= e.y && e.x >= e.z ? 0 : (e.y >= e.z ? 1 : 2);
  const std::uint32_t half = count / 2;
  const auto begin = order.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
    const Real pa = points[a][axis], pb = points[b][axis];
    return pa != pb ? pa < pb : a < b;
  });
  make_chunks(points, order, first, half, chunks);
  make_chunks(points, order, first + half, count - half, chunks);
}

Real shell_spacing(const SurfaceMesh& mesh, Real field_step) {
  const Box box = bounding_box(mesh);
  const Vec3 e = box.high - box.low;
  return std::max(2 * field_step, std::max({e.x, e.y, e.z}) / 16);
}

// Branch and bound over chunks and samples: between nodes the field errs by a grid step at most, beyond the grid it is
// a lower bound.
Real nearest_sample(const PointShell& shell, const CollisionShape& other, const Placement& place, Real limit) {
  const SignedDistanceField& field = other.field();
  Real least = limit;
  for (const PointShell::Chunk& c : shell.chunks) {
    if (field.beyond(place(c.centre), least + c.radius + field.spacing())) continue;
    for (std::uint32_t i = c.first; i < c.first + c.count; ++i) {
      const Vec3 p = place(shell.points[i]);
      const Real rough = field.value(p);
      if (rough - field.spacing() > least) continue;
      const CollisionShape::Nearest near = other.nearest(p, std::max(least, field.spacing() - rough));
      if (near.found) least = std::min(least, near.distance);
    }
  }
  return least;
}

}  // namespace

PseudoNormals pseudo_normals(const SurfaceMesh& mesh) {
  PseudoNormals n;
  n.face.resize(mesh.triangle_count());
  n.edge.resize(3 * mesh.triangle_count());
  n.vertex.resize(mesh.vertex_count());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    n.face[t] = normalized(mesh.area_normal2(t));
    for (int k = 0; k < 3; ++k) {
      const Real angle = corner_angle(mesh.corner(t, k), mesh.corner(t, (k + 1) % 3), mesh.corner(t, (k + 2) % 3));
      n.vertex[mesh.triangles[t][static_cast<std::size_t>(k)]] += n.face[t] * angle;
    }
  }
  const std::vector<std::uint32_t> twins = build_twins(mesh);
  for (std::size_t e = 0; e < twins.size(); ++e) {
    const Vec3 own = n.face[e / 3];
    n.edge[e] = normalized(twins[e] == kNone ? own : own + n.face[twins[e] / 3]);
  }
  for (Vec3& v : n.vertex) v = normalized(v);
  return n;
}

PointShell point_shell(const SurfaceMesh& mesh, const PseudoNormals& normals, Real spacing) {
  PointShell raw;
  std::vector<char> used(mesh.vertex_count(), 0);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) used[v] = 1;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    if (used[v]) raw.points.push_back(mesh.vertices[v]), raw.normals.push_back(normals.vertex[v]);
  add_edge_samples(mesh, normals, spacing, raw);
  add_face_samples(mesh, normals, spacing, raw);
  PointShell shell;
  std::vector<std::uint32_t> order(raw.points.size());
  std::iota(order.begin(), order.end(), 0u);
  if (!order.empty()) make_chunks(raw.points, order, 0, static_cast<std::uint32_t>(order.size()), shell.chunks);
  for (const std::uint32_t i : order) shell.points.push_back(raw.points[i]), shell.normals.push_back(raw.normals[i]);
  return shell;
}

CollisionShape::CollisionShape(std::shared_ptr<const SurfaceMesh> mesh, const FieldOptions& options)
    : mesh_(std::move(mesh)),
      bvh_(*mesh_),
      normals_(pseudo_normals(*mesh_)),
      field_(*mesh_, bvh_, options),
      shell_(point_shell(*mesh_, normals_, shell_spacing(*mesh_, field_.spacing()))),
      edges_(sharp_edges(*mesh_)) {}

CollisionShape::Nearest CollisionShape::nearest(const Vec3& p, Real max_distance) const {
  Nearest result;
  const TriangleBvh::Closest c = bvh_.closest(p, max_distance);
  if (c.face == kNone) return result;
  const auto& [v0, v1, v2] = bvh_.corners(c.face);
  // Barycentric weights of the closest point say whether it is on the face, an edge or a vertex.
  const Vec3 area = cross(v1 - v0, v2 - v0);
  const Real total = norm2(area), tiny = 1e-9;
  const Real w[3] = {dot(cross(v1 - c.point, v2 - c.point), area) / total,
                     dot(cross(v2 - c.point, v0 - c.point), area) / total,
                     dot(cross(v0 - c.point, v1 - c.point), area) / total};
  Vec3 n = normals_.face[c.face];
  for (int k = 0; k < 3; ++k)
    if (w[k] <= tiny) n = normals_.edge[3 * c.face + static_cast<std::size_t>((k + 1) % 3)];
  for (int k = 0; k < 3; ++k)
    if (w[(k + 1) % 3] <= tiny && w[(k + 2) % 3] <= tiny)
      n = normals_.vertex[mesh_->triangles[c.face][static_cast<std::size_t>(k)]];
  const Vec3 away = p - c.point;
  const Real d = norm(away), side = dot(away, n) < 0 ? -1.0 : 1.0;
  // So close that `away` is mostly rounding: take the pseudo-normal.
  const bool on_surface = d <= 1e-12 * (norm(c.point) + norm(v1 - v0));
  result = {c.point, on_surface ? n : away * (side / d), side * d, true};
  return result;
}

Real gap_between(const CollisionShape& own, const CollisionShape& other, const Placement& place, Real limit) {
  Real least = std::min(nearest_sample(own.shell(), other, place, limit), limit);
  least = std::min(nearest_sample(other.shell(), own, inverse(place), least), least);
  std::vector<EdgeCrossing> crossings;
  edge_crossings(own.edges(), other.edges(), place, own.field(), other.field(), least, 0, crossings);
  for (const EdgeCrossing& c : crossings) least = std::min(least, c.distance);
  return least;
}

}  // namespace sherd
