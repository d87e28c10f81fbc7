#include "engine/fracture/close_ring.h"

#include <algorithm>
#include <numeric>

namespace sherd {
namespace {

constexpr Real kReach = 1.5;              // of h: a front this near a flank runs along it
constexpr Real kGap = 2.2;                // of h: between a front and the edge of the flank that it is to meet
constexpr int kOwn = 12;                  // rings of triangles behind a front that are its own arm
constexpr std::size_t kLeastWing = 8;     // triangles
constexpr std::uint32_t kParted = kNone;  // the part of nodes where the flank is opened

bool runs_along(Growth& g, std::uint32_t v) {
  const NodeState s = g.sheet.state[v];
  return (s == NodeState::kActive || s == NodeState::kBlocked) && g.sheet.has_layer(v, kReach * g.h);
}

// Numbers in `shown` of the nodes of all fronts that run along the sheet, from one exit to the next, both included.
std::vector<std::uint32_t> layered_fronts(Growth& g, const CrackSheet& shown) {
  std::vector<std::uint32_t> out;
  for (std::size_t l = 0; l < g.loops.size(); ++l) {
    const FrontLoop& loop = g.loops[l];
    const std::size_t n = loop.size();
    std::size_t first = 0;
    while (first < n && !is_exited(g, loop[first])) ++first;
    const auto is_front = [&](std::size_t i) { return first == n || !is_exited(g, loop[(first + i) % n]); };
    for (std::size_t i = 0, end = 0; i < n; i = end + 1) {
      bool layered = false;
      for (end = i; end < n && is_front(end); ++end) layered = layered || runs_along(g, loop[(first + end) % n]);
      if (!layered) continue;
      for (std::size_t k = i + n - 1; k <= end + n; ++k) out.push_back(shown.front[l][(first + k) % n]);
    }
  }
  return out;
}

// Nodes no farther than kOwn rings of triangles from the fronts.
std::vector<std::uint8_t> own_arms(const CrackSheet& s, const std::vector<std::uint32_t>& fronts) {
  std::vector<std::uint8_t> own(s.state.size(), 0), next;
  for (const std::uint32_t v : fronts) own[v] = 1;
  for (int ring = 0; ring < kOwn; ++ring) {
    next = own;
    for (const Triangle& t : s.triangles)
      if (own[t[0]] || own[t[1]] || own[t[2]]) next[t[0]] = next[t[1]] = next[t[2]] = 1;
    own.swap(next);
  }
  return own;
}

bool is_whole(const Triangle& t, const std::vector<std::uint32_t>& part) {
  return part[t[0]] != kParted && part[t[1]] != kParted && part[t[2]] != kParted;
}

// For each node the smallest one it is joined to by triangles that stay, or kParted.
std::vector<std::uint32_t> parts_of(const CrackSheet& s, const std::vector<std::uint32_t>& fronts, Real gap) {
  const std::vector<std::uint8_t> own = own_arms(s, fronts);
  std::vector<std::uint32_t> part(s.state.size());
  std::iota(part.begin(), part.end(), 0u);
  for (std::size_t v = 0; v < part.size(); ++v)
    if (!own[v] && std::any_of(fronts.begin(), fronts.end(),
                               [&](std::uint32_t f) { return distance2(s.position[v], s.position[f]) < gap * gap; }))
      part[v] = kParted;
  const auto root = [&](std::uint32_t v) {
    while (part[v] != v) v = part[v] = part[part[v]];
    return v;
  };
  for (const Triangle& t : s.triangles) {
    if (!is_whole(t, part)) continue;
    const std::uint32_t a = root(t[0]), b = root(t[1]), c = root(t[2]), least = std::min({a, b, c});
    part[a] = part[b] = part[c] = least;
  }
  for (std::uint32_t v = 0; v < part.size(); ++v)
    if (part[v] != kParted) part[v] = root(v);
  return part;
}

// The triangles of one part. Where it was parted its border is `border` inside of the body, and exited outside.
CrackSheet take(const Growth& g, const CrackSheet& s, const std::vector<std::uint32_t>& part,
                const std::vector<std::uint8_t>& wanted, NodeState border) {
  CrackSheet out;
  out.reference_stress = g.reference_stress, out.seed_normal = g.seed_normal;
  std::vector<std::uint32_t> map(s.state.size(), kNone);
  for (Triangle t : s.triangles) {
    if (!is_whole(t, part) || !wanted[part[t[0]]]) continue;
    for (std::uint32_t& v : t) {
      if (map[v] == kNone) {
        map[v] = static_cast<std::uint32_t>(out.state.size());
        out.position.push_back(s.position[v]), out.normal.push_back(s.normal[v]), out.state.push_back(s.state[v]);
      }
      v = map[v];
    }
    out.triangles.push_back(t);
  }
  out.front = border_loops(out);
  for (const std::vector<std::uint32_t>& loop : out.front)
    for (const std::uint32_t v : loop)
      if (out.state[v] == NodeState::kInterior || out.state[v] == NodeState::kBlocked)
        out.state[v] = g.body.inside(out.position[v]) ? border : NodeState::kExited;
  return out;
}

}  // namespace

std::optional<Ring> close_ring(Growth& g) {
  const CrackSheet s = g.sheet.extract(g.loops);
  const std::vector<std::uint32_t> fronts = layered_fronts(g, s);
  if (fronts.empty()) return std::nullopt;
  const std::vector<std::uint32_t> part = parts_of(s, fronts, kGap * g.h);
  std::vector<std::uint8_t> wanted(part.size(), 0);
  for (const std::uint32_t f : fronts) wanted[part[f]] = 1;
  Ring ring;
  ring.sheet = take(g, s, part, wanted, NodeState::kActive);
  if (!check_topology(ring.sheet).empty()) return std::nullopt;
  bool parted = false;
  for (std::uint32_t v = 0; v < part.size(); ++v) {
    if (part[v] != v || wanted[v]) continue;
    std::vector<std::uint8_t> alone(part.size(), 0);
    alone[v] = 1;
    CrackSheet wing = take(g, s, part, alone, NodeState::kArrested);
    parted = parted || !wing.triangles.empty();
    if (wing.triangles.size() >= kLeastWing && check_topology(wing).empty()) ring.wings.push_back(std::move(wing));
  }
  return parted ? std::optional(std::move(ring)) : std::nullopt;
}

}  // namespace sherd
