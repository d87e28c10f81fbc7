#include "engine/fracture/front.h"

#include <algorithm>

#include "engine/fracture/seed.h"

namespace sherd {
namespace {

// Sub-step length in units of h: proportional to the stress (eq. 9), but never so short that rows degenerate (and the
// expensive field is asked more often than the mesh resolves) nor so long that a bend is missed.
constexpr Real kMinStep = 0.4, kMaxStep = 0.8;
constexpr Real kMinTurnCosine = 0.5;  // a crack turns by at most 60 degrees a step: eigenvectors swap at equal values
constexpr std::size_t kSteerLoopDistance = 5;
constexpr Real kWallRange = 2.5, kWallFull = 0.5;  // of h: older crack walls attract from here, and fully from here
// Of h: layers of the sheet keep at least this distance. Arms that meet out of line are then held edge to edge, where
// they can be joined, instead of one running over the other.
constexpr Real kMinClearance = 0.2, kLeastClearance = 0.02;  // the latter where nothing else goes on
constexpr Real kAheadFactor = 1.5;  // of h: paper 6.3 (b), smoothness: a node this far behind both neighbours follows

Real slab_clearance(const GrowthOptions& o) {
  return 1.1 * (o.thickness_field ? o.thickness_field->upper() : o.thickness);
}

Real clearance(const GrowthOptions& o, Real h) {
  return std::max(slab_clearance(o), 1.1 * kMinClearance * h);
}

Vec3 along(const Growth& g, std::uint32_t a, std::uint32_t b) {
  return g.sheet.position[b] - g.sheet.position[a];
}

// The unit crack normal at a node from the field's eigenvector.
Vec3 crack_normal(const Growth& g, const Vec3& eigenvector, const Vec3& previous) {
  if (!is_finite(eigenvector) || norm2(eigenvector) == 0) return previous;
  Vec3 e = normalized(canonical_sign(eigenvector));
  if (dot(e, previous) < 0) e = -e;
  const Vec3 blended =
      normalized((1 - g.blend) * e + g.blend * (dot(g.seed_normal, previous) < 0 ? -g.seed_normal : g.seed_normal));
  if (norm2(blended) > 0) e = blended;
  const Real cosine = dot(e, previous);
  if (cosine >= kMinTurnCosine) return e;
  const Vec3 side = normalized(e - cosine * previous);
  if (norm2(side) == 0) return previous;
  return normalized(kMinTurnCosine * previous + std::sqrt(1 - kMinTurnCosine * kMinTurnCosine) * side);
}

// Turns the crack at a node to its stress.
void turn(Growth& g, std::uint32_t v) {
  g.sheet.normal.set(v, crack_normal(g, g.sheet.stress[v].direction, g.sheet.normal[v]));
}

// The answers are of no use: see GrowthOptions::ask_everywhere.
void ask_all(Growth& g) {
  Vec3Column points;
  for (std::size_t v = 0; v < g.sheet.state.size(); ++v)
    if (g.sheet.state[v] != NodeState::kExited && g.body.inside(g.sheet.position[v]))
      points.push_back(g.sheet.position[v]);
  std::vector<PrincipalStress> unused;
  if (points.size() > 0) g.field.principal_stress(points, unused);
  g.stresses_asked += points.size();
}

void ask_field(Growth& g) {
  Vec3Column points, headings;
  FrontLoop nodes;
  for (const FrontLoop& loop : g.loops)
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t v = loop[i];
      const NodeState s = g.sheet.state[v];
      if ((s != NodeState::kActive && s != NodeState::kArrested) || g.sheet.stress_known[v]) continue;
      if (!g.body.inside(g.sheet.position[v])) {
        g.sheet.state[v] = NodeState::kActive;  // it exits when it is advanced
        continue;
      }
      nodes.push_back(v), points.push_back(g.sheet.position[v]);
      headings.push_back(
          outward_direction(g, loop[(i + loop.size() - 1) % loop.size()], v, loop[(i + 1) % loop.size()]));
    }
  g.stresses_asked += nodes.size();
  if (g.options.ask_everywhere) ask_all(g);
  std::size_t within = 0;
  for (const NodeState s : g.sheet.state) within += s != NodeState::kExited;
  g.stresses_spared += g.options.ask_everywhere ? 0 : within - nodes.size();
  if (nodes.empty()) return;
  std::vector<PrincipalStress> stress;
  g.field.stress_ahead(points, headings, stress);
  for (std::size_t i = 0; i < nodes.size() && i < stress.size(); ++i) {
    g.sheet.stress[nodes[i]] = stress[i], g.sheet.stress_known[nodes[i]] = 1;
    if (exceeds_strength(g, nodes[i])) turn(g, nodes[i]);
  }
}

bool lags_behind(const Growth& g, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const Vec3 to_a = along(g, b, a), to_c = along(g, b, c), o = outward_direction(g, a, b, c);
  if (dot(to_a, o) > kAheadFactor * g.h && dot(to_c, o) > kAheadFactor * g.h) return true;
  const bool notch = dot(cross(-to_a, to_c), g.sheet.normal[b]) < 0;
  return notch && dot(to_a, to_c) > 0.5 * norm(to_a) * norm(to_c);  // less than 60 degrees
}

Real step_length(const Growth& g, std::uint32_t v) {
  const Real relative = g.reference_stress > 0 ? g.sheet.stress[v].value / g.reference_stress : 1;
  return g.h * std::clamp(g.options.speed * relative, kMinStep, kMaxStep);
}

struct FrontNode {
  std::uint32_t node;
  std::size_t loop, place;
  Vec3 outward;
};

// A front has a line tension: it does not follow bends of the field sharper than the sheet resolves. Without this,
// fields that no surface can follow (not integrable) corrugate the front until the sheet folds.
void smooth_normals(Growth& g) {
  for (const FrontLoop& loop : g.loops)
    for (int pass = 0; pass < g.tension; ++pass) {
      std::vector<Vec3> normal(loop.size());
      const auto at = [&](std::size_t i) { return g.sheet.normal[loop[i % loop.size()]]; };
      for (std::size_t i = 0; i < loop.size(); ++i)
        normal[i] = normalized(at(i + loop.size() - 1) + 2.0 * at(i) + at(i + 1));
      for (std::size_t i = 0; i < loop.size(); ++i)
        if (g.sheet.state[loop[i]] == NodeState::kActive && norm2(normal[i]) > 0)
          g.sheet.normal.set(loop[i], normal[i]);
    }
}

// Does the way d lead through the body alone, but for its end?
bool in_sight(const Growth& g, const Vec3& from, const Vec3& d) {
  std::vector<TriangleBvh::Hit> hits;
  g.body.all_hits(from, d, 0, std::max(0.0, 1 - 2 * g.overshoot / norm(d)), hits);
  return hits.empty();
}

// The nearest front node that faces `a`, or nothing.
const FrontNode* facing_node(const Growth& g, const std::vector<FrontNode>& front, const FrontNode& a) {
  const FrontNode* best = nullptr;
  Real best2 = g.steer_range * g.steer_range * g.h * g.h;
  const Vec3 at = g.sheet.position[a.node];
  for (const FrontNode& w : front) {
    const Vec3 d = g.sheet.position[w.node] - at;
    const Real d2 = norm2(d);
    if (w.node == a.node || d2 >= best2 || d2 == 0) continue;
    if (w.loop == a.loop) {
      const std::size_t n = g.loops[a.loop].size(), apart = w.place > a.place ? w.place - a.place : a.place - w.place;
      if (std::min(apart, n - apart) < kSteerLoopDistance) continue;
    }
    const Real length = std::sqrt(d2);
    if (dot(a.outward, d) <= 0.3 * length || dot(w.outward, d) >= -0.2 * length) continue;
    if (dot(g.sheet.normal[a.node], g.sheet.normal[w.node]) <= 0) continue;
    if (is_exited(g, w.node) && !in_sight(g, at, d)) continue;
    best = &w, best2 = d2;
  }
  return best;
}

// Turns a node's way towards `target` by the weight, the crack plane with it.
bool bend(Growth& g, const FrontNode& a, const Vec3& target, Real weight, Advance& advance) {
  const Vec3 o = normalized((1 - weight) * advance.direction + weight * normalized(target - g.sheet.position[a.node]));
  const Vec3 n = g.sheet.normal[a.node], turned = normalized(n - dot(n, o) * o);
  if (norm2(o) == 0 || norm2(turned) == 0) return false;
  advance.direction = o;
  g.sheet.normal.set(a.node, turned);
  return true;
}

// A crack meets the wall of an older one at a right angle: no traction acts across it.
void steer_to_wall(Growth& g, const FrontNode& a, Advance& advance) {
  Vec3 wall;
  const Vec3 p = g.sheet.position[a.node];
  if (!g.options.obstacles || !g.options.obstacles->nearest_wall(p, kWallRange * g.h, wall)) return;
  const Real length = distance(p, wall);
  if (!(dot(a.outward, wall - p) > 0.3 * length)) return;
  bend(g, a, wall, std::clamp((kWallRange - length / g.h) / (kWallRange - kWallFull), 0.0, 1.0), advance);
}

// Without this, arms of one crack that run around a cavity pass each other and never close.
void steer(Growth& g, const FrontNode& a, const FrontNode& w, Advance& advance) {
  const Vec3 d = g.sheet.position[w.node] - g.sheet.position[a.node];
  const Real length = norm(d),
             weight = std::clamp(1 - (length - g.steer_full * g.h) / ((g.steer_range - g.steer_full) * g.h), 0.0, 1.0);
  if (!bend(g, a, g.sheet.position[w.node], weight, advance)) return;
  advance.length = std::min(advance.length, 0.45 * length);  // facing nodes never pass each other
  g.steered = true;
}

}  // namespace

Growth::Growth(const TriangleBvh& body_, const CrackField& field_, const GrowthOptions& options_, Real edge,
               Real overshoot_)
    : body(body_),
      field(field_),
      options(options_),
      h(edge),
      overshoot(overshoot_),
      sheet(edge, clearance(options, edge)) {}

void Growth::restart(const CrackSheet& from) {
  sheet = SheetMesh(h, clearance(options, h));
  sheet.load(from);
  loops = from.front.empty() ? border_loops(from) : from.front;
  clear.clear();
  relaxed = false;
}

Vec3 outward_direction(const Growth& g, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const Vec3 e = g.sheet.normal[b], before = normalized(along(g, a, b)), after = normalized(along(g, b, c));
  const Vec3 o = cross(before + after, e);
  if (norm2(o) > 1e-4) return normalized(o - dot(o, e) * e);
  // A spike (or a plane almost along the front): away from the neighbours, within the plane.
  const Vec3 away = before - after;
  return normalized(away - dot(away, e) * e);
}

bool is_clear(const Growth& g, std::uint32_t a, std::uint32_t b) {
  Growth::Clear& known = g.clear[static_cast<std::uint64_t>(a) << 32 | b];
  if (known.moves_a != g.sheet.moves[a] || known.moves_b != g.sheet.moves[b]) {
    std::vector<TriangleBvh::Hit> hits;
    g.body.all_hits(g.sheet.position[a], along(g, a, b), 0, 1, hits);
    known = {g.sheet.moves[a], g.sheet.moves[b], hits.empty()};
  }
  return known.clear;
}

bool is_dead(const Growth& g, std::uint32_t a, std::uint32_t b) {
  return is_exited(g, a) && is_exited(g, b) && is_clear(g, a, b);
}

bool exceeds_strength(const Growth& g, std::uint32_t v) {
  const ScalarField* field = g.options.propagation_field;
  return g.sheet.stress[v].value >= (field ? field->at(g.sheet.position[v]) : g.options.propagation_strength);
}

void label_front(Growth& g) {
  ask_field(g);
  for (const FrontLoop& loop : g.loops)
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t v = loop[i];
      NodeState& s = g.sheet.state[v];
      if ((s != NodeState::kActive && s != NodeState::kArrested) || !g.sheet.stress_known[v]) continue;
      const bool was_arrested = s == NodeState::kArrested;
      s = exceeds_strength(g, v) ? NodeState::kActive : NodeState::kArrested;
      if (s == NodeState::kArrested && was_arrested &&
          lags_behind(g, loop[(i + loop.size() - 1) % loop.size()], v, loop[(i + 1) % loop.size()])) {
        s = NodeState::kActive;
        turn(g, v);
      }
    }
}

void relax(Growth& g) {
  g.relaxed = true;
  g.sheet.set_clearance(std::max(slab_clearance(g.options), kLeastClearance * g.h));
  for (const FrontLoop& loop : g.loops)
    for (const std::uint32_t v : loop) {
      Vec3 sum;
      for (const std::uint32_t t : g.sheet.incident[v]) {
        const Triangle& n = g.sheet.triangles[t];
        sum += cross(along(g, n[0], n[1]), along(g, n[0], n[2]));
      }
      if (norm2(sum) > 0) g.sheet.normal.set(v, normalized(sum));
      if (g.sheet.state[v] != NodeState::kBlocked || g.sheet.met[v] != kNoCrack) continue;
      g.sheet.state[v] = NodeState::kActive, g.sheet.failures[v] = 0;
    }
}

std::vector<std::vector<Advance>> front_velocity(Growth& g) {
  smooth_normals(g);
  std::vector<FrontNode> front;
  std::vector<std::vector<Advance>> velocity(g.loops.size());
  for (std::size_t l = 0; l < g.loops.size(); ++l) {
    const FrontLoop& loop = g.loops[l];
    velocity[l].resize(loop.size());
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t v = loop[i];
      if (is_exited(g, v) && !g.to_borders) continue;
      const Vec3 o = outward_direction(g, loop[(i + loop.size() - 1) % loop.size()], v, loop[(i + 1) % loop.size()]);
      front.push_back({v, l, i, o});
      if (g.sheet.state[v] == NodeState::kActive && norm2(o) > 0) velocity[l][i] = {o, step_length(g, v)};
    }
  }
  for (const FrontNode& a : front) {
    Advance& advance = velocity[a.loop][a.place];
    if (!(advance.length > 0)) continue;
    if (const FrontNode* w = facing_node(g, front, a))
      steer(g, a, *w, advance);
    else
      steer_to_wall(g, a, advance);
  }
  return velocity;
}

}  // namespace sherd
