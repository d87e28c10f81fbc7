#include <algorithm>
#include <set>

#include "engine/mesh/repair_loop.h"
#include "engine/mesh/repair_steps.h"
#include "engine/mesh/validate_edges.h"

namespace sherd {
namespace {

using Loop = std::vector<std::uint32_t>;
using EdgeSet = std::set<std::pair<std::uint32_t, std::uint32_t>>;

// Loops run against the border's half-edges, so a filling oriented like its loop fits the surface.
std::vector<Loop> border_loops(const SurfaceMesh& mesh) {
  const std::vector<std::uint32_t> twin = build_twins(mesh);
  std::vector<std::uint32_t> before(mesh.vertex_count(), kNone);  // the border edge before[v] -> v
  for (std::size_t e = 0; e < twin.size(); ++e)
    if (twin[e] == kNone) before[mesh.triangles[e / 3][(e % 3 + 1) % 3]] = mesh.triangles[e / 3][e % 3];
  std::vector<Loop> loops;
  for (std::uint32_t v = 0; v < before.size(); ++v) {
    if (before[v] == kNone) continue;
    Loop loop;
    for (std::uint32_t at = v; before[at] != kNone;) {
      loop.push_back(at);
      const std::uint32_t next = before[at];
      before[at] = kNone, at = next;
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

// The filling's inner edges must be new: an edge the surface has already would get more than two triangles.
bool fits(const std::vector<Triangle>& filling, const Loop& loop, const EdgeSet& edges) {
  const auto n = static_cast<std::uint32_t>(loop.size());
  for (const Triangle& t : filling)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t i = t[k], j = t[(k + 1) % 3];
      if ((i + 1) % n == j || (j + 1) % n == i) continue;
      if (edges.contains(std::minmax(loop[i], loop[j]))) return false;
    }
  return true;
}

// Edges between two border vertices: the only ones a filling can meet.
EdgeSet edges_between_border_vertices(const SurfaceMesh& mesh, const std::vector<Loop>& loops) {
  std::vector<bool> on_border(mesh.vertex_count(), false);
  for (const Loop& loop : loops)
    for (const std::uint32_t v : loop) on_border[v] = true;
  EdgeSet edges;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (on_border[t[k]] && on_border[t[(k + 1) % 3]]) edges.insert(std::minmax(t[k], t[(k + 1) % 3]));
  return edges;
}

void fill(SurfaceMesh& mesh, const Loop& loop, const std::vector<Vec3>& points, const EdgeSet& edges) {
  const std::vector<Triangle> filling = triangulate_loop(points);
  if (fits(filling, loop, edges)) {
    for (const Triangle& t : filling) mesh.add_triangle(loop[t[0]], loop[t[1]], loop[t[2]]);
    return;
  }
  Vec3 centre;
  for (const Vec3& p : points) centre += p / static_cast<Real>(points.size());
  const auto apex = static_cast<std::uint32_t>(mesh.vertex_count());
  mesh.vertices.push_back(centre);
  for (std::size_t i = 0; i < loop.size(); ++i) mesh.add_triangle(loop[i], loop[(i + 1) % loop.size()], apex);
}

}  // namespace

HoleFilling fill_holes(SurfaceMesh& mesh, Real max_diameter) {
  HoleFilling result;
  const std::vector<Loop> loops = border_loops(mesh);
  if (loops.empty()) return result;
  const EdgeSet edges = edges_between_border_vertices(mesh, loops);
  const std::size_t before = mesh.triangle_count();
  for (const Loop& loop : loops) {
    Box box;
    std::vector<Vec3> points;
    for (const std::uint32_t v : loop) points.push_back(mesh.vertices[v]), box.grow(points.back());
    const Vec3 extent = box.high - box.low;
    const Real diameter = std::max({extent.x, extent.y, extent.z});
    if (diameter <= max_diameter) {
      fill(mesh, loop, points, edges);
      ++result.filled, result.largest_filled = std::max(result.largest_filled, diameter);
    } else {
      result.refused.push_back(box.centre()), result.refused_edges += loop.size();
      result.largest_refused = std::max(result.largest_refused, diameter);
    }
  }
  result.triangles = mesh.triangle_count() - before;
  return result;
}

}  // namespace sherd
