#include "engine/fracture/attempt.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/fracture/advance.h"
#include "engine/fracture/close_ring.h"
#include "engine/fracture/sheet_quality.h"
#include "engine/fracture/thicken.h"

namespace sherd {
namespace {

// The crack normal is blended towards the seed's until the sheet closes; the last rung grows on a finer sheet.
struct Rung {
  Real blend, edge, overshoot;  // the last two in units of the options' own
};
constexpr Rung kLadder[kRungCount] = {{0, 1, 1}, {0.5, 1, 1}, {0.8, 1, 1}, {1, 1, 1}, {1, 0.8, 2.0 / 3}};

// Steering deflects a crack from the field, so the far steering that brings badly aligned fronts together is only used
// where the near one failed; so is the tension that keeps a front from folding in a field rougher than the sheet.
struct Retreat {
  int steps;         // to take back
  Real range, full;  // of h: Growth::steer_range, steer_full
  int tension;       // Growth::tension
};
constexpr Retreat kRetreats[] = {{12, 16, 6, 1}, {24, 16, 6, 1}, {24, 16, 6, 6}, {1 << 20, 24, 9, 6}};
constexpr int kSaveEvery = 3;  // steps
constexpr std::size_t kMaxRings = 3;

bool any_node(const Growth& g, NodeState s) {
  for (const FrontLoop& loop : g.loops)
    for (const std::uint32_t v : loop)
      if (g.sheet.state[v] == s) return true;
  return false;
}

// Does stress drive any node on? (A node that only follows its neighbours does not count.)
bool is_driven(const Growth& g) {
  for (const FrontLoop& loop : g.loops)
    for (const std::uint32_t v : loop)
      if (g.sheet.state[v] == NodeState::kActive && g.sheet.stress_known[v] && exceeds_strength(g, v)) return true;
  return false;
}

// A front whose greater part runs along another layer of its own sheet missed it and would spiral on: the arms of a
// crack behind a cavity can pass each other so. Ending the attempt at once saves asking for stress.
struct Layering {
  int active = 0, layered = 0;  // nodes; the latter have a layer of the sheet near them
  bool spirals() const {
    constexpr int kLeast = 6;
    return layered >= kLeast && 2 * layered > active;
  }
};
Layering layering(Growth& g) {
  constexpr Real kReach = 1.5;  // of h
  Layering n;
  for (const FrontLoop& loop : g.loops)
    for (const std::uint32_t v : loop)
      if (g.sheet.state[v] == NodeState::kActive) ++n.active, n.layered += g.sheet.has_layer(v, kReach * g.h);
  return n;
}

Real edge_of(const GrowthOptions& o, int level) {
  return kLadder[level].edge * o.edge_length;
}

int step_limit(const TriangleBvh& body, const GrowthOptions& o, Real h) {
  if (o.max_steps > 0) return o.max_steps;
  return static_cast<int>(std::min(4 * body.box().diagonal() / h, 1e6)) + 64;
}

}  // namespace

std::string check_options(const TriangleBvh& body, const GrowthOptions& o) {
  if (body.triangle_count() == 0) return "the body has no triangles";
  if (!(o.edge_length > 0) || !std::isfinite(o.edge_length)) return "edge_length must be positive";
  if (!(o.overshoot > 0 && o.overshoot <= 1)) return "overshoot must lie in (0, 1]";
  if (!(o.speed > 0) || !std::isfinite(o.propagation_strength)) return "speed must be positive, strength finite";
  if (!(o.thickness >= 0) || !std::isfinite(o.thickness)) return "thickness must not be negative";
  if (o.thickness_field && !(o.thickness_field->lower() > 0 && std::isfinite(o.thickness_field->upper())))
    return "the thickness field must be positive";
  if (body.box().diagonal() > 5e5 * o.edge_length) return "edge_length is too small for the body";
  return {};
}

std::string open_sheet(Growth& g, const CrackSheet& sheet) {
  g.restart(sheet);
  if (g.loops.empty()) return "the sheet has no front";
  for (NodeState& s : g.sheet.state)
    if (s == NodeState::kBlocked) s = NodeState::kArrested;  // tried again under the new stress
  g.reference_stress = sheet.reference_stress;
  g.seed_normal = norm2(sheet.seed_normal) > 0 ? sheet.seed_normal : normalized(sheet.normal[0]);
  return {};
}

Attempt::Attempt(const TriangleBvh& body, const CrackField& field, const GrowthOptions& options, int level)
    : growth_(body, field, options, edge_of(options, level),
              options.overshoot * options.edge_length * kLadder[level].overshoot),
      level_(level),
      limit_(step_limit(body, options, edge_of(options, level))) {
  growth_.blend = kLadder[level].blend;
}

bool Attempt::step() {
  Growth& g = growth_;
  if (ended_ || spiral_ || steps_ >= limit_) return false;
  if (level_ == 0 && steps_ % kSaveEvery == 0) history_.push_back({steps_, wings_.size(), extract()});
  label_front(g);
  if (is_driven(g))
    stopped_.reset();
  else if (!stopped_)
    stopped_ = std::make_shared<CrackSheet>(extract());
  const Layering n = layering(g);
  if (!missed_ && (n.layered > 0 || any_node(g, NodeState::kBlocked))) missed_ = steps_;
  spiral_ = n.spirals();
  if (spiral_) return false;
  if (any_node(g, NodeState::kActive)) {
    advance_front(g, front_velocity(g));
  } else if (!remesh_front(g)) {
    if (g.relaxed || !any_node(g, NodeState::kBlocked)) {
      ended_ = true;
      return false;
    }
    relax(g);
  }
  remesh_front(g);
  ++steps_;
  return true;
}

void Attempt::go_on(const CrackSheet& sheet) {
  growth_.restart(sheet);
  ended_ = spiral_ = false;
  missed_.reset();
  stopped_.reset();
}

bool Attempt::close_ring() {
  if (level_ > 0 || rings_ == kMaxRings) return false;
  std::optional<Ring> ring = sherd::close_ring(growth_);
  if (!ring) return false;
  ++rings_;
  std::move(ring->wings.begin(), ring->wings.end(), std::back_inserter(wings_));
  go_on(ring->sheet);
  return true;
}

bool Attempt::retreat() {
  const bool missed = spiral_ || !ended_ || missed_ || any_node(growth_, NodeState::kBlocked);
  if (!(missed || growth_.steered) || history_.empty()) return false;
  if (close_ring()) return true;
  const Retreat* r = nullptr;
  do {
    if (widened_ == std::size(kRetreats)) return false;
    r = &kRetreats[widened_++];
    while (history_.size() > 1 && history_.back().step > missed_.value_or(steps_) - r->steps) history_.pop_back();
  } while (from_ == std::tuple(history_.back().step, r->range, r->tension));  // would end as the last one did
  from_ = std::tuple(history_.back().step, r->range, r->tension);
  const Saved saved = history_.back();
  history_.pop_back();  // step() saves it again
  wings_.resize(saved.wings);
  growth_.to_borders = true;
  growth_.steer_range = r->range, growth_.steer_full = r->full, growth_.tension = r->tension;
  steps_ = saved.step;
  go_on(saved.sheet);
  return true;
}

std::vector<std::int32_t> Attempt::cracks_met() const {
  std::vector<std::int32_t> met;
  for (const FrontLoop& loop : growth_.loops)
    for (const std::uint32_t v : loop)
      if (growth_.sheet.state[v] == NodeState::kBlocked && growth_.sheet.met[v] != kNoCrack)
        met.push_back(growth_.sheet.met[v]);
  std::sort(met.begin(), met.end());
  met.erase(std::unique(met.begin(), met.end()), met.end());
  return met;
}

void Attempt::judge(GrowthResult& result) const {
  const Growth& g = growth_;
  result.met = cracks_met();
  std::size_t live = 0;
  Vec3 place;
  for (const FrontLoop& loop : g.loops)
    for (std::size_t i = 0; i < loop.size(); ++i)
      if (!is_dead(g, loop[i], loop[(i + 1) % loop.size()]) && live++ == 0) place = g.sheet.position[loop[i]];
  result.outcome = GrowthOutcome::kFailed;
  const std::string where = fmt::format("near ({:.4g}, {:.4g}, {:.4g}) m", place.x, place.y, place.z);
  if (live == 0)
    result.outcome = GrowthOutcome::kComplete;
  else if (spiral_)
    result.reason = "the front runs along its own sheet " + where;
  else if (!ended_)
    result.reason = fmt::format("still growing after {} steps {}", steps_, where);
  else if (any_node(g, NodeState::kArrested) || !result.met.empty())
    result.outcome = GrowthOutcome::kArrested;
  else if (any_node(g, NodeState::kBlocked))
    result.reason = "the front is blocked by its own sheet " + where;
  else
    result.reason = "the sheet's border still cuts the body " + where;
}

std::string Attempt::test(const CrackSheet& sheet) const {
  // Every edit kept the sheet from meeting itself; its slab, tested next, would meet itself too.
  std::string reason = check_topology(sheet);
  if (!reason.empty()) return reason;
  const GrowthOptions& o = growth_.options;
  if (o.accept) return o.accept(sheet);
  if (o.thickness > 0 || o.thickness_field) thicken(sheet, {o.thickness, o.thickness_field}, reason);
  return reason;
}

CrackSheet Attempt::extract() const {
  CrackSheet sheet = growth_.sheet.extract(growth_.loops);
  sheet.reference_stress = growth_.reference_stress;
  sheet.seed_normal = growth_.seed_normal;
  return sheet;
}

GrowthResult Attempt::finish() {
  Growth& g = growth_;
  GrowthResult result;
  result.steps = steps_;
  result.ladder_level = level_;
  result.retreats = static_cast<int>(widened_ + rings_);
  judge(result);
  if (result.outcome == GrowthOutcome::kFailed) return result;
  improve_inside(g.sheet);
  result.sheet = extract();
  if (result.outcome == GrowthOutcome::kArrested) result.sheet.stopped = stopped_;
  result.wings = wings_;
  result.reason = test(result.sheet);
  if (!result.reason.empty()) {
    result.outcome = GrowthOutcome::kFailed;
    result.sheet = {}, result.wings.clear();
    return result;
  }
  const SheetExtent extent = extent_inside(result.sheet, g.body);
  result.area = extent.area, result.length = extent.trace;
  return result;
}

}  // namespace sherd
