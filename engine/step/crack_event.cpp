#include "engine/step/crack_event.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/fracture/net_section.h"
#include "engine/fracture/thicken.h"
#include "engine/step/refit_piece.h"
#include "engine/step/stopwatch.h"
#include "kernels/core/fault.h"

namespace sherd {
namespace {

constexpr int kTriesPerCrack = 4;

Real node_distance2(const CrackSheet& sheet, const Vec3& x) {
  Real best = 1e300;
  for (std::size_t i = 0; i < sheet.position.size(); ++i) best = std::min(best, distance2(sheet.position[i], x));
  return best;
}

bool touches(const CrackSheet& sheet, const TriangleBvh& body) {
  for (std::size_t i = 0; i < sheet.position.size(); ++i)
    if (sheet.state[i] != NodeState::kExited && body.inside(sheet.position[i])) return true;
  return false;
}

bool is_complete(const CrackSheet& sheet) {
  const auto waits = [](NodeState s) { return s == NodeState::kArrested || s == NodeState::kBlocked; };
  return std::none_of(sheet.state.begin(), sheet.state.end(), waits);
}

std::string refusal_off(const CrackSheet& sheet, const Guide& guide) {
  const Real off = deviation(sheet, guide).largest / guide.edge_length();
  return off > kOffGuide ? fmt::format("it leaves its guide by {:.2g} edges", off) : std::string();
}

// Runs `work`, which changes nothing before it has succeeded. False with the reason when it threw: a broken invariant,
// an input no sheet can be made of, memory; the run goes on without this crack.
template <class Work>
bool guarded(std::string& reason, const Work& work) {
  try {
    work();
    return true;
  } catch (const std::exception& e) {
    reason = e.what();
    return false;
  }
}

}  // namespace

CrackEvent::CrackEvent(Solid& solid, const FractureOptions& options, FractureResult& result)
    : solid_(solid), options_(options), result_(result), next_id_(options.first_crack_id) {
  pieces_.push_back({solid.shared_mesh(), solid.partial, false, nullptr});
}

Obstacles CrackEvent::obstacles_in(const Piece& piece, std::size_t left_out) const {
  Obstacles obstacles;
  for (std::size_t k = 0; k < piece.partial.size(); ++k)
    if (k != left_out) obstacles.add_sheet(piece.partial[k].id, piece.partial[k].sheet);
  obstacles.set_walls(*piece.mesh);
  return obstacles;
}

GrowthOptions CrackEvent::growth_options(Piece& piece, const CrackRecord& record, const Obstacles& obstacles,
                                         CutResult& accepted) {
  GrowthOptions o;
  o.edge_length = record.edge_length;
  o.propagation_strength = options_.fields.propagation_strength->upper();
  o.propagation_field = options_.fields.propagation_strength.get();
  o.thickness = options_.fields.crack_thickness->upper();
  o.thickness_field = options_.fields.crack_thickness.get();
  o.speed = options_.speed;
  o.ask_everywhere = !options_.skip[Skip::kFrontStress];
  o.obstacles = &obstacles;
  o.accept = [this, &piece, &accepted, id = record.id,
              guide = record.cause == CrackCause::kGuide ? guide_ : nullptr](const CrackSheet& sheet) {
    if (std::string reason = guide ? refusal_off(sheet, *guide) : std::string(); !reason.empty()) return reason;
    accepted = cut_piece(piece.cut_body(), sheet, id);
    if (!accepted.ok) return accepted.reason;
    return is_complete(sheet) && does_nothing(piece.cut_body(), accepted, id)
               ? std::string("it is complete and separates nothing")
               : std::string();
  };
  return o;
}

CutResult CrackEvent::cut_piece(const CutBody& body, const CrackSheet& sheet, std::int32_t crack) {
  const Stopwatch watch(result_.seconds.cut, "cut");
  CutResult refused;
  SlabOptions s;
  s.thickness = options_.fields.crack_thickness->upper(), s.field = options_.fields.crack_thickness.get();
  s.crack = crack;
  const auto slab = thicken(sheet, s, refused.reason);
  if (!slab) return refused;
  CutOptions o;
  o.edge_length = solid_.edge_length();
  o.seed = static_cast<std::uint64_t>(crack) + 1;
  o.min_fragment_volume = options_.min_fragment_volume * solid_.root().volume / body.volume();
  o.dust = options_.dust;
  o.slab_checked = true;
  CutResult c = cut(body, *slab, o);
  if (!c.ok) c.reason = "the cut was refused: " + c.reason;
  return c;
}

CrackEvent::Grown CrackEvent::grow(Piece& piece, CrackRecord& record, std::size_t left_out, const Grow& grow) {
  Grown grown;
  const Real others = result_.seconds.cut + result_.seconds.front;
  const bool went = guarded(record.reason, [&] {
    const Stopwatch watch(result_.seconds.grow, "grow crack");
    fault_point("event.grow");
    const Obstacles obstacles = obstacles_in(piece, left_out);
    grown.result = grow(piece.tree(), growth_options(piece, record, obstacles, grown.cut));
  });
  result_.seconds.grow -= result_.seconds.cut + result_.seconds.front - others;
  result_.skips.done(Skip::kFrontStress, grown.result.stresses_asked);
  result_.skips.skipped(Skip::kFrontStress, grown.result.stresses_spared);
  if (!went) grown.result.outcome = GrowthOutcome::kFailed, grown.result.reason = record.reason;
  return grown;
}

void CrackEvent::break_ligament(Piece& piece, const CrackField& field, Grown& grown, CrackRecord& record,
                                std::size_t left_out) {
  if (!options_.net_section || grown.result.outcome != GrowthOutcome::kArrested) return;
  const Real others = result_.seconds.cut + result_.seconds.front;
  CutResult through;
  NetSection net;
  std::string reason;
  const bool went = guarded(reason, [&] {
    const Stopwatch watch(result_.seconds.grow, "net section");
    const Obstacles obstacles = obstacles_in(piece, left_out);
    GrowthOptions options = growth_options(piece, record, obstacles, through);
    // The third rung ends the crack of a twisted stick. With the fine edges of a thin wall the later ones cost most of
    // the growth of a goblet's cracks and brought none through.
    options.rungs = record.edge_length < solid_.edge_length() ? 1 : 3;
    net = net_section(piece.tree(), field, grown.result.sheet, options);
  });
  result_.seconds.grow -= result_.seconds.cut + result_.seconds.front - others;
  if (!went || !net.complete) return;
  record.net_section_stress = net.stress;
  if (net.stress < net.strength) return;
  const GrowthResult& stopped = grown.result;
  net.through.ladder_level = std::max(net.through.ladder_level, stopped.ladder_level);
  net.through.steps += stopped.steps, net.through.retreats += stopped.retreats;
  net.through.wings.insert(net.through.wings.end(), stopped.wings.begin(), stopped.wings.end());
  if (net.through.reason.empty()) net.through.reason = stopped.reason;
  for (std::size_t k = 0; k < stopped.rungs.reason.size(); ++k)
    if (net.through.rungs.reason[k].empty()) net.through.rungs.reason[k] = stopped.rungs.reason[k];
  grown = {std::move(net.through), std::move(through)};
}

void CrackEvent::commit(std::size_t index, Grown&& grown, CrackRecord& record, std::size_t left_out) {
  GrowthResult& g = grown.result;
  CutResult& c = grown.cut;
  record.generation = options_.generation;
  record.ladder_level = g.ladder_level, record.steps = g.steps, record.area = g.area, record.length = g.length;
  record.retreats = g.retreats, record.wings = g.wings.size();
  record.reason = g.reason, record.rungs = g.rungs;
  if (g.outcome == GrowthOutcome::kRejectedSeed || g.outcome == GrowthOutcome::kFailed) {
    record.outcome = g.outcome == GrowthOutcome::kFailed ? "failed" : "rejected";
    return;
  }
  record.sheet = sheet_quality(g.sheet);
  if (guide_ && record.cause == CrackCause::kGuide) record.off_guide = deviation(g.sheet, *guide_);
  const bool arrested = g.outcome == GrowthOutcome::kArrested;
  record.outcome = arrested ? "arrested" : c.separated ? "complete" : "pierced";
  record.fragments = c.fragments.size(), record.met = g.met;
  const Real before = pieces_[index].cut_body().volume();
  Real after = 0;
  for (const SurfaceMesh& mesh : c.fragments) after += signed_volume(mesh);
  record.volume_error = std::abs(before - after - c.removed_volume - c.dust_volume) / before;
  const bool stays = arrested && c.fragments.size() == 1;  // a notch, see finished()
  const bool committed = guarded(record.reason, [&] {
    CrackSheet sheet = g.sheet;
    std::vector<StoppedCrack> wings;
    for (CrackSheet& wing : g.wings) wings.push_back({std::move(wing), record.id, {record.id}});
    grown_.reserve(grown_.size() + 1);
    std::vector<StoppedCrack>& stopped = pieces_[index].partial;
    stopped.reserve(stopped.size() + wings.size() + 1);
    if (!stays)
      replace(index, std::move(c), left_out, wings);
    else if (left_out == kNoSheet)
      stopped.push_back({std::move(g.sheet), record.id, record.met});
    else
      stopped[left_out] = {std::move(g.sheet), record.id, record.met};
    if (stays) std::move(wings.begin(), wings.end(), std::back_inserter(stopped));
    grown_.push_back(std::move(sheet));
  });
  if (!committed) {
    record.outcome = "failed", record.fragments = 0;
    return;
  }
  result_.changed = true;
  if (!stays) record.removed_volume = c.removed_volume, record.dust_volume = c.dust_volume;
}

// All that can throw comes before the first change.
void CrackEvent::replace(std::size_t index, CutResult&& c, std::size_t left_out,
                         const std::vector<StoppedCrack>& wings) {
  std::vector<Piece> all;
  all.reserve(pieces_.size() + c.fragments.size());
  std::vector<Piece> parts;
  fault_point("event.replace");
  for (SurfaceMesh& mesh : c.fragments) {
    Piece part{std::make_shared<SurfaceMesh>(std::move(mesh)), {}, true, nullptr};
    const std::vector<StoppedCrack>& sheets = pieces_[index].partial;
    for (std::size_t k = 0; k < sheets.size(); ++k)
      if (k != left_out && touches(sheets[k].sheet, part.tree())) part.partial.push_back(sheets[k]);
    for (const StoppedCrack& wing : wings)
      if (touches(wing.sheet, part.tree())) part.partial.push_back(wing);
    parts.push_back(std::move(part));
  }
  fault_point("event.commit");
  for (std::size_t i = 0; i < pieces_.size(); ++i)
    if (i != index)
      all.push_back(std::move(pieces_[i]));
    else
      std::move(parts.begin(), parts.end(), std::back_inserter(all));
  pieces_.swap(all);
  result_.removed_volume += c.removed_volume, result_.dust_volume += c.dust_volume;
}

std::size_t CrackEvent::piece_at(const CrackSeed& seed) {
  const Vec3& x = seed.position;
  const Real reach = 0.1 * solid_.edge_length();
  std::size_t best = pieces_.size();
  if (seed.interior) {
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      if (pieces_[i].tree().inside(x)) best = i;
    return best;
  }
  Real least = reach * reach;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const Real d2 = pieces_[i].tree().closest(x, reach).distance2;
    if (d2 < least) least = d2, best = i;
  }
  return best;
}

void CrackEvent::resume_crack_of(std::int32_t id, const CrackField& field, bool ligaments) {
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const std::vector<StoppedCrack>& stopped = pieces_[i].partial;
    const auto at = std::find_if(stopped.begin(), stopped.end(), [&](const StoppedCrack& s) { return s.id == id; });
    if (at == stopped.end()) continue;
    const auto k = static_cast<std::size_t>(at - stopped.begin());
    const CrackSheet sheet = at->sheet;
    CrackRecord record;
    record.id = next_id_, record.cause = CrackCause::kResumed, record.seed = sheet.position[0],
    record.stress = sheet.reference_stress, record.edge_length = solid_.edge_length();
    Grown grown = grow(pieces_[i], record, k, [&](const TriangleBvh& body, const GrowthOptions& options) {
      return resume_crack(body, field, sheet, options);
    });
    if (ligaments) break_ligament(pieces_[i], field, grown, record, k);
    const GrowthResult& g = grown.result;
    const bool grew = g.outcome == GrowthOutcome::kComplete ||
                      (g.outcome == GrowthOutcome::kArrested && g.sheet.position.size() > sheet.position.size());
    if (!grew) continue;
    ++next_id_;
    commit(i, std::move(grown), record, k);
    result_.cracks.push_back(std::move(record));
  }
}

void CrackEvent::resume(const CrackField& field, bool ligaments) {
  for (const StoppedCrack& stopped : solid_.partial) resume_crack_of(stopped.id, field, ligaments);
  join(field);
}

void CrackEvent::join(const CrackField& field) {
  std::vector<std::int32_t> waiting;
  for (const Piece& piece : pieces_)
    for (const StoppedCrack& s : piece.partial)
      if (piece.was_cut && !s.met.empty()) waiting.push_back(s.id);
  std::sort(waiting.begin(), waiting.end());
  waiting.erase(std::unique(waiting.begin(), waiting.end()), waiting.end());
  for (const std::int32_t id : waiting) resume_crack_of(id, field, false);
}

bool CrackEvent::may_start(const CrackSeed& seed) const {
  const Real apart = 2 * solid_.edge_length();
  const auto close_to = [&](const CrackSheet& s) { return node_distance2(s, seed.position) < apart * apart; };
  const auto stopped_close_to = [&](const StoppedCrack& s) { return close_to(s.sheet); };
  return std::none_of(grown_.begin(), grown_.end(), close_to) &&
         std::none_of(solid_.partial.begin(), solid_.partial.end(), stopped_close_to);
}

CrackEvent::Grown CrackEvent::start_in(Piece& piece, const CrackField& field, const CrackSeed& seed,
                                       CrackRecord& record) {
  Grown grown = grow(piece, record, kNoSheet, [&](const TriangleBvh& body, const GrowthOptions& options) {
    return grow_crack(body, field, seed, options);
  });
  if (record.cause != CrackCause::kGuide) break_ligament(piece, field, grown, record, kNoSheet);
  return grown;
}

// In a bent wall the stress of the uncracked body changes its sign half-way through. Edges as long as the wall is thick
// may put all of a front's nodes into the compressed half; fine ones stop at the neutral plane, which a running crack,
// like a coarse front, goes over. So a crack counts as stopped when it stops with either.
void CrackEvent::start(const CrackField& field, std::span<const CrackSeed> seeds, CrackCause cause) {
  for (const CrackSeed& seed : seeds) {
    // A seed that no sheet can start from is soon told from one that can, so it counts less.
    if (cracks_ >= options_.max_cracks || tried_ >= kTriesPerCrack * options_.max_cracks) return;
    if (pieces_.size() >= options_.max_pieces) return;
    if (!may_start(seed)) continue;
    const std::size_t index = piece_at(seed);
    if (index == pieces_.size()) continue;
    // The stress in a piece that a crack has just made is another one; a later round asks for it.
    if (options_.rounds > 1 && pieces_[index].was_cut) continue;
    ++tried_;
    CrackRecord record;
    record.id = next_id_++, record.cause = cause, record.seed = seed.position, record.stress = seed.stress.value;
    record.edge_length = solid_.edge_length();
    Grown grown = start_in(pieces_[index], field, seed, record);
    const Real finer = solid_.crack_edge_length(seed.position);
    // The depth at which a guided crack stops is meant.
    if (cause != CrackCause::kGuide && finer < record.edge_length && grown.result.outcome != GrowthOutcome::kComplete) {
      CrackRecord second = record;
      second.edge_length = finer;
      if (Grown again = start_in(pieces_[index], field, seed, second); again.result.outcome == GrowthOutcome::kComplete)
        grown = std::move(again), record = std::move(second);
    }
    const bool has_wings = !grown.result.wings.empty();
    commit(index, std::move(grown), record, kNoSheet);
    cracks_ += record.outcome != "rejected";
    result_.cracks.push_back(std::move(record));
    if (result_.cracks.back().fragments > 1 || has_wings) join(field);
  }
}

void CrackEvent::start_along(const Guide& guide, Real strength) {
  guide_ = &guide;
  for (const CrackSeed& seed : guide.seeds(strength))
    start(GuideField(guide, seed, strength), {&seed, 1}, CrackCause::kGuide);
  guide_ = nullptr;
}

bool CrackEvent::split_by(std::size_t index, std::size_t k) {
  bool split = false;
  std::string reason;
  guarded(reason, [&] {
    CutResult c = cut_piece(pieces_[index].cut_body(), pieces_[index].partial[k].sheet, next_id_);
    if (!c.ok || c.fragments.size() < 2) return;
    replace(index, std::move(c), k, {});
    split = true;
  });
  if (split) ++next_id_;
  return split;
}

// A stopped crack whose neighbours went through may by now separate a piece on its own.
void CrackEvent::split_by_partials() {
  for (std::size_t i = 0; i < pieces_.size(); ++i)
    for (std::size_t k = 0; k < pieces_[i].partial.size() && pieces_[i].was_cut; ++k) {
      if (pieces_.size() >= options_.max_pieces) return;
      if (split_by(i, k)) k = static_cast<std::size_t>(-1);  // the piece at i is another one now
    }
}

void CrackEvent::cut_notches(FragmentShape& shape) {
  std::string reason;
  for (const StoppedCrack& stopped : shape.partial)
    guarded(reason, [&] {
      CutResult c = cut_piece(CutBody(*shape.shown), stopped.sheet, next_id_);
      if (c.ok && c.fragments.size() == 1) shape.shown = std::make_shared<SurfaceMesh>(std::move(c.fragments[0]));
    });
}

FragmentShape CrackEvent::finished(Piece& piece) {
  FragmentShape shape;
  shape.clean = piece.mesh, shape.partial = piece.partial, shape.was_cut = piece.was_cut;
  shape.edge_length = solid_.edge_length();
  if (piece.was_cut) {
    shape.edge_length = piece_edge_length(*piece.mesh, solid_.root());
    const Stopwatch watch(result_.seconds.remesh, "refit");
    SurfaceMesh out;
    RefitReport report;
    if (!guarded(report.reason, [&] { report = refit_piece(*piece.mesh, solid_.root(), out); })) report.ok = false;
    if (report.ok) shape.clean = std::make_shared<SurfaceMesh>(std::move(out));
    result_.refits.push_back(std::move(report));
  }
  shape.shown = shape.clean;
  cut_notches(shape);
  return shape;
}

void CrackEvent::finish() {
  if (result_.changed) {
    split_by_partials();
    for (Piece& p : pieces_) {
      result_.shapes.push_back(finished(p));
      const FragmentShape& shape = result_.shapes.back();
      if (shape.clean != p.mesh) result_.remeshing_volume += signed_volume(*shape.clean) - signed_volume(*p.mesh);
    }
  }
  result_.next_crack_id = next_id_;
}

}  // namespace sherd
