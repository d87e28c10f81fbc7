#include "engine/mesh/sizing.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "engine/mesh/attributes.h"
#include "engine/mesh/remesh_mesh.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

constexpr std::size_t kMostTriangles = 2'000'000;

void check(const SizingOptions& o) {
  if (!(o.edge_length > 0) || !std::isfinite(o.edge_length))
    throw InputError(fmt::format("sizing: edge_length is {}; give a positive length in metres", o.edge_length));
  if (!(o.edge_per_thickness >= 0) || !std::isfinite(o.edge_per_thickness))
    throw InputError(fmt::format("sizing: edge_per_thickness is {}; give 0 (off) or more", o.edge_per_thickness));
  if (!(o.growth > 0)) throw InputError(fmt::format("sizing: growth is {}; give a positive number", o.growth));
  if (!(o.finest > 0 && o.finest <= 1))
    throw InputError(fmt::format("sizing: finest is {}; give a part of edge_length in (0, 1]", o.finest));
}

// size[v] = min over w of size[w] + growth * way from w to v along edges (Dijkstra).
void bound_growth(const SurfaceMesh& mesh, Real growth, std::vector<Real>& size) {
  using Entry = std::pair<Real, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  std::vector<std::uint32_t> first(mesh.vertex_count() + 1, 0), neighbour(6 * mesh.triangle_count());
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) first[v + 1] += 2;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) first[v + 1] += first[v];
  std::vector<std::uint32_t> fill(first.begin(), first.end() - 1);
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      neighbour[fill[t[k]]++] = t[(k + 1) % 3];
      neighbour[fill[t[k]]++] = t[(k + 2) % 3];
    }
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) queue.emplace(size[v], v);
  while (!queue.empty()) {
    const auto [s, v] = queue.top();
    queue.pop();
    if (s > size[v]) continue;
    for (std::uint32_t i = first[v]; i < first[v + 1]; ++i) {
      const std::uint32_t w = neighbour[i];
      const Real bound = s + growth * distance(mesh.vertices[v], mesh.vertices[w]);
      if (bound < size[w]) size[w] = bound, queue.emplace(bound, w);
    }
  }
}

}  // namespace

std::vector<Real> sizing_field(const SurfaceMesh& mesh, const std::vector<Real>& thickness,
                               const SizingOptions& options) {
  check(options);
  SHERD_CHECK(thickness.size() == mesh.vertex_count(), "{} thicknesses for {} vertices", thickness.size(),
              mesh.vertex_count());
  std::vector<Real> size(mesh.vertex_count(), options.edge_length);
  if (!(options.edge_per_thickness > 0)) return size;
  const Real least = options.finest * options.edge_length;
  for (std::size_t v = 0; v < size.size(); ++v)
    size[v] = std::clamp(options.edge_per_thickness * thickness[v], least, options.edge_length);
  bound_growth(mesh, options.growth, size);
  return size;
}

Real expected_triangles(const SurfaceMesh& mesh, const std::vector<Real>& size,
                        const std::vector<std::uint8_t>& locked) {
  SHERD_CHECK(size.size() == mesh.vertex_count(), "{} target lengths for {} vertices", size.size(),
              mesh.vertex_count());
  Real sum = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Triangle& v = mesh.triangles[t];
    const bool stays = !locked.empty() && locked[v[0]] != 0 && locked[v[1]] != 0 && locked[v[2]] != 0;
    const Real h = (size[v[0]] + size[v[1]] + size[v[2]]) / 3;
    sum += stays ? 1 : 0.5 * norm(mesh.area_normal2(t)) / (0.25 * std::sqrt(3.0) * h * h);
  }
  return sum;
}

Real finest_target(const SurfaceMesh& mesh, const SizingOptions& options) {
  check(options);
  if (!(options.edge_per_thickness > 0) || mesh.vertex_count() == 0) return options.edge_length;
  const std::vector<Real> size = sizing_field(mesh, wall_thickness(mesh).vertex, options);
  return *std::min_element(size.begin(), size.end());
}

SurfaceMesh with_edges_halved(const SurfaceMesh& mesh, Real longest) {
  SurfaceMesh source = mesh;
  source.faces.resize(mesh.triangle_count());
  // Children stay inside their parent, whose number they inherit.
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) source.faces.source[t] = static_cast<std::int32_t>(t);
  EditMesh edit;
  const char* reason = nullptr;
  if (!edit.assign(source, reason)) return mesh;
  // Longest first, so that halving keeps the angles: an edge is halved before any shorter one.
  using Entry = std::pair<Real, std::uint32_t>;  // length, and the half-edge counted down: ties go to the lowest
  std::priority_queue<Entry> queue;
  const auto add = [&](std::uint32_t h) {
    const Real length = edit.edge_length(h);
    if (length > longest) queue.emplace(length, kNone - std::min(h, edit.twin[h]));
  };
  for (std::uint32_t h = 0; h < edit.twin.size(); ++h)
    if (h < edit.twin[h]) add(h);
  while (!queue.empty()) {
    const auto [length, key] = queue.top();
    queue.pop();
    const std::uint32_t h = kNone - key;
    if (edit.edge_length(h) != length) continue;  // halved or renumbered meanwhile
    if (edit.triangle.size() + 2 > kMostTriangles) return mesh;
    const Vec3 middle = 0.5 * (edit.position[edit.from(h)] + edit.position[edit.to(h)]);
    const std::uint32_t m = edit.split(h, middle);
    // The outline's edges too: splitting gives two of them new numbers.
    edit.for_out(m, [&](std::uint32_t x) { add(x), add(EditMesh::next(x)); });
  }
  SurfaceMesh out = edit.extract();
  match_channels(mesh, out);
  for (CornerChannel& c : out.channels) c.value.clear();
  for (std::size_t t = 0; t < out.triangle_count(); ++t) {
    const auto parent = static_cast<std::uint32_t>(out.faces.source[t]);
    out.faces.source[t] = mesh.faces.source.empty() ? -1 : mesh.faces.source[parent];
    interpolate_corners(mesh, parent, {out.corner(t, 0), out.corner(t, 1), out.corner(t, 2)}, out);
  }
  return out;
}

RemeshReport remesh_graded(const SurfaceMesh& in, const SizingOptions& options, SurfaceMesh& out) {
  check(options);
  RemeshOptions target;
  target.edge_length = options.edge_length;
  target.merge = options.merge;
  if (!(options.edge_per_thickness > 0)) return remesh(in, target, out);
  const SurfaceMesh fine = with_edges_halved(in, options.edge_length);
  target.size = sizing_field(fine, wall_thickness(fine).vertex, options);
  return remesh(fine, target, out);
}

}  // namespace sherd
