#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <numeric>
#include <utility>

#include "engine/load/tension_bound.h"
#include "engine/rigid/energy.h"
#include "engine/step/elastic_settings.h"
#include "engine/step/guided_event.h"
#include "engine/step/inherit.h"
#include "engine/step/stopwatch.h"
#include "engine/step/world.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

// A mesh that the solver failed on so often stays whole until something changes it.
constexpr int kMaxFailedSolves = 2;

constexpr const char* kTooLight = "load below strength";

Real disc(Real radius) {
  return std::numbers::pi * radius * radius;
}

// Meshes' dense operators kept at a time, bytes.
constexpr std::size_t kOperatorBudget = std::size_t{3} << 30;

}  // namespace

ContactLoadOptions World::load_options() const {
  ContactLoadOptions o;
  o.time_step = scene.time_step;
  o.duration = scene.contact.duration.value_or(0);
  o.min_duration = scene.contact.min_duration;
  o.patch_radius = scene.contact.patch_radius.value_or(0);
  o.min_patch_radius = scene.contact.min_patch_radius;
  return o;
}

Real World::curvature_at(BodyId id, const Vec3& point) {
  Solid& solid = *companions[index_of(id)].solid;
  return curvature_radius(solid.mesh(), solid.twins(), solid.bvh(), point);
}

std::vector<BodyContact> World::loads_on(std::size_t i) {
  std::vector<BodyContact> loads;
  const Body& body = bodies[i];
  for (const Contact& c : contacts) {
    if ((c.a != body.id && c.b != body.id) || norm2(c.impulse) == 0) continue;
    const bool first = c.a == body.id;
    const BodyId other = first ? c.b : c.a;
    Real radius = curvature_at(body.id, first ? c.at_a : c.at_b);
    if (other != kGround) radius = 1 / (1 / radius + 1 / curvature_at(other, first ? c.at_b : c.at_a));
    loads.push_back(body_contact(body, other == kGround ? nullptr : &bodies[index_of(other)], c, radius,
                                 companions[i].solid->diagonal(), load_options()));
  }
  return loads;
}

std::string World::cannot_break(std::size_t i) const {
  const Body& body = bodies[i];
  if (!scene.fracture.enabled) return "fracture is off";
  if (body.fixed || !body.breakable) return "unbreakable";
  if (body.generation >= scene.fracture.max_generation) return "last generation";
  if (bodies.size() >= static_cast<std::size_t>(scene.fracture.max_fragments)) return "fragment limit";
  if (companions[i].solid->mesh().triangle_count() < 20) return "too small";
  if (companions[i].failed_solves >= kMaxFailedSolves) return "its stress could not be solved";
  return {};
}

// Below the strength no crack starts, below the propagation strength none goes on.
Real World::needed_tension(std::size_t i) const {
  const MaterialFields& fields = roots[companions[i].scene_body].fields;
  return (companions[i].solid->partial.empty() ? fields.strength : fields.propagation_strength)->lower();
}

Real World::held_tension(std::size_t i) const {
  const std::vector<bool> acting = acting_loads(i);
  return std::find(acting.begin(), acting.end(), true) != acting.end() ? companions[i].last_tension : 0;
}

BoundedLoad World::spin_of(std::size_t i) const {
  const Body& body = bodies[i];
  return {0, 0, body.mass.mass / body.mass.volume, norm(body.angular_velocity)};
}

bool World::too_light(std::size_t i, Real force, Real pressure) const {
  BoundedLoad load = spin_of(i);
  load.force = force, load.pressure = pressure;
  return tension_bound(companions[i].solid->bounded(), load) + held_tension(i) < needed_tension(i);
}

bool World::too_light(std::size_t i, const std::vector<BodyContact>& loads) const {
  Solid& solid = *companions[i].solid;
  const std::vector<SpreadContact> spread_loads = spread(solid.mesh(), loads, solid.twins(), solid.bvh());
  return tension_bound(solid.bounded(), spread_loads, companions[i].solved, spin_of(i)) + held_tension(i) <
         needed_tension(i);
}

std::vector<bool> World::acting_loads(std::size_t i) const {
  std::vector<bool> acting;
  for (const HeldLoad& l : companions[i].loads) acting.push_back(l.load.acts(time()));
  return acting;
}

World::Due World::due(std::size_t i) {
  Due due;
  due.id = bodies[i].id;
  Real impulse = 0, largest = 0;
  for (const Contact& c : contacts)
    if (c.a == bodies[i].id || c.b == bodies[i].id)
      impulse += norm(c.impulse), largest = std::max(largest, norm(c.impulse));
  const std::vector<bool> acting = acting_loads(i);
  const bool held = std::find(acting.begin(), acting.end(), true) != acting.end();
  if (impulse == 0 && !held) {
    due.skipped = "no contact";
    return due;
  }
  due.skipped = cannot_break(i);
  const bool barred = !due.skipped.empty();
  if (barred) {
    due.only_solve = scene.fracture.enabled && !scene.skip[Skip::kUnbreakable];
    record.skips.add(Skip::kUnbreakable, !due.only_solve);
    if (!due.only_solve) return due;
    due.skipped.clear();
  }
  if (impulse == 0 && (barred || acting == companions[i].solved_loads)) {
    due.skipped = "load borne before";
    return due;
  }
  const bool bounded = scene.skip[Skip::kLoadBounds] && !barred && (!held || acting == companions[i].solved_loads);
  // Bounds of force and pressure first, which need no look at the surface: most bodies of a heap only rest.
  if (bounded) {
    const ContactLoadOptions options = load_options();
    const Real shortest = shortest_duration(options),
               area = disc(smallest_patch(companions[i].solid->diagonal(), options));
    if (too_light(i, impulse / shortest, largest / shortest / area / kLeastSolidity)) due.skipped = kTooLight;
  }
  if (due.skipped.empty()) due.loads = loads_on(i);
  if (bounded && due.skipped.empty() && too_light(i, due.loads)) due.skipped = kTooLight;
  if (!barred) record.skips.add(Skip::kLoadBounds, !due.skipped.empty());
  return due;
}

FractureOptions World::fracture_options(std::size_t i) const {
  FractureOptions o;
  o.elastic = elastic_options(scene.solver);
  o.fields = roots[companions[i].scene_body].fields;
  o.speed = scene.fracture.speed;
  o.net_section = scene.fracture.net_section;
  o.max_cracks = scene.fracture.max_cracks;
  o.rounds = scene.fracture.rounds;
  o.interior_seeds = scene.fracture.interior_seeds;
  o.max_pieces = static_cast<std::size_t>(std::max(0, scene.fracture.max_fragments)) + 1;
  o.max_pieces -= std::min(o.max_pieces, bodies.size());
  o.min_fragment_volume = scene.fracture.min_fragment_volume;
  o.dust = scene.fracture.dust == SceneDust::kKeep ? DustRule::kKeep : DustRule::kDrop;
  o.first_crack_id = next_crack;
  o.generation = bodies[i].generation;
  o.skip = scene.skip;
  o.field = scene.output.field, o.shown = bodies[i].mesh;
  return o;
}

void World::apply_shapes(std::size_t i, FractureResult& result, EventRecord& event) {
  const Body parent = bodies[i];
  const Companion companion = companions[i];
  const bool same_body = result.shapes.size() == 1;
  std::vector<Body> fragments;
  std::vector<Companion> solids;
  for (std::size_t k = 0; k < result.shapes.size(); ++k) {
    FragmentShape& shape = result.shapes[k];
    Body b = parent;
    b.mesh = shape.shown;
    if (same_body) {
      ++b.mesh_version;
    } else {
      b.id = BodyId{next_id++}, b.parent = parent.id, b.mesh_version = 0, ++b.generation;
      b.name = fmt::format("{}_{}", parent.name, k);
      event.new_bodies.push_back(b.id.value);
    }
    fragments.push_back(std::move(b));
    const bool clean_kept = shape.clean == companion.solid->shared_mesh();
    auto solid =
        clean_kept ? companion.solid : std::make_shared<Solid>(shape.clean, companion.solid->root(), shape.edge_length);
    solid->partial = std::move(shape.partial);
    solids.push_back({.solid = std::move(solid),
                      .scene_body = companion.scene_body,
                      .loads = same_body ? companion.loads : std::vector<HeldLoad>{},
                      .solved_loads = clean_kept ? companion.solved_loads : std::vector<bool>{},
                      .mesh = clean_kept ? companion.mesh : Companion::kUnrecorded,
                      .last_solve = companion.last_solve,
                      .failed_solves = clean_kept ? companion.failed_solves : 0,
                      .solved = clean_kept ? companion.solved : std::vector<SolvedLoad>{},
                      .last_tension = clean_kept ? companion.last_tension : 0,
                      .field = shape.field});
  }
  inherit_motion(parent, fragments);
  const Momenta before = momenta(parent);
  Momenta after;
  for (const Body& f : fragments) after += momenta(f);
  // Relative to the sizes of the terms that cancel, so that a body at rest does not divide by zero.
  const Real size = start_box.diagonal(), speed = norm(parent.velocity) + size * norm(parent.angular_velocity) + 1e-12;
  event.mass_error = std::abs(after.mass - before.mass) / before.mass;
  event.momentum_error = norm(after.linear - before.linear) / (before.mass * speed);
  event.angular_error =
      norm(after.angular - before.angular) / (before.mass * speed * (size + norm(parent.pose.position)));
  bodies.erase(bodies.begin() + static_cast<std::ptrdiff_t>(i));
  companions.erase(companions.begin() + static_cast<std::ptrdiff_t>(i));
  bodies.insert(bodies.begin() + static_cast<std::ptrdiff_t>(i), fragments.begin(), fragments.end());
  companions.insert(companions.begin() + static_cast<std::ptrdiff_t>(i), solids.begin(), solids.end());
}

SurfaceLoad World::pull_on(std::size_t i, std::span<const BodyContact> loads) const {
  const Body& body = bodies[i];
  Solid& solid = *companions[i].solid;
  SurfaceLoad pull;
  pull.patches = contact_patches(solid.mesh(), loads, solid.twins(), solid.bvh());
  pull.omega = rotate(conjugate(body.pose.orientation), body.angular_velocity);
  for (const HeldLoad& l : companions[i].loads)
    if (l.load.acts(time())) pull.applied.push_back(l.traction);
  return pull;
}

namespace {

// Mass of the clean mesh, the one the load must balance on; its density makes up for the notches of the shown one.
MassProperties clean_mass(const Body& body, const SurfaceMesh& mesh) {
  MassProperties mass = mass_properties(mesh, 1);
  const Real density = body.mass.mass / mass.volume;
  mass.mass = body.mass.mass, mass.inertia *= density;
  return mass;
}

Elastic elastic_of(const Body& body) {
  return {shear_modulus(body.material), body.material.poisson};
}

}  // namespace

// A solve under contacts alone says what later contacts can do at most.
void World::remember(std::size_t i, const EventRecord& event, const SolveRecord& solve) {
  constexpr std::size_t kRemembered = 16;
  Companion& companion = companions[i];
  companion.last_tension = solve.strongest.stress.value;
  if (event.applied_loads > 0) return;
  if (companion.solved.size() == kRemembered) companion.solved.erase(companion.solved.begin());
  Solid& solid = *companion.solid;
  companion.solved.push_back({spread(solid.mesh(), event.contacts, solid.twins(), solid.bvh()),
                              norm(bodies[i].angular_velocity), std::max(Real{0}, companion.last_tension)});
}

void World::fracture(Due&& due, StepRecord& step) {
  const std::size_t i = index_of(due.id);
  Companion& companion = companions[i];
  Solid& solid = *companion.solid;
  companion.last_solve = steps;
  companion.solved_loads = acting_loads(i);
  const SurfaceLoad pull = pull_on(i, due.loads);
  EventRecord event;
  record_mesh(i);
  event.mesh = companion.mesh, event.applied_loads = pull.applied.size();
  const FractureOptions options = fracture_options(i);
  event.result = fracture_solid(solid, clean_mass(bodies[i], solid.mesh()), elastic_of(bodies[i]), pull, options);
  event.contacts = std::move(due.loads);
  const SolveRecord& solve = event.result.solves[0];
  if (solve.solved)
    remember(i, event, solve);
  else
    ++companion.failed_solves;
  record.skips += event.result.skips;
  if (!scene.skip[Skip::kOperators]) solid.drop_elastic();
  take(i, std::move(event), step);
}

void World::only_solve(const Due& due) {
  const std::size_t i = index_of(due.id);
  Solid& solid = *companions[i].solid;
  FractureOptions options = fracture_options(i);
  options.only_solve = true;
  record.skips +=
      fracture_solid(solid, clean_mass(bodies[i], solid.mesh()), elastic_of(bodies[i]), pull_on(i, due.loads), options)
          .skips;
  if (!scene.skip[Skip::kOperators]) solid.drop_elastic();
}

void World::take(std::size_t i, EventRecord&& event, StepRecord& step) {
  event.step = steps, event.time = time(), event.body = bodies[i].name, event.body_id = bodies[i].id.value;
  FractureResult& result = event.result;
  next_crack = result.next_crack_id;
  step.solves += result.solves.size(), step.cracks += result.cracks.size();
  for (const SolveRecord& s : result.solves) step.solver_iterations += static_cast<std::size_t>(s.krylov.iterations);
  report(event);
  if (result.field) {
    companions[i].field = result.field;
    widen(*record.field, *scene.output.field, *result.field);
  }
  if (result.changed) apply_shapes(i, result, event);
  step.fragments += event.new_bodies.size();
  result.shapes.clear(), result.field.reset();
  record.events.push_back(std::move(event));
}

void World::report(const EventRecord& event) {
  const FractureResult& r = event.result;
  const std::string at = fmt::format("{:.3f} s: {}", event.time, event.body);
  const std::string why = r.solves.empty()
                              ? "along its guide"
                              : fmt::format("tension up to {:.3g} MPa", r.solves[0].strongest.stress.value * 1e-6);
  if (!r.solves.empty() && !r.solved())
    pending.push_back(fmt::format("{}: no stress under this load: {}", at, r.solves[0].reason));
  else if (r.shapes.size() > 1)
    pending.push_back(fmt::format("{} breaks into {} pieces ({})", at, r.shapes.size(), why));
  else if (r.changed)
    pending.push_back(fmt::format("{} cracks ({})", at, why));
  else if (r.solves.empty() && !r.cracks.empty())
    pending.push_back(fmt::format("{} does not crack along its guide: {}", at, r.cracks[0].reason));
}

void World::run_guides(StepRecord& step) {
  for (std::size_t root = 0; root < roots.size(); ++root)
    for (std::size_t k = 0; k < roots[root].guides.size(); ++k) {
      if (guided[root][k] || scene.bodies[root].cracks[k].time > time()) continue;
      guided[root][k] = true;
      std::vector<BodyId> due;  // by id: bodies shift while fragments replace their parents
      for (std::size_t i = 0; i < bodies.size(); ++i)
        if (companions[i].scene_body == root && cannot_break(i).empty()) due.push_back(bodies[i].id);
      for (const BodyId id : due) guide(index_of(id), k, step);
    }
}

void World::guide(std::size_t i, std::size_t crack, StepRecord& step) {
  EventRecord event;
  event.result = crack_along(*companions[i].solid, roots[companions[i].scene_body].guides[crack], fracture_options(i));
  if (!event.result.cracks.empty()) take(i, std::move(event), step);
}

// Frees the operators solved longest ago until the rest fits the budget.
void World::limit_operators() {
  for (;;) {
    std::size_t bytes = 0, oldest = companions.size();
    for (std::size_t i = 0; i < companions.size(); ++i) {
      if (!companions[i].solid->has_elastic()) continue;
      bytes += companions[i].solid->elastic_bytes();
      if (oldest == companions.size() || companions[i].last_solve < companions[oldest].last_solve) oldest = i;
    }
    if (bytes <= kOperatorBudget || oldest == companions.size()) return;
    companions[oldest].solid->drop_elastic();
  }
}

// What the rigid step leaves out. Fields are kept in the cache; made anew for all, they give the same contacts.
void World::move_bodies(StepRecord& step) {
  const std::size_t built_before = cache.builds();
  if (!scene.skip[Skip::kDistanceFields]) {
    std::vector<std::size_t> all(bodies.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    cache.clear();
    cache.update(bodies);
    cache.build(bodies, all);
  }
  const std::vector<Body> before = bodies;
  RigidStats stats;
  {
    const Stopwatch watch(step.rigid_seconds, "rigid step");
    rigid_step(bodies, ground, rigid, cache, rigid_state, contacts, stats);
  }
  step.pairs_near = stats.contact.pairs_near, step.contacts = contacts.size(),
  step.fields_built = stats.contact.fields_built;
  step.contact_iterations = stats.iterations, step.parts = stats.parts, step.asleep = stats.asleep;
  step.unconverged = stats.unconverged, step.contact_residual = stats.residual;
  step.recovery_work = stats.recovery_work;
  const EnergyBalance balance = energy_balance(before, bodies, rigid, stats);
  step.energy = balance.after, step.energy_growth = balance.growth(), step.energy_holds = balance.holds();
  std::size_t moving = 0;
  for (const Body& b : bodies) moving += !b.fixed;
  record.skips.skipped(Skip::kSleep, stats.asleep);
  record.skips.done(Skip::kSleep, moving - stats.asleep);
  const std::size_t built = cache.builds() - built_before;
  record.skips.done(Skip::kDistanceFields, built);
  record.skips.skipped(Skip::kDistanceFields, bodies.size() - built);
}

void World::advance() {
  StepRecord step;
  move_bodies(step);
  ++steps;
  step.step = steps, step.time = time();
  {
    const Stopwatch watch(step.fracture_seconds, "fracture");
    // By id: bodies shift while fragments replace their parents, and fragments of this step carry no contact yet.
    std::vector<Due> all;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      all.push_back(due(i));
      if (!all.back().skipped.empty()) ++step.skipped[all.back().skipped];
    }
    for (Due& d : all) {
      if (!d.skipped.empty()) continue;
      if (d.only_solve)
        only_solve(d);
      else
        fracture(std::move(d), step);
    }
    run_guides(step);
    limit_operators();
  }
  step.bodies = bodies.size();
  for (const Body& b : bodies) step.triangles += b.mesh->triangle_count();
  record.steps.push_back(std::move(step));
}

}  // namespace sherd
