#include <algorithm>

#include "engine/mesh/attributes.h"
#include "engine/mesh/repair_steps.h"
#include "engine/mesh/validate.h"
#include "engine/mesh/validate_edges.h"

namespace sherd {

std::size_t drop_repeated_vertex_triangles(SurfaceMesh& mesh) {
  const std::size_t before = mesh.triangle_count();
  std::vector<bool> keep;
  for (const Triangle& f : mesh.triangles) keep.push_back(f[0] != f[1] && f[1] != f[2] && f[2] != f[0]);
  keep_faces(mesh, keep);
  return before - mesh.triangle_count();
}

std::size_t drop_unused_vertices(SurfaceMesh& mesh) {
  std::vector<std::uint32_t> name(mesh.vertex_count(), kNone);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) name[v] = 0;
  Vec3Column kept;
  for (std::size_t i = 0; i < name.size(); ++i)
    if (name[i] == 0) name[i] = static_cast<std::uint32_t>(kept.size()), kept.push_back(mesh.vertices[i]);
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t) v = name[v];
  const std::size_t dropped = mesh.vertex_count() - kept.size();
  mesh.vertices = std::move(kept);
  return dropped;
}

std::size_t split_vertices(SurfaceMesh& mesh) {
  const std::size_t corners = 3 * mesh.triangle_count(), vertices = mesh.vertex_count();
  DisjointSets fans(corners);
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  for (std::size_t i = 0, j; i < uses.size(); i = j) {
    j = edge_end(uses, i);
    for (std::size_t k = i + 1; k < j; ++k)
      for (const std::uint32_t v : {uses[i].low, uses[i].high})
        fans.join(corner_at(mesh, uses[i].half_edge / 3, v), corner_at(mesh, uses[k].half_edge / 3, v));
  }
  std::vector<std::uint32_t> first_fan(vertices, kNone), name(corners, kNone);
  std::vector<bool> split(vertices, false);
  for (std::uint32_t c = 0; c < corners; ++c) {
    const std::uint32_t v = mesh.triangles[c / 3][c % 3], fan = fans.find(c);
    if (first_fan[v] == kNone) first_fan[v] = fan;
    split[v] = split[v] || first_fan[v] != fan;
  }
  // Every fan of a split vertex moves towards the middle of its rim, so that the pieces no longer touch.
  std::vector<Vec3> rim(corners);
  std::vector<Real> rim_size(corners, 0.0);
  for (std::uint32_t c = 0; c < corners; ++c) {
    const std::uint32_t t = c / 3, k = c % 3, fan = fans.find(c);
    if (!split[mesh.triangles[t][k]]) continue;
    rim[fan] += 0.5 * (mesh.corner(t, static_cast<int>((k + 1) % 3)) + mesh.corner(t, static_cast<int>((k + 2) % 3)));
    rim_size[fan] += 1;
  }
  std::vector<Triangle> triangles = mesh.triangles;
  for (std::uint32_t c = 0; c < corners; ++c) {
    const std::uint32_t v = mesh.triangles[c / 3][c % 3], fan = fans.find(c);
    if (!split[v]) continue;
    if (name[fan] == kNone) {
      const Vec3 apex = mesh.vertices[v], moved = apex + 1e-3 * (rim[fan] / rim_size[fan] - apex);
      const bool keeps = first_fan[v] == fan;
      name[fan] = keeps ? v : static_cast<std::uint32_t>(mesh.vertex_count());
      if (!keeps) mesh.vertices.push_back(moved);
    }
    triangles[c / 3][c % 3] = name[fan];
  }
  mesh.triangles = std::move(triangles);
  return static_cast<std::size_t>(std::count(split.begin(), split.end(), true));
}

Orientation orient(SurfaceMesh& mesh) {
  const std::size_t n = mesh.triangle_count();
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  struct Neighbour {
    std::uint32_t face = kNone;
    bool alike = true;  // the two run through the edge in opposite directions
  };
  std::vector<Neighbour> neighbour(3 * n);
  for (std::size_t i = 0, j; i < uses.size(); i = j) {
    j = edge_end(uses, i);
    if (j - i != 2) continue;
    const bool alike = uses[i].forward != uses[i + 1].forward;
    neighbour[uses[i].half_edge] = {uses[i + 1].half_edge / 3, alike};
    neighbour[uses[i + 1].half_edge] = {uses[i].half_edge / 3, alike};
  }
  Orientation result;
  std::vector<int> turn(n, -1);  // 1 = turn the triangle
  std::vector<std::uint32_t> component;
  for (std::uint32_t seed = 0; seed < n; ++seed) {
    if (turn[seed] >= 0) continue;
    component.assign(1, seed), turn[seed] = 0;
    std::size_t turned = 0;
    for (std::size_t i = 0; i < component.size(); ++i) {
      const std::uint32_t t = component[i];
      for (std::uint32_t k = 0; k < 3; ++k) {
        const Neighbour& other = neighbour[3 * t + k];
        if (other.face == kNone) continue;
        const int wanted = other.alike ? turn[t] : 1 - turn[t];
        if (turn[other.face] < 0)
          turn[other.face] = wanted, turned += static_cast<std::size_t>(wanted), component.push_back(other.face);
        else if (turn[other.face] != wanted && t < other.face)
          result.conflicts.push_back(
              0.5 * (mesh.corner(t, static_cast<int>(k)) + mesh.corner(t, static_cast<int>((k + 1) % 3))));
      }
    }
    // The majority keeps its side.
    const bool invert = 2 * turned > component.size();
    for (const std::uint32_t t : component)
      if ((turn[t] == 1) != invert) turn_face(mesh, t), ++result.flipped;
  }
  return result;
}

std::size_t turn_shells(SurfaceMesh& mesh) {
  std::vector<std::uint32_t> label;
  const std::uint32_t components = label_components(mesh, label);
  const std::vector<int> side = shell_sides(mesh, label, components);
  const Vec3 o = bounding_box(mesh).centre();
  std::vector<Real> volume6(components, 0.0);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    volume6[label[t]] += dot(mesh.corner(t, 0) - o, cross(mesh.corner(t, 1) - o, mesh.corner(t, 2) - o));
  std::size_t turned = 0;
  for (std::uint32_t c = 0; c < components; ++c) turned += side[c] * volume6[c] < 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    if (side[label[t]] * volume6[label[t]] < 0) turn_face(mesh, t);
  return turned;
}

}  // namespace sherd
