// Small fold-overs, as decimation leaves them: the vertices of intersecting triangles move towards their neighbours'
// mean.
#include <algorithm>

#include "engine/mesh/intersections.h"
#include "engine/mesh/repair_steps.h"

namespace sherd {
namespace {

constexpr std::size_t kCountLimit = 1000;
constexpr int kRounds = 12;

void smooth(SurfaceMesh& mesh, const std::vector<bool>& moving) {
  Vec3Column sum(mesh.vertex_count());
  std::vector<Real> weight(mesh.vertex_count(), 0.0);
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (moving[t[k]]) sum.add(t[k], mesh.vertices[t[(k + 1) % 3]] + mesh.vertices[t[(k + 2) % 3]]), weight[t[k]] += 2;
  for (std::size_t v = 0; v < moving.size(); ++v)
    if (moving[v]) mesh.vertices.set(v, 0.5 * (mesh.vertices[v] + sum[v] / weight[v]));
}

}  // namespace

Untangling untangle(SurfaceMesh& mesh) {
  Untangling result;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  result.before = result.after = count_self_intersections(mesh, kCountLimit, &pairs);
  for (const auto& pair : pairs) result.places.push_back(mesh.centroid(pair.first));
  // More than a few per thousand is a surface that passes through itself by design; smoothing would only wear it down.
  if (result.before == 0 || 500 * result.before > mesh.triangle_count()) return result;
  const Vec3Column original = mesh.vertices;
  std::vector<bool> moving(mesh.vertex_count(), false);
  for (int round = 0; round < kRounds && result.after > 0; ++round) {
    for (const auto& pair : pairs)
      for (const std::uint32_t t : {pair.first, pair.second})
        for (const std::uint32_t v : mesh.triangles[t]) moving[v] = true;
    smooth(mesh, moving);
    result.after = count_self_intersections(mesh, kCountLimit, &pairs);
    if (result.after > 2 * result.before) break;
  }
  if (result.after > 0) mesh.vertices = original;
  for (std::size_t v = 0; v < moving.size(); ++v)
    result.moved = std::max(result.moved, distance(original[v], mesh.vertices[v]));
  return result;
}

}  // namespace sherd
