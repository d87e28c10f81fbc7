#include "engine/step/fracture_event.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "engine/fracture/initiate.h"
#include "engine/fracture/interior_seed.h"
#include "engine/step/crack_event.h"
#include "engine/step/stopwatch.h"
#include "engine/step/timed_field.h"

namespace sherd {
namespace {

// A solved body: the parts borrow from each other and from the Solid.
struct Solved {
  Load load;
  std::optional<ParticularSolution> particular;
  ElasticSolution solution;
  std::unique_ptr<StressState> state;
  std::vector<CrackSeed> seeds;
  std::optional<CrackSeed> inside;
};

// Where the stress over strength exceeds the surface's largest, deep enough for a first slit.
std::optional<CrackSeed> seed_inside(Solid& solid, const StressState& state, const CrackSeed& strongest,
                                     const ScalarField& strength) {
  constexpr Real kDeep = 1.5;  // of the edge length
  const Real h = solid.edge_length();
  const Real surface = strongest.stress.value / strength.at(strongest.position);
  return find_interior_seed(solid.bvh(), StressCrackField(state), strength,
                            {.spacing = kDeep * h, .depth = kDeep * h, .least = std::max(1.0, surface)});
}

// Body forces this small beside the loads change the stress by less than the solver's tolerance does (1e-4 unless a
// scene says otherwise); a body that is held still by balanced loads has none, but for rounding.
bool drop_body_force(Load& load, const Box& box, Real volume, Real force) {
  constexpr Real kNegligible = 1e-6;
  const BodyForce& b = load.body_force;
  Real density = norm(b.constant);
  for (int k = 0; k < 3; ++k) density += norm(b.linear.row(k)) * box.diagonal();
  if (density * volume > kNegligible * force) return false;
  load.body_force = {};
  return true;
}

void solve(Solid& solid, const MassProperties& mass, const Elastic& material, const SurfaceLoad& pull,
           const FractureOptions& options, EventSeconds& seconds, SkipCounts& skips, Solved& s, SolveRecord& record) {
  record.triangles = solid.mesh().triangle_count();
  record.unknowns = 3 * solid.mesh().vertex_count();
  s.load = make_load(solid.mesh(), mass, pull);
  record.panels = s.load.panels.size(), record.force = total_force(solid.mesh(), s.load);
  if (!(record.force > 0)) {
    record.reason = "nothing pulls at it";
    return;
  }
  record.relief = norm(s.load.body_force.constant) * mass.volume / record.force;
  skips.add(Skip::kZeroTerms, options.skip[Skip::kZeroTerms] &&
                                  drop_body_force(s.load, bounding_box(solid.mesh()), mass.volume, record.force));
  skips.add(Skip::kOperators, options.skip[Skip::kOperators] && solid.assembled);
  solid.assembled = true;
  const ElasticBody* elastic = nullptr;
  {
    const Stopwatch watch(seconds.assemble, "elastic body",
                          [&] { return fmt::format("{} triangles", record.triangles); });
    ElasticOptions elastic_options = options.elastic;
    if (!options.skip[Skip::kFarField]) elastic_options.kind = OperatorKind::kFast;
    elastic = &solid.elastic(material, elastic_options);
  }
  skips.add(Skip::kFarField, elastic->dense());
  record.galerkin_vertices = elastic->testing().galerkin_count();
  s.particular = elastic->particular(s.load);
  {
    const Stopwatch watch(seconds.solve, "solve");
    s.solution = elastic->solve(s.load, *s.particular, options.skip[Skip::kWarmStart] ? &solid.history : nullptr);
  }
  record.krylov = s.solution.krylov, record.incompatibility = s.solution.incompatibility;
  record.factored = s.solution.factored, record.warm = s.solution.warm, record.reason = s.solution.reason;
  skips.add(Skip::kWarmStart, record.warm);
  if (!s.solution.ok) return;
  const Stopwatch watch(seconds.stress, "stress");
  s.state = std::make_unique<StressState>(*elastic, solid.recovery(), solid.bvh(), s.load, *s.particular, s.solution);
  record.strongest = strongest_point(solid.mesh(), solid.recovery(), *s.state, *options.fields.strength);
  s.seeds = find_seeds(solid.mesh(), solid.recovery(), *s.state, *options.fields.strength);
  if (options.interior_seeds) s.inside = seed_inside(solid, *s.state, record.strongest, *options.fields.strength);
  record.seeds = s.seeds.size() + s.inside.has_value();
  record.solved = std::isfinite(record.strongest.stress.value);
  if (!record.solved) record.reason = "the stress is not finite";
}

// The field of the body and of what it fell into.
void show(Solid& solid, const StressState& state, const Elastic& material, const FractureOptions& options,
          FractureResult& result) {
  result.field = shown_field(*options.field, solid, state, material, options.shown ? *options.shown : solid.mesh());
  for (FragmentShape& shape : result.shapes)
    shape.field = shown_field(*options.field, solid, state, material, *shape.shown);
}

// One solve and the cracks that follow it.
FractureResult break_once(Solid& solid, const MassProperties& mass, const Elastic& material, const SurfaceLoad& pull,
                          const FractureOptions& options, int round) {
  FractureResult result;
  result.volume_before = result.volume_after = mass.volume;
  result.next_crack_id = options.first_crack_id;
  SolveRecord& record = result.solves.emplace_back();
  record.round = round;
  Solved solved;
  try {
    solve(solid, mass, material, pull, options, result.seconds, result.skips, solved, record);
  } catch (const std::exception& e) {  // a broken invariant or memory: this body keeps its shape, the run goes on
    record.solved = false, record.reason = e.what();
  }
  if (!record.solved || options.only_solve) return result;
  CrackEvent event(solid, options, result);
  const StressCrackField stress(*solved.state);
  const TimedField field(stress, result.seconds.front);
  const Real most = record.strongest.stress.value;
  if (!solid.partial.empty() && most > options.fields.propagation_strength->lower())
    event.resume(field, record.seeds > 0);
  if (solved.inside) event.start(field, {&*solved.inside, 1}, CrackCause::kInterior);
  event.start(field, solved.seeds);
  event.finish();
  if (options.field) show(solid, *solved.state, material, options, result);
  for (CrackRecord& crack : result.cracks) crack.round = round;
  return result;
}

// Takes over what a later round did to one piece, but for its shapes.
void add(FractureResult& all, FractureResult&& r) {
  std::move(r.solves.begin(), r.solves.end(), std::back_inserter(all.solves));
  std::move(r.cracks.begin(), r.cracks.end(), std::back_inserter(all.cracks));
  all.removed_volume += r.removed_volume, all.dust_volume += r.dust_volume;
  std::move(r.refits.begin(), r.refits.end(), std::back_inserter(all.refits));
  all.remeshing_volume += r.remeshing_volume;
  all.next_crack_id = r.next_crack_id;
  all.skips += r.skips;
  EventSeconds &s = all.seconds, &t = r.seconds;
  s.assemble += t.assemble, s.solve += t.solve, s.stress += t.stress;
  s.front += t.front, s.grow += t.grow, s.cut += t.cut, s.remesh += t.remesh;
}

// Solves the pieces of the round before under their part of the load and lets them crack on. False when none did.
bool break_on(FractureResult& all, const RootScale& root, Real density, const Elastic& material,
              const SurfaceLoad& pull, const FractureOptions& options, int round) {
  constexpr std::size_t kLeastTriangles = 20;
  bool cracked = false;
  std::vector<FragmentShape> shapes = std::move(all.shapes);
  all.shapes.clear();
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    FragmentShape& shape = shapes[i];
    const std::size_t pieces = all.shapes.size() + shapes.size() - i;
    const int cracks_left = options.max_cracks - static_cast<int>(all.cracks.size());
    const SurfaceLoad part = owned_part(*shape.clean, pull);
    if (!shape.was_cut || cracks_left <= 0 || pieces >= options.max_pieces ||
        shape.clean->triangle_count() < kLeastTriangles) {
      all.shapes.push_back(std::move(shape));
      continue;
    }
    FractureOptions o = options;
    o.shown = shape.shown;
    o.max_cracks = cracks_left, o.max_pieces = options.max_pieces - pieces + 1, o.first_crack_id = all.next_crack_id;
    Solid piece(shape.clean, root, shape.edge_length);
    piece.partial = shape.partial;
    FractureResult r = break_once(piece, mass_properties(piece.mesh(), density), material, part, o, round);
    shape.was_cut = false;
    if (r.field) shape.field = r.field;
    if (r.changed)
      std::move(r.shapes.begin(), r.shapes.end(), std::back_inserter(all.shapes)), cracked = true;
    else
      all.shapes.push_back(std::move(shape));
    add(all, std::move(r));
  }
  return cracked;
}

}  // namespace

void measure(FractureResult& result) {
  if (!result.changed) return;
  result.volume_after = result.notch_volume = 0;
  for (const FragmentShape& shape : result.shapes) {
    const Real clean = signed_volume(*shape.clean);
    result.volume_after += clean;
    if (shape.shown != shape.clean) result.notch_volume += clean - signed_volume(*shape.shown);
  }
}

FractureResult fracture_solid(Solid& solid, const MassProperties& mass, const Elastic& material,
                              const SurfaceLoad& pull, const FractureOptions& options) {
  FractureResult result = break_once(solid, mass, material, pull, options, 0);
  for (int round = 1; round < options.rounds && result.changed; ++round)
    if (!break_on(result, solid.root(), mass.mass / mass.volume, material, pull, options, round)) break;
  measure(result);
  return result;
}

}  // namespace sherd
