#include "engine/fragment/cut_checks.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/mesh/intersections.h"
#include "kernels/core/parallel.h"

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

using Corners = std::array<Vec3, 3>;

// Rounding of a dot product of differences, relative to the lengths of the vectors, with room to spare.
constexpr Real kMargin = 1e-14;

// Does some plane along an edge of `a` and its normal have a on one side and b clearly on the other?
bool edge_separates(const Corners& a, const Corners& b) {
  const Vec3 n = cross(a[1] - a[0], a[2] - a[0]);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &o = a[k], m = cross(a[(k + 1) % 3] - o, n);
    Real low = 1e300, high = -1e300, size = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      high = std::max(high, dot(m, a[j] - o)), low = std::min(low, dot(m, b[j] - o));
      size = std::max({size, norm2(a[j] - o), norm2(b[j] - o)});
    }
    if (low - high > kMargin * norm(m) * std::sqrt(size)) return true;
  }
  return false;
}

// a[i] and b[j] are one vertex: does a plane between an edge of a and one of b there separate all the rest?
bool edges_part(const Corners& a, std::size_t i, const Corners& b, std::size_t j) {
  const Vec3 &o = a[i], n = cross(a[1] - a[0], a[2] - a[0]);
  const Vec3 p[2] = {a[(i + 1) % 3] - o, a[(i + 2) % 3] - o}, q[2] = {b[(j + 1) % 3] - o, b[(j + 2) % 3] - o};
  const Real lp[2] = {norm(p[0]), norm(p[1])}, lq[2] = {norm(q[0]), norm(q[1])};
  for (int s = 0; s < 2; ++s)
    for (int t = 0; t < 2; ++t) {
      Vec3 m = cross(n, p[s] * lq[t] + q[t] * lp[s]);
      if (dot(m, p[s]) > 0) m = -1.0 * m;
      const Real margin = kMargin * norm(m);
      if (dot(m, p[0]) < -margin * lp[0] && dot(m, p[1]) < -margin * lp[1] && dot(m, q[0]) > margin * lq[0] &&
          dot(m, q[1]) > margin * lq[1])
        return true;
    }
  return false;
}

// Exact, but spares the exact arithmetic on the many parts of one plane that lie side by side.
bool meet(const Carving& carving, std::uint32_t f, std::uint32_t g) {
  const Triangle &s = carving.triangle(f), &t = carving.triangle(g);
  const Corners a = carving.corners(f), b = carving.corners(g);
  std::size_t shared = 0, i = 0, j = 0;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t l = 0; l < 3; ++l)
      if (s[k] == t[l]) ++shared, i = k, j = l;
  if (shared == 0 && (edge_separates(a, b) || edge_separates(b, a))) return false;
  if (shared == 1 && edges_part(a, i, b, j)) return false;
  return triangles_intersect(s, a, t, b);
}

// Looks for bad faces among some of the new ones.
class BadFaceSearch {
 public:
  BadFaceSearch(const Carving& carving, const std::vector<std::uint32_t>& tested, Real least_area)
      : carving_(carving),
        tested_(tested),
        least_area_(least_area),
        shift_(carving.body_faces()),
        others_(rest_of(carving, tested)),
        tree_(tree_of(carving, tested)),
        other_tree_(tested.size() < kFew ? tree_of(carving, {}) : tree_of(carving, others_)) {
    if (tested.size() < kFew)
      for (const std::uint32_t j : others_)
        if (tree_.box().overlaps(box_of(shift_ + j))) close_.push_back(j);
    // Parts of one face lie together: what is near the face is looked up once for all of them.
    for (std::size_t i = 0; i < tested.size(); ++i) {
      const NewFace &own = carving.faces[tested[i]], &last = carving.faces[tested[i == 0 ? 0 : i - 1]];
      if (i == 0 || own.parent != last.parent || own.of_slab != last.of_slab) groups_.push_back(i);
    }
    groups_.push_back(tested.size());
  }

  BadFaces run() const {
    constexpr std::size_t kGrain = 16;
    std::vector<std::vector<Found>> found(groups_.size() / kGrain + 1);
    parallel_for_chunks(groups_.size() - 1, kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t g = begin; g < end; ++g) test_group(groups_[g], groups_[g + 1], found[begin / kGrain]);
    });
    BadFaces bad;
    for (const auto& list : found)
      for (const Found& one : list) {
        if (bad.faces.empty()) bad.reason = one.reason;
        bad.faces.push_back(one.face);
      }
    std::sort(bad.faces.begin(), bad.faces.end());
    bad.faces.erase(std::unique(bad.faces.begin(), bad.faces.end()), bad.faces.end());
    return bad;
  }

 private:
  struct Found {
    std::uint32_t face;
    const char* reason;
  };

  static std::vector<std::uint32_t> rest_of(const Carving& carving, const std::vector<std::uint32_t>& tested) {
    std::vector<std::uint32_t> rest;
    for (std::uint32_t i = 0, next = 0; i < carving.faces.size(); ++i) {
      if (next < tested.size() && tested[next] == i) {
        ++next;
      } else if (carving.faces[i].alive) {
        rest.push_back(i);
      }
    }
    return rest;
  }
  Box box_of(std::uint32_t f) const {
    Box box;
    for (const Vec3& p : carving_.corners(f)) box.grow(p);
    return box;
  }

  void test_group(std::size_t begin, std::size_t end, std::vector<Found>& found) const {
    Box group;
    for (std::size_t i = begin; i < end; ++i) group.grow(box_of(shift_ + tested_[i]));
    std::vector<std::uint32_t> parts, whole, others;
    tree_.overlapping(group, parts);
    carving_.body().bvh().overlapping(group, whole);
    std::erase_if(whole, [&](std::uint32_t f) { return !carving_.alive(f); });
    other_tree_.overlapping(group, others);
    for (std::uint32_t& j : others) j = others_[j];
    others.insert(others.end(), close_.begin(), close_.end());
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t own = tested_[i];
      const auto c = carving_.corners(shift_ + own);
      const Box box = box_of(shift_ + own);
      const auto meets = [&](std::uint32_t f) { return box.overlaps(box_of(f)) && meet(carving_, shift_ + own, f); };
      if (!(0.5 * norm(cross(c[1] - c[0], c[2] - c[0])) > least_area_))
        found.push_back({own, "a part of a cut face has no area"});
      for (const std::uint32_t j : parts)
        if (j > i && meets(shift_ + tested_[j]))
          for (const std::uint32_t face : {own, tested_[j]})
            found.push_back({face, "two parts of cut faces intersect after rounding"});
      for (const std::uint32_t f : whole)
        if (meets(f)) found.push_back({own, "a part of a cut face intersects a whole face after rounding"});
      for (const std::uint32_t j : others)
        if (meets(shift_ + j)) found.push_back({own, "a part of a cut face intersects a wall after rounding"});
    }
  }

  const Carving& carving_;
  const std::vector<std::uint32_t>& tested_;
  Real least_area_;
  std::uint32_t shift_;
  std::vector<std::uint32_t> others_, close_;  // new faces not tested; those to compare with one by one
  TriangleBvh tree_, other_tree_;
  std::vector<std::size_t> groups_;  // borders between parents in tested_
};

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
  return BadFaceSearch(carving, tested, least_area).run();
}

std::string check_balance(const Carving& c) {
  const Real volume = c.body().volume(), error = std::abs(volume - c.kept_volume - c.removed_volume);
  if (error < 1e-9 * volume) return {};
  return fmt::format("volumes do not balance: {:.3g} of the body's volume is unaccounted for", error / volume);
}

}  // namespace sherd
