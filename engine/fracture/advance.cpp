#include "engine/fracture/advance.h"

#include <algorithm>
#include <optional>

namespace sherd {
namespace {

constexpr Real kHitMargin = 0.35;    // of h: a surface this close beyond the step is reached in this step
constexpr Real kLookAhead = 4.0;     // of h: how far the ray looks for the other side of a gap
constexpr Real kMinRow = 0.3;        // of h: shorter ways move the node instead of adding a row
constexpr Real kMinDistance = 0.95;  // of the overshoot: close enough to it
constexpr Real kBehind = 0.05;       // of h
constexpr Real kGiveWay = 0.5;       // of h: nearer to a stronger crack in its own plane a crack stops
constexpr int kPushes = 4;
constexpr int kMaxRefusals = 3;
constexpr std::uint32_t kMaxMoves = 30;  // of a node that never gets a row ahead: it goes to and fro

struct Target {
  Vec3 point;
  NodeState state = NodeState::kActive;
  std::int32_t met = kNoCrack;
};

// Where another crack stops the way from p; nothing beyond `reach` counts.
std::optional<Target> find_junction(const Growth& g, const Vec3& p, const Vec3& normal, const Advance& a, Real reach) {
  // From a little behind, so that a node that lies on the other crack stays there.
  const Vec3 from = p - kBehind * g.h * a.direction;
  const Real length = reach + kBehind * g.h;
  std::optional<Target> nearest;
  Real least = length;
  const auto meet = [&](Real t, std::int32_t crack) {
    if (nearest && t >= least) return;
    least = t;
    nearest = {p + std::max(t - kBehind * g.h, 0.0) * a.direction, NodeState::kBlocked, crack};
  };
  Obstacles::Hit hit;
  if (g.options.obstacles && g.options.obstacles->first_hit(from, a.direction, length, normal, hit))
    meet(hit.t, hit.crack);
  for (const Rival& rival : g.rivals) {
    Real t = 0;
    if (rival.sheet->first_hit(from, a.direction, length, normal, t)) meet(t, rival.crack);
    if (rival.stronger && rival.sheet->passes(p + a.length * a.direction, kGiveWay * g.h, normal))
      meet(kBehind * g.h, rival.crack);
  }
  return nearest;
}

Target find_target(const Growth& g, const Vec3& p, const Vec3& normal, const Advance& a) {
  std::vector<TriangleBvh::Hit> hits;
  g.body.all_hits(p, a.direction, 0, a.length + kLookAhead * g.h, hits);
  const Real reach = a.length + kHitMargin * g.h;
  if (g.options.obstacles || !g.rivals.empty())
    if (const auto junction = find_junction(g, p, normal, a, hits.empty() ? reach : std::min(reach, hits.front().t)))
      return *junction;
  if (hits.empty() || hits.front().t > reach) return {p + a.length * a.direction};
  const Real gap = hits.size() > 1 ? hits[1].t - hits[0].t : 2 * g.overshoot;
  const Vec3 q = p + (hits[0].t + std::min(g.overshoot, 0.5 * gap)) * a.direction;
  return {gap < 2 * g.overshoot ? q : push_out(g, q, normal), NodeState::kExited};
}

// The strip at node i: the triangles that join its way p -> q to its loop neighbours.
bool add_row(Growth& g, FrontLoop& loop, std::size_t i, const Vec3& q, NodeState state) {
  const std::uint32_t p = loop[i], before = loop[(i + loop.size() - 1) % loop.size()],
                      after = loop[(i + 1) % loop.size()];
  const std::uint32_t node = g.sheet.add_node(q, g.sheet.normal[p], state);
  if (!g.sheet.add({Triangle{before, node, p}, Triangle{p, node, after}})) return false;
  g.sheet.state[p] = NodeState::kInterior;
  loop[i] = node;
  return true;
}

bool place(Growth& g, FrontLoop& loop, std::size_t i, const Target& target) {
  const std::uint32_t p = loop[i];
  const Real way = distance(g.sheet.position[p], target.point);
  if (way >= kMinRow * g.h) {
    if (!add_row(g, loop, i, target.point, target.state)) return false;
  } else {
    if (way > 0 && !g.sheet.move(p, target.point)) return false;
    g.sheet.state[p] = target.state;
  }
  g.sheet.met[loop[i]] = target.met;
  return true;
}

}  // namespace

Vec3 push_out(const Growth& g, Vec3 q, const Vec3& normal) {
  std::vector<TriangleBvh::Hit> hits;
  for (int k = 0; k < kPushes; ++k) {
    const TriangleBvh::Closest c = g.body.closest(q);
    if (c.face == kNone) return q;
    const Real distance = std::sqrt(c.distance2);
    const bool inside = g.body.inside(q);
    if (!inside && distance >= kMinDistance * g.overshoot) return q;
    const auto& t = g.body.corners(c.face);
    const Vec3 face_normal = normalized(cross(t[1] - t[0], t[2] - t[0]));
    Vec3 away = inside ? c.point - q : q - c.point;
    if (norm2(away) < 1e-24 * g.h * g.h) away = face_normal;  // on the surface
    const Vec3 direction = normalized(away - dot(away, normal) * normal);
    if (norm2(direction) == 0) return q;
    // The distance to the surface is made up along `direction`; the divisor is bounded for grazing planes.
    const Real signed_distance = inside ? -distance : distance;
    const Real need = (g.overshoot - signed_distance) / std::max(0.3, std::abs(dot(direction, face_normal)));
    g.body.all_hits(q, direction, 0, need + g.overshoot, hits);
    const std::size_t exit = inside ? 1 : 0;  // an inside point first crosses its own surface
    if (hits.size() > exit) {
      const Real from = inside ? hits[0].t : 0;
      return q + 0.5 * (from + hits[exit].t) * direction;
    }
    q += need * direction;
  }
  return q;
}

bool advance_node(Growth& g, FrontLoop& loop, std::size_t i, const Advance& a) {
  const std::uint32_t p = loop[i];
  const Vec3 at = g.sheet.position[p], normal = g.sheet.normal[p];
  if (!g.body.inside(at)) {  // grazing: smoothing or a bend of the surface put it outside already
    g.sheet.state[p] = NodeState::kExited;
    g.sheet.move(p, push_out(g, at, normal));
    return true;
  }
  if (!(a.length > 0)) return false;
  const Target target = find_target(g, at, normal, a);
  if (place(g, loop, i, target)) return true;
  const Target half = find_target(g, at, normal, {a.direction, 0.5 * a.length});
  if (place(g, loop, i, half)) return true;
  // At a sharp edge of the body the sheet may leave room for less than the overshoot.
  if (target.state != NodeState::kExited) return false;
  std::vector<TriangleBvh::Hit> hits;
  g.body.all_hits(at, a.direction, 0, a.length + kHitMargin * g.h, hits);
  if (hits.empty()) return false;
  const Real room = std::min(g.overshoot, hits.size() > 1 ? 0.5 * (hits[1].t - hits[0].t) : g.overshoot);
  const auto just_out = [&](Real part) {
    return place(g, loop, i, {at + (hits[0].t + part * room) * a.direction, NodeState::kExited});
  };
  return just_out(0.5) || just_out(0.2);
}

int advance_front(Growth& g, const std::vector<std::vector<Advance>>& velocity) {
  int moved = 0;
  for (std::size_t l = 0; l < g.loops.size(); ++l)
    for (std::size_t i = 0; i < g.loops[l].size(); ++i) {
      const Advance& a = velocity[l][i];
      const std::uint32_t p = g.loops[l][i];
      if (g.sheet.state[p] != NodeState::kActive) continue;
      if (g.sheet.moves[p] > kMaxMoves)
        g.sheet.state[p] = NodeState::kBlocked;
      else if (advance_node(g, g.loops[l], i, a))
        g.sheet.failures[g.loops[l][i]] = 0, ++moved;
      else if (++g.sheet.failures[p] >= kMaxRefusals)
        g.sheet.state[p] = NodeState::kBlocked;
    }
  return moved;
}

}  // namespace sherd
