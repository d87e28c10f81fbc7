#include "engine/mesh/surface_mesh.h"

#include <algorithm>

#include "kernels/core/error.h"

namespace sherd {

Box bounding_box(const SurfaceMesh& mesh) {
  Box box;
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) box.grow(mesh.vertices[i]);
  return box;
}

Real mean_edge_length(const SurfaceMesh& mesh) {
  Real sum = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) sum += distance(mesh.corner(t, k), mesh.corner(t, (k + 1) % 3));
  return mesh.triangles.empty() ? 0.0 : sum / (3.0 * static_cast<Real>(mesh.triangle_count()));
}

Real surface_area(const SurfaceMesh& mesh) {
  Real sum = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) sum += 0.5 * norm(mesh.area_normal2(t));
  return sum;
}

Real signed_volume(const SurfaceMesh& mesh) {
  // Relative to the box centre: far from the origin the triple products would cancel.
  const Vec3 o = bounding_box(mesh).centre();
  Real sum = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    sum += dot(mesh.corner(t, 0) - o, cross(mesh.corner(t, 1) - o, mesh.corner(t, 2) - o));
  return mesh.triangles.empty() ? 0.0 : sum / 6.0;
}

std::vector<std::uint32_t> build_twins(const SurfaceMesh& mesh) {
  struct Edge {
    std::uint32_t low, high, id;
    bool forward;
  };
  const std::size_t n = mesh.triangle_count();
  SHERD_CHECK(n < (kNone - 2) / 3, "{} triangles exceed the 32-bit edge index", n);
  std::vector<Edge> edges;
  edges.reserve(3 * n);
  for (std::size_t t = 0; t < n; ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(3 * t + k), a < b});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& p, const Edge& q) {
    return p.low != q.low ? p.low < q.low : (p.high != q.high ? p.high < q.high : p.id < q.id);
  });
  std::vector<std::uint32_t> twin(3 * n, kNone);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i + 1;
    while (j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high) ++j;
    if (j - i == 2 && edges[i].forward != edges[i + 1].forward)
      twin[edges[i].id] = edges[i + 1].id, twin[edges[i + 1].id] = edges[i].id;
    i = j;
  }
  return twin;
}

std::uint32_t label_components(const SurfaceMesh& mesh, std::vector<std::uint32_t>& label) {
  const std::vector<std::uint32_t> twin = build_twins(mesh);
  label.assign(mesh.triangle_count(), kNone);
  std::uint32_t count = 0;
  std::vector<std::uint32_t> stack;
  for (std::uint32_t seed = 0; seed < label.size(); ++seed) {
    if (label[seed] != kNone) continue;
    stack.assign(1, seed);
    label[seed] = count;
    while (!stack.empty()) {
      const std::uint32_t t = stack.back();
      stack.pop_back();
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t e = twin[3 * t + k];
        if (e == kNone || label[e / 3] != kNone) continue;
        label[e / 3] = count;
        stack.push_back(e / 3);
      }
    }
    ++count;
  }
  return count;
}

}  // namespace sherd
