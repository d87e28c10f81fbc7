#include "engine/fragment/cut_checks.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/mesh/intersections.h"

namespace sherd {
namespace {

constexpr std::size_t kFew = 64;  // faces for which a tree over all others does not pay

// A tree over some of the new faces.
TriangleBvh tree_of(const Carving& carving, const std::vector<std::uint32_t>& faces) {
  SurfaceMesh soup;
  for (const std::uint32_t i : faces) {
    const auto n = static_cast<std::uint32_t>(soup.vertex_count());
    for (const Vec3& p : carving.corners(carving.body_faces() + i)) soup.vertices.push_back(p);
    soup.triangles.push_back({n, n + 1, n + 2});
  }
  return TriangleBvh(soup);
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

std::string check_links(const Carving& carving) {
  const std::uint32_t shift = carving.body_faces();
  // New faces around each of their vertices, and an edge that leaves it.
  SparseMap number, start;
  std::vector<std::uint32_t> vertices;
  for (std::uint32_t i = 0; i < carving.faces.size(); ++i) {
    if (!carving.faces[i].alive) continue;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t v = carving.faces[i].vertices[k];
      if (number.insert(v, 0)) start.set(v, 3 * (shift + i) + k), vertices.push_back(v);
      number.set(v, number[v] + 1);
    }
  }
  // Whole body faces around the corners of cut faces.
  SparseMap seen;
  for (const std::uint32_t f : carving.cut)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t v = carving.triangle(f)[k];
      if (!number.contains(v) || !seen.insert(v, 1)) continue;
      const auto& twin = carving.body().twins();
      std::uint32_t e = 3 * f + k, whole = 0;
      do {
        whole += carving.alive(e / 3);
        e = twin[e % 3 == 0 ? e + 2 : e - 1];
      } while (e != 3 * f + k);
      number.set(v, number[v] + whole);
    }
  for (const std::uint32_t v : vertices) {
    std::uint32_t fan = 0;
    carving.around(start[v], [&](std::uint32_t) { ++fan; });
    if (fan != number[v]) return fmt::format("the triangles around vertex {} are not one fan", v);
  }
  return {};
}

BadFaces find_bad_faces(const Carving& carving, const std::vector<std::uint32_t>& tested, Real least_area) {
  BadFaces bad;
  const std::uint32_t shift = carving.body_faces();
  const auto report = [&](std::uint32_t i, const char* reason) {
    if (bad.faces.empty()) bad.reason = reason;
    bad.faces.push_back(i);
  };
  const auto meet = [&](std::uint32_t f, std::uint32_t g) {
    return triangles_intersect(carving.triangle(f), carving.corners(f), carving.triangle(g), carving.corners(g));
  };
  std::vector<std::uint32_t> others;
  for (std::uint32_t i = 0, next = 0; i < carving.faces.size(); ++i) {
    if (next < tested.size() && tested[next] == i) {
      ++next;
      const auto c = carving.corners(shift + i);
      if (!(0.5 * norm(cross(c[1] - c[0], c[2] - c[0])) > least_area)) report(i, "a part of a cut face has no area");
    } else if (carving.faces[i].alive) {
      others.push_back(i);
    }
  }
  const TriangleBvh tree = tree_of(carving, tested);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  tree.overlapping_pairs(tree, pairs);
  for (const auto& [i, j] : pairs)
    if (i < j && meet(shift + tested[i], shift + tested[j])) {
      report(tested[i], "two parts of cut faces intersect after rounding");
      bad.faces.push_back(tested[j]);
    }
  tree.overlapping_pairs(carving.body().bvh(), pairs);
  for (const auto& [i, f] : pairs)
    if (carving.alive(f) && meet(shift + tested[i], f))
      report(tested[i], "a part of a cut face intersects a whole face");
  const auto against_other = [&](std::uint32_t i, std::uint32_t j) {
    if (meet(shift + tested[i], shift + others[j])) report(tested[i], "a part of a cut face intersects a wall");
  };
  if (tested.size() < kFew) {
    std::vector<std::uint32_t> near;
    for (std::uint32_t j = 0; j < others.size(); ++j) {
      Box box;
      for (const Vec3& p : carving.corners(shift + others[j])) box.grow(p);
      if (!tree.box().overlaps(box)) continue;
      tree.overlapping(box, near);
      for (const std::uint32_t i : near) against_other(i, j);
    }
  } else {
    tree.overlapping_pairs(tree_of(carving, others), pairs);
    for (const auto& [i, j] : pairs) against_other(i, j);
  }
  std::sort(bad.faces.begin(), bad.faces.end());
  bad.faces.erase(std::unique(bad.faces.begin(), bad.faces.end()), bad.faces.end());
  return bad;
}

std::string check_balance(const Carving& c) {
  const Real volume = c.body().volume(), error = std::abs(volume - c.kept_volume - c.removed_volume);
  if (error < 1e-9 * volume) return {};
  return fmt::format("volumes do not balance: {:.3g} of the body's volume is unaccounted for", error / volume);
}

}  // namespace sherd
