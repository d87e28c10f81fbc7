#include "engine/fragment/cut_checks.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/mesh/intersections.h"

namespace sherd {
namespace {

SurfaceMesh part_of(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& faces) {
  SurfaceMesh part;
  part.vertices = mesh.vertices;
  part.triangles.reserve(faces.size());
  for (std::uint32_t f : faces) part.triangles.push_back(mesh.triangles[f]);
  return part;
}

}  // namespace

std::string check_numbers(const SurfaceMesh& mesh, const char* name) {
  if (mesh.triangles.empty()) return fmt::format("{} is empty", name);
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i)
    if (!is_finite(mesh.vertices[i])) return fmt::format("{}: vertex {} is not finite", name, i);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    for (std::uint32_t v : mesh.triangles[t])
      if (v >= mesh.vertex_count()) return fmt::format("{}: triangle {} has a vertex index out of range", name, t);
  return {};
}

std::string check_manifold(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& twin) {
  std::vector<std::uint32_t> faces(mesh.vertex_count(), 0), start(mesh.vertex_count(), kNone);
  for (std::uint32_t e = 0; e < twin.size(); ++e) {
    if (twin[e] == kNone) return fmt::format("an edge of triangle {} has not exactly one neighbour", e / 3);
    const std::uint32_t v = mesh.triangles[e / 3][e % 3];
    ++faces[v], start[v] = e;
  }
  for (std::size_t v = 0; v < start.size(); ++v) {
    if (start[v] == kNone) continue;
    // The edge before an outgoing one, reversed, is the next outgoing edge around the vertex.
    std::uint32_t e = start[v], fan = 0;
    do {
      const std::uint32_t before = e % 3 == 0 ? e + 2 : e - 1;
      e = twin[before], ++fan;
    } while (e != start[v] && fan <= faces[v]);
    if (fan != faces[v]) return fmt::format("the triangles around vertex {} are not one fan", v);
  }
  return {};
}

std::string check_touched(const Difference& difference) {
  const SurfaceMesh& mesh = difference.mesh;
  for (std::uint32_t t : difference.touched)
    if (!(norm2(mesh.area_normal2(t)) > 0)) return "a part of a cut face has no area after rounding";
  std::vector<std::uint32_t> rest;
  std::size_t next = 0;
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    if (next < difference.touched.size() && difference.touched[next] == t) {
      ++next;
      continue;
    }
    rest.push_back(t);
  }
  const TriangleBvh parts(part_of(mesh, difference.touched));
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  parts.overlapping_pairs(parts, pairs);
  for (const auto& [i, j] : pairs)
    if (i < j && faces_intersect(mesh, difference.touched[i], difference.touched[j]))
      return "two parts of cut faces intersect after rounding";
  parts.overlapping_pairs(TriangleBvh(part_of(mesh, rest)), pairs);
  for (const auto& [i, j] : pairs)
    if (faces_intersect(mesh, difference.touched[i], rest[j]))
      return "a part of a cut face intersects a whole face after rounding";
  return {};
}

std::string check_balance(const Difference& d) {
  const Real error = std::abs(d.body_volume - d.kept_volume - d.removed_volume);
  if (error < 1e-9 * d.body_volume) return {};
  return fmt::format("volumes do not balance: {:.3g} of the body's volume is unaccounted for", error / d.body_volume);
}

}  // namespace sherd
