// O7: ears close notches, bridges join fronts that meet (paper fig. 12), a small loop is filled. Nodes are never
// welded: welding makes pinch nodes.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "engine/fracture/front.h"

namespace sherd {
namespace {

constexpr Real kEarCosine = 0.2, kEarLength = 1.5, kBridge = 1.9;  // lengths of h
constexpr Real kWideEarCosine = -0.5, kWideEarLength = 2.2;        // where nothing else goes on
constexpr std::size_t kBridgeLoopDistance = 3;
constexpr std::size_t kFillSize = 7;  // nodes: at most 42 triangulations
constexpr Real kFillDiameter = 3;     // of h

void retire(Growth& g, std::uint32_t v) {
  g.sheet.state[v] = NodeState::kInterior;
}

bool close_ear(Growth& g, FrontLoop& loop, std::size_t i) {
  const std::size_t n = loop.size();
  if (n < 4) return false;
  const std::uint32_t a = loop[(i + n - 1) % n], m = loop[i], b = loop[(i + 1) % n];
  const Vec3 to_a = g.sheet.position[a] - g.sheet.position[m], to_b = g.sheet.position[b] - g.sheet.position[m];
  const Real cosine = g.relaxed ? kWideEarCosine : kEarCosine;
  const Real longest = (g.relaxed ? kWideEarLength : kEarLength) * g.h;
  if (dot(to_a, to_b) <= cosine * norm(to_a) * norm(to_b) || norm(to_a - to_b) >= longest) return false;
  if (dot(cross(-to_a, to_b), g.sheet.normal[m]) >= 0) return false;  // a spike of the sheet, not a notch
  if (n > 6 && is_exited(g, m) && (is_exited(g, a) || is_exited(g, b))) return false;
  if (g.sheet.has_edge(a, b) || !g.sheet.add({Triangle{m, a, b}})) return false;
  retire(g, m);
  loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(i));
  return true;
}

struct BridgeEnd {
  std::size_t loop, place;
  std::uint32_t first, second;  // directed front edge
  Vec3 middle, outward;
};

BridgeEnd bridge_end(const Growth& g, std::size_t l, std::size_t i) {
  const FrontLoop& loop = g.loops[l];
  BridgeEnd e{l, i, loop[i], loop[(i + 1) % loop.size()], {}, {}};
  const Vec3 p = g.sheet.position[e.first], q = g.sheet.position[e.second];
  e.middle = 0.5 * (p + q);
  e.outward = normalized(cross(q - p, g.sheet.normal[e.first] + g.sheet.normal[e.second]));
  return e;
}

bool may_bridge(const Growth& g, const BridgeEnd& a, const BridgeEnd& b) {
  const Vec3 d = b.middle - a.middle;
  const Real length = norm(d);
  if (!(length < kBridge * g.h) || dot(a.outward, d) <= 0.25 * length || dot(b.outward, d) >= -0.25 * length)
    return false;
  if (a.first == b.first || a.first == b.second || a.second == b.first || a.second == b.second) return false;
  if (a.loop == b.loop) {
    const std::size_t n = g.loops[a.loop].size(), apart = b.place > a.place ? b.place - a.place : a.place - b.place;
    if (std::min(apart, n - apart) < kBridgeLoopDistance) return false;
  }
  // Opposite crack normals would make the sheet one-sided.
  if (dot(g.sheet.normal[a.first], g.sheet.normal[b.first]) <= 0) return false;
  const SheetMesh& s = g.sheet;
  if (dot(s.position[a.second] - s.position[a.first], s.position[b.second] - s.position[b.first]) >= 0) return false;
  if (s.has_edge(a.first, b.second) || s.has_edge(b.first, a.second) || s.has_edge(a.first, b.first)) return false;
  return !(is_dead(g, a.first, a.second) && is_dead(g, b.first, b.second));
}

// Nodes from place `from` to place `to`, cyclic, both included.
FrontLoop arc(const FrontLoop& loop, std::size_t from, std::size_t to) {
  FrontLoop out;
  for (std::size_t i = from % loop.size();; i = (i + 1) % loop.size()) {
    out.push_back(loop[i]);
    if (i == to % loop.size()) return out;
  }
}

bool bridge(Growth& g, const BridgeEnd& a, const BridgeEnd& b) {
  if (!g.sheet.add({Triangle{a.second, a.first, b.first}, Triangle{a.first, b.second, b.first}})) return false;
  const FrontLoop first = g.loops[a.loop];
  if (a.loop == b.loop) {
    g.loops[a.loop] = arc(first, a.place + 1, b.place);
    g.loops.push_back(arc(first, b.place + 1, a.place));
    return true;
  }
  FrontLoop merged = arc(first, a.place + 1, a.place);
  const FrontLoop other = arc(g.loops[b.loop], b.place + 1, b.place);
  merged.insert(merged.end(), other.begin(), other.end());
  g.loops[a.loop] = std::move(merged);
  g.loops.erase(g.loops.begin() + static_cast<std::ptrdiff_t>(b.loop));
  return true;
}

// The closest admissible pair of front edges is joined; one at a time, since loops change.
bool bridge_nearest(Growth& g) {
  std::vector<BridgeEnd> ends;
  for (std::size_t l = 0; l < g.loops.size(); ++l)
    for (std::size_t i = 0; i < g.loops[l].size(); ++i) ends.push_back(bridge_end(g, l, i));
  struct Pair {
    Real distance2;
    std::size_t a, b;
  };
  // A sweep along x: only ends within reach of each other there are compared.
  const Real reach = kBridge * g.h;
  std::vector<std::size_t> along(ends.size());
  std::iota(along.begin(), along.end(), std::size_t{0});
  std::stable_sort(along.begin(), along.end(),
                   [&](std::size_t a, std::size_t b) { return ends[a].middle.x < ends[b].middle.x; });
  std::vector<Pair> pairs;
  for (std::size_t s = 0; s < along.size(); ++s)
    for (std::size_t t = s + 1; t < along.size(); ++t) {
      const auto [i, j] = std::minmax(along[s], along[t]);
      if (std::abs(ends[j].middle.x - ends[i].middle.x) > reach) break;
      const Real d2 = distance2(ends[i].middle, ends[j].middle);
      if (d2 < reach * reach && may_bridge(g, ends[i], ends[j])) pairs.push_back({d2, i, j});
    }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& x, const Pair& y) {
    return std::tie(x.distance2, x.a, x.b) < std::tie(y.distance2, y.a, y.b);
  });
  return std::any_of(pairs.begin(), pairs.end(), [&](const Pair& p) { return bridge(g, ends[p.a], ends[p.b]); });
}

bool all_dead(const Growth& g, const FrontLoop& loop) {
  for (std::size_t i = 0; i < loop.size(); ++i)
    if (!is_dead(g, loop[i], loop[(i + 1) % loop.size()])) return false;
  return true;
}

// All triangulations of the polygon loop[first .. last] (its closing edge last -> first included), appended to `out`.
using Triangulation = std::vector<Triangle>;
std::vector<Triangulation> triangulations(const FrontLoop& loop, std::size_t first, std::size_t last) {
  if (last < first + 2) return {{}};
  std::vector<Triangulation> out;
  for (std::size_t k = first + 1; k < last; ++k)
    for (const Triangulation& a : triangulations(loop, first, k))
      for (const Triangulation& b : triangulations(loop, k, last)) {
        Triangulation t = a;
        t.insert(t.end(), b.begin(), b.end());
        t.push_back({loop[last], loop[k], loop[first]});  // against the loop's own direction: the hole's side
        out.push_back(std::move(t));
      }
  return out;
}

bool diagonals_are_new(const Growth& g, const FrontLoop& loop, const Triangulation& triangles) {
  const auto place = [&](std::uint32_t v) {
    return static_cast<std::size_t>(std::find(loop.begin(), loop.end(), v) - loop.begin());
  };
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = place(t[k]), j = place(t[(k + 1) % 3]), apart = i > j ? i - j : j - i;
      if (apart != 1 && apart != loop.size() - 1 && g.sheet.has_edge(t[k], t[(k + 1) % 3])) return false;
    }
  return true;
}

// The hole's triangulation of least area that fits, else a fan around its centre.
bool fill(Growth& g, const FrontLoop& loop) {
  const auto area = [&](const Triangulation& triangles) {
    Real sum = 0;
    for (const Triangle& t : triangles)
      sum +=
          norm(cross(g.sheet.position[t[1]] - g.sheet.position[t[0]], g.sheet.position[t[2]] - g.sheet.position[t[0]]));
    return sum;
  };
  std::vector<std::pair<Real, Triangulation>> choices;
  for (Triangulation& t : triangulations(loop, 0, loop.size() - 1)) choices.emplace_back(area(t), std::move(t));
  std::stable_sort(choices.begin(), choices.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [size, triangles] : choices)
    if (diagonals_are_new(g, loop, triangles) && g.sheet.apply({{}, triangles, kNone, {}})) return true;
  if (loop.size() < 4) return false;
  Vec3 centre{}, normal{};
  for (const std::uint32_t v : loop)
    centre += g.sheet.position[v] / static_cast<Real>(loop.size()), normal += g.sheet.normal[v];
  const std::uint32_t c = g.sheet.add_node(centre, normalized(normal), NodeState::kInterior);
  SheetEdit fan;
  for (std::size_t i = 0; i < loop.size(); ++i) fan.add.push_back({loop[(i + 1) % loop.size()], loop[i], c});
  return g.sheet.apply(fan);
}

bool is_small(const Growth& g, const FrontLoop& loop) {
  if (loop.size() > kFillSize) return false;
  Box box;
  for (const std::uint32_t v : loop) box.grow(g.sheet.position[v]);
  return box.diagonal() < kFillDiameter * g.h;
}

// A loop that has shrunk to a small hole is the paper's separation by degeneration of a crack circle.
bool fill_small_loops(Growth& g) {
  bool changed = false;
  for (std::size_t l = 0; l < g.loops.size();) {
    const FrontLoop loop = g.loops[l];
    if (loop.size() >= 3 && (!is_small(g, loop) || all_dead(g, loop) || !fill(g, loop))) {
      ++l;
      continue;
    }
    for (const std::uint32_t v : loop) retire(g, v);
    g.loops.erase(g.loops.begin() + static_cast<std::ptrdiff_t>(l));
    changed = true;
  }
  return changed;
}

}  // namespace

bool merge_fronts(Growth& g) {
  bool changed = false;
  for (FrontLoop& loop : g.loops)
    for (std::size_t i = 0; i < loop.size();)
      if (close_ear(g, loop, i))
        changed = true, i = i > 0 ? i - 1 : 0;
      else
        ++i;
  constexpr int kMaxBridges = 64;  // a step; each is followed by ears that zip the fronts together
  for (int k = 0; k < kMaxBridges && bridge_nearest(g); ++k) changed = true;
  changed |= fill_small_loops(g);
  return changed;
}

}  // namespace sherd
