#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "engine/mesh/load_raw.h"
#include "engine/mesh/validate_edges.h"

namespace sherd {
namespace {

struct EdgeCounts {
  std::size_t border = 0, nonmanifold = 0;
};

EdgeCounts count_edges(const SurfaceMesh& mesh, std::vector<bool>* on_border = nullptr) {
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  EdgeCounts counts;
  if (on_border != nullptr) on_border->assign(mesh.vertex_count(), false);
  for (std::size_t i = 0, j; i < uses.size(); i = j) {
    j = edge_end(uses, i);
    counts.nonmanifold += j - i > 2;
    if (j - i > 1) continue;
    ++counts.border;
    if (on_border != nullptr) (*on_border)[uses[i].low] = (*on_border)[uses[i].high] = true;
  }
  return counts;
}

// Vertices renamed to their set's name and packed in order of name; triangles keep their order.
SurfaceMesh merged(const SurfaceMesh& mesh, DisjointSets& sets) {
  SurfaceMesh out;
  std::vector<std::uint32_t> name(mesh.vertex_count(), kNone);
  for (std::uint32_t i = 0; i < mesh.vertex_count(); ++i)
    if (sets.find(i) == i) {
      name[i] = static_cast<std::uint32_t>(out.vertex_count());
      out.vertices.push_back(mesh.vertices[i]);
    }
  for (const Triangle& t : mesh.triangles)
    out.triangles.push_back({name[sets.find(t[0])], name[sets.find(t[1])], name[sets.find(t[2])]});
  out.faces = mesh.faces, out.channels = mesh.channels;
  return out;
}

SurfaceMesh join_equal(const SurfaceMesh& mesh) {
  std::vector<std::uint32_t> order(mesh.vertex_count());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) {
    const Vec3 p = mesh.vertices[i];
    return std::tuple(p.x, p.y, p.z, i);
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  DisjointSets sets(mesh.vertex_count());
  for (std::size_t i = 1; i < order.size(); ++i)
    if (mesh.vertices[order[i]] == mesh.vertices[order[i - 1]]) sets.join(order[i], order[i - 1]);
  return merged(mesh, sets);
}

SurfaceMesh join_near(const SurfaceMesh& mesh, const std::vector<bool>& on_border, Real tolerance) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < mesh.vertex_count(); ++i)
    if (on_border[i]) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(mesh.vertices.x[a], a) < std::pair(mesh.vertices.x[b], b);
  });
  DisjointSets sets(mesh.vertex_count());
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1; j < order.size() && mesh.vertices.x[order[j]] - mesh.vertices.x[order[i]] <= tolerance;
         ++j)
      if (distance(mesh.vertices[order[i]], mesh.vertices[order[j]]) <= tolerance) sets.join(order[i], order[j]);
  return merged(mesh, sets);
}

}  // namespace

void weld(SurfaceMesh& mesh, std::vector<std::string>& messages) {
  EdgeCounts before = count_edges(mesh);
  if (before.border == 0) return;  // joining could only make a closed mesh non-manifold where it touches itself
  const auto adopt = [&](SurfaceMesh candidate, EdgeCounts after, const char* how) {
    messages.push_back(fmt::format("joined {} vertices {}; border edges {} -> {}",
                                   mesh.vertex_count() - candidate.vertex_count(), how, before.border, after.border));
    mesh = std::move(candidate), before = after;
  };
  SurfaceMesh equal = join_equal(mesh);
  if (const EdgeCounts after = count_edges(equal); after.border < before.border)
    adopt(std::move(equal), after, "of equal coordinates");
  if (before.border == 0) return;
  std::vector<bool> on_border;
  count_edges(mesh, &on_border);
  SurfaceMesh near = join_near(mesh, on_border, 1e-7 * bounding_box(mesh).diagonal());
  if (const EdgeCounts after = count_edges(near);
      after.border < before.border && after.nonmanifold <= before.nonmanifold)
    adopt(std::move(near), after, "closer than 1e-7 of the size");
}

}  // namespace sherd
