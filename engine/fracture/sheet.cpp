#include "engine/fracture/sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "engine/mesh/intersections.h"

namespace sherd {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

// Directed edges with their number of uses.
std::map<Edge, int> directed_edges(const CrackSheet& sheet) {
  std::map<Edge, int> edges;
  for (const Triangle& n : sheet.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++edges[{n[k], n[(k + 1) % 3]}];
  return edges;
}

std::string check_indices(const CrackSheet& sheet) {
  const std::size_t n = sheet.position.size();
  if (sheet.normal.size() != n || sheet.state.size() != n) return "columns of different length";
  for (std::size_t v = 0; v < n; ++v)
    if (!is_finite(sheet.position[v]) || !is_finite(sheet.normal[v])) return fmt::format("node {} is not finite", v);
  for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
    const Triangle& c = sheet.triangles[t];
    if (std::max({c[0], c[1], c[2]}) >= n) return fmt::format("triangle {} has a node out of range", t);
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) return fmt::format("triangle {} repeats a node", t);
    const Vec3 a = sheet.position[c[0]], b = sheet.position[c[1]], d = sheet.position[c[2]];
    if (norm(cross(b - a, d - a)) == 0) return fmt::format("triangle {} has no area", t);
  }
  return {};
}

// A node's triangles must be one fan: walking from triangle to triangle over shared edges reaches all of them.
std::string check_fans(const CrackSheet& sheet) {
  std::vector<std::vector<Edge>> link(sheet.state.size());  // edges opposite to the node, directed
  for (const Triangle& n : sheet.triangles)
    for (std::size_t k = 0; k < 3; ++k) link[n[k]].push_back({n[(k + 1) % 3], n[(k + 2) % 3]});
  for (std::size_t v = 0; v < link.size(); ++v) {
    if (link[v].empty()) continue;
    std::map<std::uint32_t, std::uint32_t> next;
    std::map<std::uint32_t, int> entered;
    for (const Edge& e : link[v]) next[e.first] = e.second, ++entered[e.second];
    std::uint32_t start = link[v].front().first;
    for (const Edge& e : link[v])
      if (!entered.contains(e.first)) start = e.first;
    std::size_t seen = 0;
    for (std::uint32_t at = start; seen < link[v].size();) {
      const auto step = next.find(at);
      if (step == next.end()) break;
      at = step->second, ++seen;
      if (at == start) break;
    }
    if (seen != link[v].size()) return fmt::format("node {} is a pinch", v);
  }
  return {};
}

// `front`, when given, lists exactly the border edges.
std::string check_front(const CrackSheet& sheet, const std::map<Edge, int>& edges) {
  if (sheet.front.empty()) return {};
  std::size_t border = 0, listed = 0;
  for (const auto& [e, uses] : edges) border += !edges.contains({e.second, e.first});
  for (const std::vector<std::uint32_t>& loop : sheet.front)
    for (std::size_t i = 0; i < loop.size(); ++i, ++listed) {
      const Edge e{loop[i], loop[(i + 1) % loop.size()]};
      if (!edges.contains(e) || edges.contains({e.second, e.first}))
        return fmt::format("front edge {} -> {} is not on the border", e.first, e.second);
    }
  return listed == border ? std::string() : fmt::format("the front has {} edges, the border {}", listed, border);
}

}  // namespace

std::vector<std::vector<std::uint32_t>> border_loops(const CrackSheet& sheet) {
  const std::map<Edge, int> edges = directed_edges(sheet);
  std::map<std::uint32_t, std::uint32_t> next;
  for (const auto& [e, uses] : edges)
    if (!edges.contains({e.second, e.first}) && !next.emplace(e.first, e.second).second) return {};
  std::vector<std::vector<std::uint32_t>> loops;
  while (!next.empty()) {
    std::vector<std::uint32_t>& loop = loops.emplace_back();
    std::uint32_t at = next.begin()->first;
    for (auto step = next.find(at); step != next.end(); step = next.find(at)) {
      loop.push_back(at);
      at = step->second;
      next.erase(step);
    }
    if (at != loop.front()) return {};
  }
  return loops;
}

std::string check_topology(const CrackSheet& sheet) {
  if (std::string bad = check_indices(sheet); !bad.empty()) return bad;
  const std::map<Edge, int> edges = directed_edges(sheet);
  for (const auto& [e, uses] : edges)
    if (uses > 1) return fmt::format("edge {} -> {} is used {} times", e.first, e.second, uses);
  if (std::string bad = check_front(sheet, edges); !bad.empty()) return bad;
  return check_fans(sheet);
}

std::string check_sheet(const CrackSheet& sheet) {
  if (std::string bad = check_topology(sheet); !bad.empty()) return bad;
  SurfaceMesh mesh;
  mesh.vertices = sheet.position;
  mesh.triangles = sheet.triangles;
  mesh.faces.resize(mesh.triangles.size());
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  if (count_self_intersections(mesh, 1, &pairs) > 0)
    return pairs.empty() ? std::string("self-intersection")
                         : fmt::format("triangles {} and {} intersect", pairs[0].first, pairs[0].second);
  return {};
}

}  // namespace sherd
