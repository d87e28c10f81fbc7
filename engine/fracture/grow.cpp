#include "engine/fracture/grow.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/fracture/advance.h"
#include "engine/fracture/seed.h"
#include "engine/fracture/thicken.h"

namespace sherd {
namespace {

// The retry ladder (O8): the crack normal is blended towards the seed's until the sheet closes; the last rung grows on
// a finer sheet.
struct Rung {
  Real blend, edge, overshoot;  // the last two in units of the options' own
};
constexpr Rung kLadder[] = {{0, 1, 1}, {0.5, 1, 1}, {0.8, 1, 1}, {1, 1, 1}, {1, 0.8, 2.0 / 3}};

Box box_of(const TriangleBvh& body) {
  Box box;
  for (std::uint32_t f = 0; f < body.triangle_count(); ++f)
    for (const Vec3& p : body.corners(f)) box.grow(p);
  return box;
}

std::string check_options(const TriangleBvh& body, const GrowthOptions& o) {
  if (body.triangle_count() == 0) return "the body has no triangles";
  if (!(o.edge_length > 0) || !std::isfinite(o.edge_length)) return "edge_length must be positive";
  if (!(o.overshoot > 0 && o.overshoot <= 1)) return "overshoot must lie in (0, 1]";
  if (!(o.speed > 0) || !std::isfinite(o.propagation_strength)) return "speed must be positive, strength finite";
  if (!(o.thickness >= 0) || !std::isfinite(o.thickness)) return "thickness must not be negative";
  if (box_of(body).diagonal() > 5e5 * o.edge_length) return "edge_length is too small for the body";
  return {};
}

int step_limit(const TriangleBvh& body, const GrowthOptions& o, Real h) {
  if (o.max_steps > 0) return o.max_steps;
  return static_cast<int>(std::min(4 * box_of(body).diagonal() / h, 1e6)) + 64;
}

bool any_node(const Growth& g, NodeState s) {
  for (const FrontLoop& loop : g.loops)
    for (const std::uint32_t v : loop)
      if (g.sheet.state[v] == s) return true;
  return false;
}

// A front whose greater part runs along another layer of its own sheet missed it and would spiral on: the arms of a
// crack behind a cavity can pass each other so. Ending the attempt at once saves asking for stress.
bool spirals(Growth& g) {
  constexpr Real kReach = 1.5;  // of h
  constexpr int kLeast = 6;
  int active = 0, layered = 0;
  for (const FrontLoop& loop : g.loops)
    for (const std::uint32_t v : loop)
      if (g.sheet.state[v] == NodeState::kActive) ++active, layered += g.sheet.has_layer(v, kReach * g.h);
  return layered >= kLeast && 2 * layered > active;
}

struct Progress {
  int steps = 0;
  bool ended = false;  // no active node is left
  bool spiral = false;
};

Progress propagate(Growth& g, int limit) {
  Progress p;
  for (; p.steps < limit; ++p.steps) {
    label_front(g);
    if (spirals(g)) {
      p.spiral = true;
      return p;
    }
    if (any_node(g, NodeState::kActive)) {
      advance_front(g, front_velocity(g));
    } else if (!remesh_front(g)) {
      p.ended = true;
      return p;
    }
    remesh_front(g);
  }
  return p;
}

// Interior nodes only and each move a transaction, so the front and the invariants stay.
void smooth_interior(Growth& g) {
  constexpr int kPasses = 3;
  for (int pass = 0; pass < kPasses; ++pass)
    for (std::uint32_t v = 0; v < g.sheet.state.size(); ++v) {
      if (g.sheet.state[v] != NodeState::kInterior || g.sheet.incident[v].empty()) continue;
      Vec3 mean{};
      const std::vector<std::uint32_t> ring = g.sheet.neighbours(v);
      for (const std::uint32_t w : ring) mean += g.sheet.position[w];
      g.sheet.move(v, 0.5 * (g.sheet.position[v] + mean / static_cast<Real>(ring.size())));
    }
}

void judge(const Growth& g, const Progress& progress, GrowthResult& result) {
  std::size_t live = 0;
  Vec3 place;
  for (const FrontLoop& loop : g.loops)
    for (std::size_t i = 0; i < loop.size(); ++i)
      if (!is_dead(g, loop[i], loop[(i + 1) % loop.size()]) && live++ == 0) place = g.sheet.position[loop[i]];
  result.outcome = GrowthOutcome::kFailed;
  const std::string where = fmt::format("near ({:.4g}, {:.4g}, {:.4g}) m", place.x, place.y, place.z);
  if (live == 0)
    result.outcome = GrowthOutcome::kComplete;
  else if (progress.spiral)
    result.reason = "the front runs along its own sheet " + where;
  else if (!progress.ended)
    result.reason = fmt::format("still growing after {} steps {}", progress.steps, where);
  else if (any_node(g, NodeState::kArrested))
    result.outcome = GrowthOutcome::kArrested;
  else if (any_node(g, NodeState::kBlocked))
    result.reason = "the front is blocked by its own sheet " + where;
  else
    result.reason = "the sheet's border still cuts the body " + where;
}

GrowthResult finish(Growth& g, const Progress& progress) {
  GrowthResult result;
  result.steps = progress.steps;
  judge(g, progress, result);
  if (result.outcome == GrowthOutcome::kFailed) return result;
  smooth_interior(g);
  result.sheet = g.sheet.extract();
  result.sheet.reference_stress = g.reference_stress;
  result.sheet.seed_normal = g.seed_normal;
  result.reason = check_sheet(result.sheet);
  if (result.reason.empty() && g.options.thickness > 0) thicken(result.sheet, g.options.thickness, 0, result.reason);
  if (result.reason.empty())
    result.area = area_inside(result.sheet, g.body);
  else
    result.outcome = GrowthOutcome::kFailed;
  return result;
}

// start(Growth&) lays the first sheet and returns the reason of a refusal.
template <class Start>
GrowthResult climb_ladder(const TriangleBvh& body, const CrackField& field, const GrowthOptions& options,
                          const Start& start) {
  GrowthResult result;
  result.reason = check_options(body, options);
  if (!result.reason.empty()) return result;
  std::string first_reason;
  for (int level = 0; level < static_cast<int>(std::size(kLadder)); ++level) {
    const Rung& rung = kLadder[level];
    const Real h = rung.edge * options.edge_length;
    Growth g(body, field, options, h, options.overshoot * options.edge_length * rung.overshoot);
    g.blend = rung.blend;
    if (std::string refusal = start(g); !refusal.empty()) {
      if (level > 0) continue;
      result.outcome = GrowthOutcome::kRejectedSeed;
      result.reason = std::move(refusal);
      return result;
    }
    result = finish(g, propagate(g, step_limit(body, options, h)));
    result.ladder_level = level;
    if (level == 0) first_reason = result.reason;
    result.reason = first_reason;
    if (result.outcome != GrowthOutcome::kFailed) break;
  }
  return result;
}

}  // namespace

GrowthResult grow_crack(const TriangleBvh& body, const CrackField& field, const CrackSeed& seed,
                        const GrowthOptions& options) {
  return climb_ladder(body, field, options, [&](Growth& g) { return open_seed(g, seed); });
}

GrowthResult resume_crack(const TriangleBvh& body, const CrackField& field, const CrackSheet& sheet,
                          const GrowthOptions& options) {
  const std::string bad = check_sheet(sheet);
  return climb_ladder(body, field, options, [&](Growth& g) -> std::string {
    if (!bad.empty()) return bad;
    g.sheet.load(sheet);
    g.loops = border_loops(sheet);
    if (g.loops.empty()) return "the sheet has no front";
    for (NodeState& s : g.sheet.state)
      if (s == NodeState::kBlocked) s = NodeState::kArrested;  // tried again under the new stress
    g.reference_stress = sheet.reference_stress;
    g.seed_normal = norm2(sheet.seed_normal) > 0 ? sheet.seed_normal : normalized(sheet.normal[0]);
    return {};
  });
}

}  // namespace sherd
