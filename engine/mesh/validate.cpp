#include "engine/mesh/validate.h"

#include <algorithm>
#include <numbers>

#include "engine/mesh/bvh.h"
#include "engine/mesh/intersections.h"
#include "engine/mesh/validate_edges.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

void note(DefectPlaces& places, const Vec3& p) {
  if (places.size() < 5) places.push_back(p);
}

// False when the topology or the geometry cannot be looked at.
bool check_raw(const SurfaceMesh& mesh, MeshReport& r) {
  r.vertices = mesh.vertex_count(), r.triangles = mesh.triangle_count();
  for (const Triangle& t : mesh.triangles)
    r.bad_indices += std::any_of(t.begin(), t.end(), [&](std::uint32_t v) { return v >= r.vertices; });
  for (std::size_t i = 0; i < r.vertices; ++i)
    if (!is_finite(mesh.vertices[i])) ++r.bad_coordinates, note(r.bad_coordinate_places, mesh.vertices[i]);
  return r.bad_indices == 0 && r.bad_coordinates == 0;
}

void measure(const SurfaceMesh& mesh, MeshReport& r) {
  r.box = bounding_box(mesh);
  r.area = surface_area(mesh), r.volume = signed_volume(mesh), r.mean_edge = mean_edge_length(mesh);
  r.min_edge = r.triangles == 0 ? 0.0 : std::numeric_limits<Real>::infinity();
  Real min_angle = r.triangles == 0 ? 0.0 : std::numbers::pi;
  for (std::size_t t = 0; t < r.triangles; ++t) {
    const Triangle& f = mesh.triangles[t];
    for (int k = 0; k < 3; ++k) {
      const Vec3 a = mesh.corner(t, k), b = mesh.corner(t, (k + 1) % 3), c = mesh.corner(t, (k + 2) % 3);
      r.min_edge = std::min(r.min_edge, distance(a, b)), r.max_edge = std::max(r.max_edge, distance(a, b));
      min_angle = std::min(min_angle, std::atan2(norm(cross(b - a, c - a)), dot(b - a, c - a)));
    }
    const Real shape = triangle_shape(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
    if (f[0] == f[1] || f[1] == f[2] || f[2] == f[0] || shape < kDegenerateShape)
      ++r.degenerate_triangles, note(r.degenerate_places, mesh.centroid(t));
    else if (shape < kNeedleShape)
      ++r.needle_triangles, note(r.needle_places, mesh.centroid(t));
  }
  r.min_angle = min_angle * 180 / std::numbers::pi;
}

void count_fans(const SurfaceMesh& mesh, DisjointSets& corners, MeshReport& r) {
  std::vector<std::uint32_t> fan(r.vertices, kNone);
  std::vector<bool> counted(r.vertices, false);
  for (std::uint32_t c = 0; c < 3 * r.triangles; ++c) {
    const std::uint32_t v = mesh.triangles[c / 3][c % 3], name = corners.find(c);
    if (fan[v] == kNone) fan[v] = name;
    if (fan[v] != name && !counted[v]) {
      counted[v] = true;
      ++r.nonmanifold_vertices, note(r.nonmanifold_vertex_places, mesh.vertices[v]);
    }
  }
  r.unused_vertices = static_cast<std::size_t>(std::count(fan.begin(), fan.end(), kNone));
}

std::size_t count_sets(DisjointSets& sets, std::size_t n, const std::vector<bool>& member) {
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < n; ++i) count += (member.empty() || member[i]) && sets.find(i) == i;
  return count;
}

void count_topology(const SurfaceMesh& mesh, MeshReport& r) {
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  DisjointSets corners(3 * r.triangles), faces(r.triangles), border(r.vertices);
  std::vector<bool> on_border(r.vertices, false);
  std::size_t edges = 0;
  for (std::size_t i = 0, j; i < uses.size(); i = j) {
    j = edge_end(uses, i), ++edges;
    const std::uint32_t a = uses[i].low, b = uses[i].high, first = uses[i].half_edge / 3;
    const Vec3 middle = 0.5 * (mesh.vertices[a] + mesh.vertices[b]);
    if (j - i == 1) {
      ++r.border_edges, note(r.border_places, middle);
      border.join(a, b), on_border[a] = on_border[b] = true;
    } else if (j - i > 2) {
      ++r.nonmanifold_edges, note(r.nonmanifold_edge_places, middle);
    } else if (uses[i].forward == uses[i + 1].forward) {
      ++r.misoriented_edges, note(r.misoriented_places, middle);
    }
    for (std::size_t k = i + 1; k < j; ++k) {
      const std::uint32_t t = uses[k].half_edge / 3;
      faces.join(first, t);
      corners.join(corner_at(mesh, first, a), corner_at(mesh, t, a));
      corners.join(corner_at(mesh, first, b), corner_at(mesh, t, b));
    }
  }
  count_fans(mesh, corners, r);
  r.components = count_sets(faces, r.triangles, {});
  r.border_loops = count_sets(border, r.vertices, on_border);
  const bool closed = r.border_edges == 0 && r.nonmanifold_edges == 0 && r.nonmanifold_vertices == 0;
  if (closed && r.misoriented_edges == 0 && r.triangles > 0) {
    const auto euler =
        static_cast<std::int64_t>(r.vertices - r.unused_vertices + r.triangles) - static_cast<std::int64_t>(edges);
    r.genus = static_cast<std::int64_t>(r.components) - euler / 2;  // sum over components of (2 - chi) / 2
  }
}

void count_inside_out(const SurfaceMesh& mesh, MeshReport& r) {
  std::vector<std::uint32_t> label;
  const std::uint32_t components = label_components(mesh, label);
  const std::vector<int> side = shell_sides(mesh, label, components);
  const Vec3 o = r.box.centre();
  std::vector<Real> volume6(components, 0.0);
  std::vector<std::size_t> first(components, r.triangles);
  for (std::size_t t = r.triangles; t-- > 0;) {
    volume6[label[t]] += dot(mesh.corner(t, 0) - o, cross(mesh.corner(t, 1) - o, mesh.corner(t, 2) - o));
    first[label[t]] = t;
  }
  for (std::uint32_t c = 0; c < components; ++c)
    if (side[c] * volume6[c] < 0) ++r.shells_inside_out, note(r.inside_out_places, mesh.centroid(first[c]));
}

}  // namespace

std::vector<EdgeUse> sorted_edge_uses(const SurfaceMesh& mesh) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * mesh.triangle_count());
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      if (a != b) uses.push_back({std::min(a, b), std::max(a, b), 3 * t + k, a < b});
    }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& p, const EdgeUse& q) {
    return p.low != q.low ? p.low < q.low : (p.high != q.high ? p.high < q.high : p.half_edge < q.half_edge);
  });
  return uses;
}

Real triangle_shape(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Real longest2 = std::max({distance2(a, b), distance2(b, c), distance2(c, a)});
  return longest2 > 0 ? norm(cross(b - a, c - a)) / longest2 : 0.0;
}

std::vector<int> shell_sides(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& label,
                             std::uint32_t components) {
  std::vector<int> side(components, 1);
  const std::vector<std::uint32_t> twin = build_twins(mesh);
  for (std::size_t e = 0; e < twin.size(); ++e)
    if (twin[e] == kNone) side[label[e / 3]] = 0;
  if (components < 2) return side;
  const TriangleBvh bvh(mesh);
  std::vector<bool> done(components, false);
  std::vector<TriangleBvh::Hit> hits;
  // Generic directions: three, so that one ray through an edge is outvoted.
  const Vec3 directions[3] = {{0.5377, 0.8339, 0.1261}, {-0.8622, 0.3188, 0.3931}, {0.3426, -0.5784, 0.7403}};
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const std::uint32_t own = label[t];
    if (done[own] || side[own] == 0) continue;
    done[own] = true;
    std::vector<int> votes(components, 0);
    for (const Vec3& direction : directions) {
      std::vector<bool> odd(components, false);
      bvh.all_hits(mesh.centroid(t), direction, 0, std::numeric_limits<Real>::max(), hits);
      for (const TriangleBvh::Hit& h : hits) odd[label[h.face]] = !odd[label[h.face]];
      for (std::uint32_t c = 0; c < components; ++c) votes[c] += odd[c];
    }
    bool inside_odd = false;
    for (std::uint32_t c = 0; c < components; ++c)
      if (c != own && side[c] != 0 && votes[c] >= 2) inside_odd = !inside_odd;
    side[own] = inside_odd ? -1 : 1;
  }
  return side;
}

MeshReport report_mesh(const SurfaceMesh& mesh, const ReportOptions& options) {
  MeshReport r;
  if (!check_raw(mesh, r)) return r;
  measure(mesh, r);
  count_topology(mesh, r);
  count_inside_out(mesh, r);
  if (options.count_self_intersections) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    const std::size_t count = count_self_intersections(mesh, options.self_intersection_limit, &pairs);
    r.self_intersections = static_cast<std::int64_t>(count);
    for (const auto& pair : pairs) note(r.self_intersection_places, mesh.centroid(pair.first));
  }
  return r;
}

bool is_valid(const MeshReport& r) {
  return r.triangles > 0 && r.bad_indices == 0 && r.bad_coordinates == 0 && r.border_edges == 0 &&
         r.nonmanifold_edges == 0 && r.nonmanifold_vertices == 0 && r.misoriented_edges == 0 &&
         r.degenerate_triangles == 0 && r.shells_inside_out == 0 && r.volume > 0 && r.self_intersections <= 0;
}

}  // namespace sherd
