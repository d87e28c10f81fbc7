// O6: the paper's Local_Remeshing and Crack_Line_Smoothing on the front, with the coverage rule.
#include <algorithm>

#include "engine/fracture/advance.h"
#include "engine/fracture/front.h"

namespace sherd {
namespace {

constexpr Real kSplit = 1.4, kCollapse = 0.45, kCover = 0.05;  // of h
constexpr Real kSmooth = 0.2;        // weight of the crack line smoothing within the crack plane
constexpr Real kSmoothAcross = 0.5;  // and across it: waves of 8 h lose 15 % a step, of 40 h less than 1 %
constexpr int kPasses = 2;
constexpr int kMaxPushes = 4;

// Replaces the border triangle at a -> b by two with a node at `at` between them; kNone when it does not fit.
std::uint32_t split_border_edge(Growth& g, std::uint32_t a, std::uint32_t b, const Vec3& at, NodeState state) {
  const std::uint32_t t = g.sheet.triangle_at(a, b);
  if (t == kNone) return kNone;
  const Triangle n = g.sheet.triangles[t];
  const std::uint32_t c = n[0] + n[1] + n[2] - a - b;
  const std::uint32_t m = g.sheet.add_node(at, normalized(g.sheet.normal[a] + g.sheet.normal[b]), state);
  return g.sheet.apply({{t}, {{a, m, c}, {m, b, c}}, kNone, {}}) ? m : kNone;
}

// Exited nodes that stayed too near the surface, because the sheet was in the way when they left, try again. Not for
// ever: where the crack plane grazes the surface each push may end as near to it as the last.
bool push_again(Growth& g, std::uint32_t v) {
  if (g.sheet.pushes[v] == kMaxPushes) return false;
  const Vec3 p = g.sheet.position[v], way = push_out(g, p, g.sheet.normal[v]) - p;
  if (norm(way) < 1e-2 * g.h) return false;
  ++g.sheet.pushes[v];
  return g.sheet.move(v, p + way) || g.sheet.move(v, p + 0.5 * way);
}

// The coverage rule makes corners, sharp edges and concavities separate: a front edge between two exited nodes that
// still cuts through the body is refined and pushed on until the border lies wholly outside.
bool split_edge(Growth& g, FrontLoop& loop, std::size_t i) {
  const std::uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
  const Vec3 pa = g.sheet.position[a], pb = g.sheet.position[b], middle = 0.5 * (pa + pb);
  const Real length = distance(pa, pb);
  const bool exited = is_exited(g, a) && is_exited(g, b);
  if (exited ? is_clear(g, a, b) : !(length > kSplit * g.h)) return false;
  if (exited && (push_again(g, a) || push_again(g, b))) return true;
  if (exited && !(length > kCover * g.h)) return false;
  const bool outside = !g.body.inside(middle);
  NodeState state = NodeState::kActive;
  std::uint32_t m = kNone;
  if (outside) {
    state = NodeState::kExited;
    const Vec3 way = push_out(g, middle, normalized(g.sheet.normal[a] + g.sheet.normal[b])) - middle;
    for (Real part = 1; part > 0.2 && m == kNone; part *= 0.5)
      m = split_border_edge(g, a, b, middle + part * way, state);
  } else if (g.sheet.state[a] == g.sheet.state[b] && g.sheet.state[a] == NodeState::kBlocked) {
    state = NodeState::kBlocked;
  }
  if (m == kNone) m = split_border_edge(g, a, b, middle, state);
  if (m == kNone) return false;
  if (state == NodeState::kBlocked) g.sheet.met[m] = g.sheet.met[a];
  const std::size_t at = i + 1;
  loop.insert(loop.begin() + static_cast<std::ptrdiff_t>(at), m);
  if (exited && !outside && length < g.h) {
    const Vec3 o = outward_direction(g, a, m, b);
    if (norm2(o) > 0) advance_node(g, loop, at, {o, 0.5 * g.h});
  }
  return true;
}

bool collapse_edge(Growth& g, FrontLoop& loop, std::size_t i) {
  const std::uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
  if (loop.size() <= 4 || is_exited(g, a) || is_exited(g, b)) return false;
  if (!(distance(g.sheet.position[a], g.sheet.position[b]) < kCollapse * g.h)) return false;
  // Link condition of a border edge: the nodes have one common neighbour, the tip of the triangle that vanishes.
  const std::vector<std::uint32_t> na = g.sheet.neighbours(a), nb = g.sheet.neighbours(b);
  std::vector<std::uint32_t> common;
  std::set_intersection(na.begin(), na.end(), nb.begin(), nb.end(), std::back_inserter(common));
  const std::uint32_t t = g.sheet.triangle_at(a, b);
  if (common.size() != 1 || t == kNone) return false;
  SheetEdit edit{{}, {}, a, 0.5 * (g.sheet.position[a] + g.sheet.position[b])};
  for (const std::uint32_t u : g.sheet.incident[b]) {
    edit.remove.push_back(u);
    if (u == t) continue;
    Triangle n = g.sheet.triangles[u];
    std::replace(n.begin(), n.end(), b, a);
    edit.add.push_back(n);
  }
  // The tip must not lose its last triangle's neighbours: with no triangle left at a the front would be torn.
  if (edit.add.empty() && g.sheet.incident[a].size() == 1) return false;
  if (!g.sheet.apply(edit)) return false;
  g.sheet.normal.set(a, normalized(g.sheet.normal[a] + g.sheet.normal[b]));
  if (g.sheet.state[b] == NodeState::kActive) g.sheet.state[a] = NodeState::kActive;
  g.sheet.state[b] = NodeState::kInterior;
  loop.erase(loop.begin() + static_cast<std::ptrdiff_t>((i + 1) % loop.size()));
  return true;
}

bool split_and_collapse(Growth& g, FrontLoop& loop) {
  bool changed = false;
  for (std::size_t i = 0; i < loop.size(); ++i)
    if (split_edge(g, loop, i)) changed = true, ++i;  // the halves wait for the next pass
  for (std::size_t i = 0; i < loop.size(); ++i) changed |= collapse_edge(g, loop, i);
  return changed;
}

void smooth(Growth& g, const FrontLoop& loop) {
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const std::uint32_t v = loop[i];
    if (g.sheet.state[v] != NodeState::kActive) continue;
    const Vec3 a = g.sheet.position[loop[(i + loop.size() - 1) % loop.size()]], p = g.sheet.position[v],
               b = g.sheet.position[loop[(i + 1) % loop.size()]];
    const Vec3 way = 0.5 * (a + b) - p, n = g.sheet.normal[v];
    g.sheet.move(v, p + kSmooth * way + (kSmoothAcross - kSmooth) * dot(way, n) * n);
  }
}

}  // namespace

bool remesh_front(Growth& g) {
  bool changed = false;
  for (int pass = 0; pass < kPasses; ++pass) {
    bool now = false;
    for (FrontLoop& loop : g.loops) now |= split_and_collapse(g, loop);
    now |= merge_fronts(g);
    if (!now) break;
    changed = true;
  }
  for (const FrontLoop& loop : g.loops) smooth(g, loop);
  return changed;
}

}  // namespace sherd
