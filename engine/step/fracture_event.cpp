#include "engine/step/fracture_event.h"

#include <algorithm>

#include "engine/fracture/initiate.h"
#include "engine/fracture/net_section.h"
#include "engine/fracture/thicken.h"
#include "engine/mesh/sizing.h"
#include "engine/mesh/validate.h"
#include "engine/step/stopwatch.h"

namespace sherd {
namespace {

// A part of the body while the event runs.
struct Piece {
  std::shared_ptr<const SurfaceMesh> mesh;
  std::vector<CrackSheet> partial;
  bool was_cut = false;
  std::unique_ptr<TriangleBvh> bvh;

  const TriangleBvh& tree() {
    if (!bvh) bvh = std::make_unique<TriangleBvh>(*mesh);
    return *bvh;
  }
};

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

class Event {
 public:
  Event(Solid& solid, const FractureOptions& options, FractureResult& result)
      : solid_(solid), options_(options), result_(result), next_id_(options.first_crack_id) {
    pieces_.push_back({solid.shared_mesh(), solid.partial, false, nullptr});
    growth_.edge_length = solid.root().edge_length;
    growth_.propagation_strength = options.propagation_strength;
    growth_.thickness = options.thickness;
    growth_.speed = options.speed;
  }

  void resume(const CrackField& field);
  void start(const CrackField& field, const std::vector<CrackSeed>& seeds);
  void finish();

 private:
  // Lets the ligament of a stopped crack fail where it cannot bear the load.
  void break_ligament(const TriangleBvh& body, const CrackField& field, GrowthResult& grown, CrackRecord& record);
  // Cuts piece `index` with a grown sheet; true when the piece list changed.
  bool apply(std::size_t index, GrowthResult&& grown, CrackRecord& record);
  CutResult cut_piece(const SurfaceMesh& mesh, const SurfaceMesh& slab);
  void replace(std::size_t index, CutResult&& cut_result);
  std::size_t piece_at(const Vec3& x, Real reach);
  void split_by_partials();
  FragmentShape finished(Piece& piece);

  Solid& solid_;
  const FractureOptions& options_;
  FractureResult& result_;
  GrowthOptions growth_;
  std::int32_t next_id_;
  std::vector<Piece> pieces_;
  std::vector<CrackSheet> grown_;  // of this event, to keep new seeds apart
};

CutResult Event::cut_piece(const SurfaceMesh& mesh, const SurfaceMesh& slab) {
  const Stopwatch watch(result_.seconds.cut);
  CutOptions o;
  o.edge_length = solid_.root().edge_length;
  o.seed = static_cast<std::uint64_t>(next_id_) + 1;
  o.min_fragment_volume = options_.min_fragment_volume * solid_.root().volume / signed_volume(mesh);
  return cut(mesh, slab, o);
}

void Event::replace(std::size_t index, CutResult&& c) {
  result_.removed_volume += c.removed_volume, result_.dust_volume += c.dust_volume;
  std::vector<Piece> parts;
  for (SurfaceMesh& mesh : c.fragments) {
    Piece part{std::make_shared<SurfaceMesh>(std::move(mesh)), {}, true, nullptr};
    for (const CrackSheet& sheet : pieces_[index].partial)
      if (touches(sheet, part.tree())) part.partial.push_back(sheet);
    parts.push_back(std::move(part));
  }
  const auto at = pieces_.erase(pieces_.begin() + static_cast<std::ptrdiff_t>(index));
  pieces_.insert(at, std::make_move_iterator(parts.begin()), std::make_move_iterator(parts.end()));
  result_.changed = true;
}

void Event::break_ligament(const TriangleBvh& body, const CrackField& field, GrowthResult& grown, CrackRecord& record) {
  if (!options_.net_section || grown.outcome != GrowthOutcome::kArrested) return;
  const Stopwatch watch(result_.seconds.grow);
  NetSection net = net_section(body, field, grown.sheet, growth_);
  if (!net.complete) return;
  record.net_section_stress = net.stress;
  if (net.stress < options_.propagation_strength) return;
  const int level = grown.ladder_level, steps = grown.steps;
  grown = std::move(net.through);
  grown.ladder_level = std::max(grown.ladder_level, level), grown.steps += steps;
}

bool Event::apply(std::size_t index, GrowthResult&& grown, CrackRecord& record) {
  record.ladder_level = grown.ladder_level, record.steps = grown.steps, record.area = grown.area,
  record.reason = grown.reason;
  switch (grown.outcome) {
    case GrowthOutcome::kRejectedSeed:
      record.outcome = "rejected";
      return false;
    case GrowthOutcome::kFailed:
      record.outcome = "failed";
      return false;
    case GrowthOutcome::kComplete:
      record.outcome = "complete";
      break;
    case GrowthOutcome::kArrested:
      record.outcome = "arrested";
      break;
  }
  const auto slab = thicken(grown.sheet, options_.thickness, record.id, record.reason);
  if (!slab) {
    record.outcome = "failed";
    return false;
  }
  CutResult c = cut_piece(*pieces_[index].mesh, *slab);
  if (!c.ok) {
    record.outcome = "cut refused", record.reason = c.reason;
    return false;
  }
  record.removed_volume = c.removed_volume, record.fragments = c.fragments.size();
  grown_.push_back(grown.sheet);
  if (grown.outcome == GrowthOutcome::kArrested && c.fragments.size() == 1) {
    pieces_[index].partial.push_back(std::move(grown.sheet));  // seen as a notch, see finished()
    result_.changed = true;
    return false;
  }
  replace(index, std::move(c));
  return true;
}

std::size_t Event::piece_at(const Vec3& x, Real reach) {
  std::size_t best = pieces_.size();
  Real least = reach * reach;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const Real d2 = pieces_[i].tree().closest(x, reach).distance2;
    if (d2 < least) least = d2, best = i;
  }
  return best;
}

void Event::resume(const CrackField& field) {
  // Sheets move between pieces while cracks go through, so each is taken out first and put back if it did not grow.
  std::vector<CrackSheet> waiting = std::move(pieces_[0].partial);
  pieces_[0].partial.clear();
  for (CrackSheet& sheet : waiting) {
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (!touches(sheet, pieces_[i].tree())) continue;
      GrowthResult grown;
      {
        const Stopwatch watch(result_.seconds.grow);
        grown = resume_crack(pieces_[i].tree(), field, sheet, growth_);
      }
      CrackRecord record;
      // Worth its cost only under a load that could start a crack.
      if (result_.strongest.stress.value > options_.strength) break_ligament(pieces_[i].tree(), field, grown, record);
      const bool grew =
          grown.outcome == GrowthOutcome::kComplete ||
          (grown.outcome == GrowthOutcome::kArrested && grown.sheet.position.size() > sheet.position.size());
      if (!grew) {
        pieces_[i].partial.push_back(sheet);
        continue;
      }
      record.id = next_id_++, record.resumed = true, record.seed = sheet.position[0],
      record.stress = sheet.reference_stress;
      const bool split = apply(i, std::move(grown), record);
      if (record.outcome == "failed" || record.outcome == "cut refused") pieces_[i].partial.push_back(sheet);
      result_.cracks.push_back(std::move(record));
      if (split) break;
    }
  }
}

void Event::start(const CrackField& field, const std::vector<CrackSeed>& seeds) {
  const Real apart = 2 * growth_.edge_length;
  int tried = 0;
  for (const CrackSeed& seed : seeds) {
    if (tried >= options_.max_cracks || pieces_.size() >= options_.max_pieces) return;
    const auto close_to = [&](const CrackSheet& s) { return node_distance2(s, seed.position) < apart * apart; };
    if (std::any_of(grown_.begin(), grown_.end(), close_to) ||
        std::any_of(solid_.partial.begin(), solid_.partial.end(), close_to))
      continue;
    const std::size_t index = piece_at(seed.position, 0.1 * growth_.edge_length);
    if (index == pieces_.size()) continue;
    ++tried;
    CrackRecord record;
    record.id = next_id_++, record.seed = seed.position, record.stress = seed.stress.value;
    GrowthResult grown;
    {
      const Stopwatch watch(result_.seconds.grow);
      grown = grow_crack(pieces_[index].tree(), field, seed, growth_);
    }
    break_ligament(pieces_[index].tree(), field, grown, record);
    apply(index, std::move(grown), record);
    result_.cracks.push_back(std::move(record));
  }
}

// A stopped crack whose neighbours went through may by now separate a piece on its own.
void Event::split_by_partials() {
  for (std::size_t i = 0; i < pieces_.size() && pieces_.size() < options_.max_pieces; ++i)
    for (std::size_t k = 0; k < pieces_[i].partial.size(); ++k) {
      std::string reason;
      const auto slab = thicken(pieces_[i].partial[k], options_.thickness, next_id_, reason);
      if (!slab || !pieces_[i].was_cut) continue;
      CutResult c = cut_piece(*pieces_[i].mesh, *slab);
      if (!c.ok || c.fragments.size() < 2) continue;
      ++next_id_;
      pieces_[i].partial.erase(pieces_[i].partial.begin() + static_cast<std::ptrdiff_t>(k));
      replace(i, std::move(c));
      k = static_cast<std::size_t>(-1);  // the piece at i is another one now
    }
}

// The cut piece made fit for the next solve, or nothing: near the cut alone; all of it when slivers remain; slivers
// alone when the piece is so small against the edge that remeshing would change its shape.
std::shared_ptr<const SurfaceMesh> remeshed(const SurfaceMesh& piece, const RootScale& root) {
  constexpr Real kMaxVolumeChange = 0.005;
  RemeshOptions local, whole, slivers;
  local.edge_length = root.edge_length;
  if (root.edge_per_thickness > 0)
    local.size = sizing_field(piece, wall_thickness(piece).vertex,
                              {.edge_length = root.edge_length, .edge_per_thickness = root.edge_per_thickness});
  whole = slivers = local;
  local.locked = local.size.empty() ? lock_good_regions(piece, root.edge_length, 2 * root.edge_length)
                                    : lock_good_regions(piece, local.size, 2 * root.edge_length);
  slivers.iterations = 0;
  std::shared_ptr<const SurfaceMesh> best;
  std::size_t least = 0;
  for (const RemeshOptions* options : {&local, &whole, &slivers}) {
    SurfaceMesh out;
    const RemeshReport report = remesh(piece, *options, out);
    if (report.status != RemeshStatus::kOk || std::abs(report.volume_change) > kMaxVolumeChange) continue;
    if (!is_valid(report_mesh(out))) continue;
    if (!best || report.below_1 < least) best = std::make_shared<SurfaceMesh>(std::move(out)), least = report.below_1;
    if (least == 0) break;
  }
  return best;
}

FragmentShape Event::finished(Piece& piece) {
  FragmentShape shape;
  shape.clean = piece.mesh;
  if (piece.was_cut) {
    const Stopwatch watch(result_.seconds.remesh);
    if (auto mesh = remeshed(*piece.mesh, solid_.root()))
      shape.clean = std::move(mesh);
    else
      ++result_.remesh_refused;
  }
  shape.shown = shape.clean;
  for (const CrackSheet& sheet : piece.partial) {
    std::string reason;
    const auto slab = thicken(sheet, options_.thickness, next_id_, reason);
    if (slab) {
      CutResult c = cut_piece(*shape.shown, *slab);
      if (c.ok && c.fragments.size() == 1) shape.shown = std::make_shared<SurfaceMesh>(std::move(c.fragments[0]));
    }
    shape.partial.push_back(sheet);
  }
  return shape;
}

void Event::finish() {
  if (!result_.changed) return;
  split_by_partials();
  for (const Piece& p : pieces_) result_.volume_after += signed_volume(*p.mesh);
  for (Piece& p : pieces_) {
    result_.shapes.push_back(finished(p));
    result_.remeshed_volume += signed_volume(*result_.shapes.back().clean);
  }
}

}  // namespace

FractureResult fracture_solid(Solid& solid, const MassProperties& clean_mass, const Elastic& material,
                              std::span<const BodyContact> contacts, const Vec3& omega,
                              const FractureOptions& options) {
  FractureResult result;
  result.triangles = solid.mesh().triangle_count();
  result.volume_before = clean_mass.volume;
  const ElasticBody* elastic = nullptr;
  {
    const Stopwatch watch(result.seconds.assemble);
    elastic = &solid.elastic(material, options.elastic);
  }
  result.unknowns = 3 * solid.mesh().vertex_count();
  result.galerkin_vertices = elastic->testing().galerkin_count();
  const Load load = make_load(solid.mesh(), clean_mass, contacts, solid.twins(), solid.bvh(), omega);
  result.panels = load.panels.size();
  const ParticularSolution particular = elastic->particular(load);
  ElasticSolution solution;
  {
    const Stopwatch watch(result.seconds.solve);
    solution = elastic->solve(load, particular);
  }
  result.krylov = solution.krylov, result.incompatibility = solution.incompatibility;
  result.factored = solution.factored;
  result.solved = solution.ok, result.reason = solution.reason;
  if (!solution.ok) return result;
  std::vector<CrackSeed> seeds;
  std::unique_ptr<StressState> state;
  {
    const Stopwatch watch(result.seconds.stress);
    state = std::make_unique<StressState>(*elastic, solid.recovery(), solid.bvh(), load, particular, solution);
    const ScalarFieldPtr strength = constant_field(options.strength);
    result.strongest = strongest_point(solid.mesh(), solid.recovery(), *state, *strength);
    seeds = find_seeds(solid.mesh(), solid.recovery(), *state, *strength);
  }
  result.seeds = seeds.size();
  if (!std::isfinite(result.strongest.stress.value)) {
    result.solved = false, result.reason = "the stress is not finite";
    return result;
  }
  Event event(solid, options, result);
  const StressCrackField field(*state);
  if (!solid.partial.empty() && result.strongest.stress.value > options.propagation_strength) event.resume(field);
  event.start(field, seeds);
  event.finish();
  return result;
}

}  // namespace sherd
