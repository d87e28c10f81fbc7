#include "engine/fracture/thicken.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "engine/material/scalar_field.h"
#include "engine/mesh/intersections.h"
#include "kernels/core/fault.h"

namespace sherd {
namespace {

constexpr Real kMaxStretch = 2;         // of the offset at a kink
constexpr int kMaxHalvings = 6;         // of the thickness at a fold
constexpr std::size_t kMaxPairs = 200;  // of intersecting slab faces looked at in one go

using Edge = std::pair<std::uint32_t, std::uint32_t>;
Edge sorted(std::uint32_t a, std::uint32_t b) {
  return a < b ? Edge{a, b} : Edge{b, a};
}

// The sheet refined so that no triangle and no interior edge has only single nodes: those would make two slab faces, or
// four faces on one edge, coincide. A node is single when both sides of the slab share it (zero thickness).
struct Refined {
  Vec3Column position;
  std::vector<std::uint8_t> single;
  std::vector<Triangle> triangles;
  std::map<Edge, int> edge_uses;  // undirected
};

void count_edges(Refined& r) {
  r.edge_uses.clear();
  for (const Triangle& n : r.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++r.edge_uses[sorted(n[k], n[(k + 1) % 3])];
}

std::uint32_t add_point(Refined& r, const Vec3& p) {
  r.position.push_back(p), r.single.push_back(0);
  return static_cast<std::uint32_t>(r.single.size() - 1);
}

// n with midpoints mid[k] on edges k -> k+1 (kNone: edge not split).
void subdivide(Refined& r, const Triangle& n, const Triangle& mid, std::vector<Triangle>& out) {
  std::vector<std::uint32_t> ring;
  for (std::size_t k = 0; k < 3; ++k) {
    ring.push_back(n[k]);
    if (mid[k] != kNone) ring.push_back(mid[k]);
  }
  if (ring.size() == 3) {
    if (!(r.single[n[0]] && r.single[n[1]] && r.single[n[2]])) {
      out.push_back(n);
      return;
    }
    const std::uint32_t c = add_point(r, (r.position[n[0]] + r.position[n[1]] + r.position[n[2]]) / 3.0);
    for (std::size_t k = 0; k < 3; ++k) out.push_back({n[k], n[(k + 1) % 3], c});
    return;
  }
  // A fan from the first midpoint: every triangle has it, so none is all single, and its diagonals are not all single.
  std::size_t first = 0;
  while (ring[first] == n[0] || ring[first] == n[1] || ring[first] == n[2]) ++first;
  for (std::size_t k = 1; k + 1 < ring.size(); ++k)
    out.push_back({ring[first], ring[(first + k) % ring.size()], ring[(first + k + 1) % ring.size()]});
}

Refined refine(const CrackSheet& sheet) {
  Refined r;
  r.position = sheet.position;
  r.triangles = sheet.triangles;
  r.single.assign(sheet.state.size(), 0);
  count_edges(r);
  for (const auto& [e, uses] : r.edge_uses)
    if (uses == 1)
      for (const std::uint32_t v : {e.first, e.second}) r.single[v] = sheet.state[v] != NodeState::kExited;
  std::map<Edge, std::uint32_t> middle;
  for (const auto& [e, uses] : r.edge_uses)
    if (uses == 2 && r.single[e.first] && r.single[e.second])
      middle[e] = add_point(r, 0.5 * (r.position[e.first] + r.position[e.second]));
  std::vector<Triangle> triangles;
  for (const Triangle& n : r.triangles) {
    Triangle mid{kNone, kNone, kNone};
    for (std::size_t k = 0; k < 3; ++k)
      if (const auto m = middle.find(sorted(n[k], n[(k + 1) % 3])); m != middle.end()) mid[k] = m->second;
    subdivide(r, n, mid, triangles);
  }
  r.triangles = std::move(triangles);
  count_edges(r);
  return r;
}

// node: of each slab vertex.
SurfaceMesh offset(const Refined& r, const std::vector<Real>& thickness, std::vector<std::uint32_t>& node) {
  const std::size_t n = r.position.size();
  node.clear();
  Vec3Column normal(n);
  std::vector<Real> area(n, 0);
  for (const Triangle& t : r.triangles) {
    const Vec3 a = cross(r.position[t[1]] - r.position[t[0]], r.position[t[2]] - r.position[t[0]]);
    for (const std::uint32_t v : t) normal.add(v, a), area[v] += norm(a);
  }
  SurfaceMesh slab;
  std::vector<std::uint32_t> up(n), down(n);
  for (std::uint32_t v = 0; v < n; ++v) {
    // Longer where the sheet bends, so that the slab's volume is thickness times area and not a cosine less.
    const Real stretch = std::min(area[v] / std::max(norm(normal[v]), 1e-300), kMaxStretch);
    const Vec3 half = r.single[v] ? Vec3{} : 0.5 * thickness[v] * stretch * normalized(normal[v]);
    up[v] = static_cast<std::uint32_t>(slab.vertices.size());
    slab.vertices.push_back(r.position[v] + half), node.push_back(v);
    down[v] = up[v];
    if (r.single[v]) continue;
    down[v] = up[v] + 1;
    slab.vertices.push_back(r.position[v] - half), node.push_back(v);
  }
  for (const Triangle& t : r.triangles) {
    slab.triangles.push_back({up[t[0]], up[t[1]], up[t[2]]}), slab.faces.side.push_back(1);
    slab.triangles.push_back({down[t[0]], down[t[2]], down[t[1]]}), slab.faces.side.push_back(-1);
  }
  for (const Triangle& t : r.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if (r.edge_uses.at(sorted(a, b)) != 1) continue;
      if (!r.single[a]) slab.triangles.push_back({up[a], down[a], down[b]});
      if (!r.single[b]) slab.triangles.push_back({up[a], down[b], up[b]});
    }
  return slab;
}

// Per node of the refined sheet, m; empty with the reason when a value is no thickness.
std::vector<Real> thicknesses(const Refined& r, const SlabOptions& options, std::string& reason) {
  std::vector<Real> t(r.position.size(), options.thickness);
  for (std::size_t v = 0; v < t.size(); ++v) {
    if (options.field) t[v] = options.field->at(r.position[v]);
    if (t[v] > 0 && std::isfinite(t[v])) continue;
    reason = fmt::format("thickness {} m is not positive", t[v]);
    return {};
  }
  return t;
}

// Texture coordinates in a plane across the mean normal.
void add_uv(const Refined& r, Real scale, SurfaceMesh& slab) {
  Vec3 sum;
  for (const Triangle& t : r.triangles)
    sum += cross(r.position[t[1]] - r.position[t[0]], r.position[t[2]] - r.position[t[0]]);
  const Vec3 n = norm(sum) > 0 ? normalized(sum) : Vec3{0, 0, 1}, u = scale * any_perpendicular(n), v = cross(n, u);
  CornerChannel uv{"uv", 2, {}};
  uv.value.reserve(uv.width() * slab.triangle_count());
  for (std::size_t t = 0; t < slab.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k)
      for (const Vec3& axis : {u, v}) uv.value.push_back(static_cast<float>(dot(slab.corner(t, k), axis)));
  slab.channels.push_back(std::move(uv));
}

// Where two places of the sheet come closer than the thickness (its folds beyond the surface, mostly) the slab would
// run into itself: it gets thinner around them, halved as often as needed. The reason when that does not help.
std::string offset_embedded(const Refined& r, std::vector<Real> thickness, SurfaceMesh& slab) {
  std::vector<std::uint32_t> node;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (int halvings = 0;; ++halvings) {
    slab = offset(r, thickness, node);
    for (const std::uint32_t twin : build_twins(slab))
      if (twin == kNone) return "the slab is not closed: the sheet is not a manifold with border";
    if (count_self_intersections(slab, kMaxPairs, &pairs) == 0) return {};
    if (halvings == kMaxHalvings) break;
    std::vector<std::uint32_t> thin;
    for (const auto& [f, g] : pairs)
      for (const std::uint32_t face : {f, g})
        for (const std::uint32_t v : slab.triangles[face]) thin.push_back(node[v]);
    std::sort(thin.begin(), thin.end());
    thin.erase(std::unique(thin.begin(), thin.end()), thin.end());
    for (const std::uint32_t v : thin) thickness[v] *= 0.5;
  }
  const Vec3 p = slab.centroid(pairs.front().first);
  return fmt::format("the slab intersects itself near ({:.4g}, {:.4g}, {:.4g}) m", p.x, p.y, p.z);
}

}  // namespace

std::optional<SurfaceMesh> thicken(const CrackSheet& sheet, const SlabOptions& options, std::string& reason) {
  reason.clear();
  if (sheet.triangles.empty()) {
    reason = "the sheet is empty";
    return std::nullopt;
  }
  fault_point("thicken");
  const Refined refined = refine(sheet);
  const std::vector<Real> thickness = thicknesses(refined, options, reason);
  if (!reason.empty()) return std::nullopt;
  SurfaceMesh slab;
  reason = offset_embedded(refined, thickness, slab);
  if (reason.empty() && !(signed_volume(slab) > 0)) reason = "the slab has no positive volume";
  if (!reason.empty()) return std::nullopt;
  slab.faces.resize(slab.triangle_count());
  slab.faces.kind.assign(slab.triangles.size(), FaceKind::kCrack);
  slab.faces.crack.assign(slab.triangles.size(), options.crack);
  slab.faces.material.assign(slab.triangles.size(), options.material);
  add_uv(refined, options.uv_scale, slab);
  return slab;
}

std::optional<SurfaceMesh> thicken(const CrackSheet& sheet, Real thickness, std::int32_t crack_id,
                                   std::string& reason) {
  SlabOptions options;
  options.thickness = thickness, options.crack = crack_id;
  return thicken(sheet, options, reason);
}

}  // namespace sherd
