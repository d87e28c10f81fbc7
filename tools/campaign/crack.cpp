#include "tools/campaign/crack.h"

#include <algorithm>
#include <exception>

#include "engine/fracture/check_growth.h"
#include "engine/fracture/thicken.h"
#include "tools/campaign/cpu_clock.h"
#include "tools/campaign/hash.h"

namespace sherd::campaign {
namespace {

bool is_complete(const CrackSheet& sheet) {
  return std::none_of(sheet.state.begin(), sheet.state.end(),
                      [](NodeState s) { return s == NodeState::kArrested || s == NodeState::kBlocked; });
}

// The test of a rung: the sheet must become a slab, and the slab must cut the body. Keeps both.
std::string slab_and_cut(const Specimen& s, const GrowthOptions& options, Real min_fragment_volume,
                         const CrackSheet& sheet, Crack& crack) {
  const CpuStopwatch watch(crack.report.cut_s);
  std::string reason;
  auto slab = thicken(sheet, {.thickness = options.thickness, .field = options.thickness_field}, reason);
  if (!slab) return reason;
  CutOptions o;
  o.edge_length = options.edge_length, o.min_fragment_volume = min_fragment_volume, o.slab_checked = true;
  crack.slab = std::move(*slab);
  crack.cut = cut(s.body, crack.slab, o);
  if (!crack.cut.ok) return "the cut is refused: " + crack.cut.reason;
  return is_complete(sheet) && does_nothing(s.body, crack.cut, 0) ? "the crack is complete and separates nothing" : "";
}

// False when the seed opens no crack or all rungs failed.
bool grow_and_cut(const Specimen& s, const FunctionField& field, const CrackSeed& seed, const GrowthOptions& options,
                  Crack& crack) {
  CrackReport& r = crack.report;
  {
    const CpuStopwatch watch(r.grow_s);
    crack.growth = grow_crack(s.body.bvh(), field, seed, options);
  }
  r.grow_s -= r.cut_s;  // the cuts happen within the growth
  const GrowthResult& g = crack.growth;
  r.level = g.ladder_level, r.retreats = g.retreats, r.reason = g.reason, r.rungs = g.rungs, r.area = g.area;
  r.steps = static_cast<std::size_t>(g.steps), r.sheet_triangles = g.sheet.triangles.size();
  if (g.outcome == GrowthOutcome::kRejectedSeed) r.outcome = CrackOutcome::kRejected;
  if (g.outcome != GrowthOutcome::kComplete && g.outcome != GrowthOutcome::kArrested) {
    crack.cut = {};
    return false;
  }
  r.wings = g.wings.size();
  r.fragments = crack.cut.fragments.size(), r.jitters = crack.cut.jitters, r.touched = crack.cut.touched;
  r.removed_volume = crack.cut.removed_volume;
  return true;
}

void judge(const Specimen& s, const CrackField& field, const GrowthOptions& options, Real min_fragment_volume,
           Crack& crack) {
  CrackReport& r = crack.report;
  const bool through = crack.growth.outcome == GrowthOutcome::kComplete;
  r.outcome = !through              ? CrackOutcome::kArrested
              : crack.cut.separated ? CrackOutcome::kSeparated
                                    : CrackOutcome::kPierced;
  r.invalid = check_growth(crack.growth, s.body.bvh(), options);
  if (r.invalid.empty() && !(signed_volume(crack.slab) > 0)) r.invalid = "the slab's volume is not positive";
  if (r.invalid.empty()) r.invalid = check_cut_laws(s.body, crack.cut);
  // V2: in a body without handles whatever has its whole border outside separates.
  if (r.invalid.empty() && r.outcome == CrackOutcome::kPierced && s.simply_connected)
    r.invalid = "a complete crack does not separate a body without handles";
  if (r.invalid.empty() && r.outcome == CrackOutcome::kPierced && does_nothing(s.body, crack.cut, 0))
    r.invalid = "a complete crack neither separates nor leaves two walls";
  if (r.invalid.empty()) r.invalid = grow_wings(s, field, options, min_fragment_volume, crack);
  r.balance = balance_of(s.body, crack.cut);
}

std::uint64_t hash_of(const Crack& crack) {
  Hash hash;
  hash.add_number(static_cast<std::uint64_t>(crack.report.outcome));
  hash.add_number(static_cast<std::uint64_t>(crack.report.level));
  hash.add(crack.growth.sheet.position), hash.add(crack.growth.sheet.triangles);
  for (const SurfaceMesh& f : crack.cut.fragments) hash.add_number(campaign::hash_of(f));
  return hash.value();
}

}  // namespace

const char* to_string(CrackOutcome outcome) {
  switch (outcome) {
    case CrackOutcome::kSeparated:
      return "separated";
    case CrackOutcome::kPierced:
      return "pierced";
    case CrackOutcome::kArrested:
      return "arrested";
    case CrackOutcome::kRejected:
      return "rejected";
    case CrackOutcome::kDropped:
      return "dropped";
  }
  return "";
}

Crack run_crack(const Specimen& s, const FunctionField& field, const CrackSeed& seed, GrowthOptions options,
                Real min_fragment_volume) {
  Crack crack;
  options.accept = [&](const CrackSheet& sheet) { return slab_and_cut(s, options, min_fragment_volume, sheet, crack); };
  CrackReport& r = crack.report;
  const std::uint64_t before = campaign::hash_of(s.mesh());
  const std::size_t asked = field.evaluations;
  try {
    const bool accepted = grow_and_cut(s, field, seed, options, crack);
    r.stress_points = field.evaluations - asked;
    const CpuStopwatch watch(r.check_s);
    if (accepted) {
      judge(s, field, options, min_fragment_volume, crack);
      r.angle = mean_angle(crack.growth.sheet, s.body.bvh(), field);
    } else if (r.reason.empty()) {
      r.invalid = "refused without a reason";
    }
  } catch (const std::exception& e) {
    r.outcome = CrackOutcome::kDropped;
    r.invalid = std::string("threw: ") + e.what();
  }
  r.body_changed = campaign::hash_of(s.mesh()) != before;
  r.hash = hash_of(crack);
  return crack;
}

}  // namespace sherd::campaign
