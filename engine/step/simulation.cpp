#include "engine/step/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <utility>

#include "engine/fragment/pieces.h"
#include "engine/rigid/step.h"
#include "engine/step/build_bodies.h"
#include "engine/step/framing.h"
#include "engine/step/inherit.h"
#include "engine/step/stats.h"
#include "engine/step/stopwatch.h"
#include "kernels/core/error.h"
#include "kernels/core/parallel.h"

namespace sherd {
namespace {

// A load this far below what a body can bear cannot break it; its stress is not solved. Estimates, not bounds: a wall
// of thickness T = 2 V/A bears a bending force of order strength * T^2 (plates: 6 M / T^2 with M of order F / 2 pi),
// and no tension exceeds the mean contact pressure by much away from it.
constexpr Real kBendingShare = 0.05, kPressureShare = 0.5;
// The stress a newton has caused on this mesh before, times this, stands for the stress it may cause elsewhere.
constexpr Real kLearnedShare = 4;
// A mesh that the solver failed on so often stays whole until something changes it.
constexpr int kMaxFailedSolves = 2;

// Meshes' dense operators kept at a time, bytes.
constexpr std::size_t kOperatorBudget = std::size_t{3} << 30;

Colour palette(std::size_t i) {
  static const Colour colours[] = {{0.82f, 0.76f, 0.68f}, {0.62f, 0.72f, 0.74f}, {0.74f, 0.63f, 0.56f},
                                   {0.66f, 0.70f, 0.60f}, {0.72f, 0.66f, 0.74f}, {0.78f, 0.72f, 0.55f}};
  return colours[i % std::size(colours)];
}
Colour to_colour(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

// Collocation at vertices errs by up to 5 % of bending stress up to this many wall thicknesses an edge (the rule in
// engine/mesh/thickness_resolution.h), as much as a material's strength is uncertain, and is set up several times as
// fast.
constexpr Real kRunThinRatio = kCubicCollocationRule.at_5_percent;

ElasticOptions elastic_options(const SceneSolver& solver) {
  ElasticOptions o;
  o.thin_ratio = kRunThinRatio;
  o.krylov.tolerance = solver.tolerance;
  o.krylov.max_iterations = solver.max_iterations;
  o.testing = solver.thin_walls == ThinWalls::kOff   ? TestingRule::kCollocation
              : solver.thin_walls == ThinWalls::kAll ? TestingRule::kGalerkin
                                                     : TestingRule::kAuto;
  return o;
}

const ResolutionRule& resolution_rule(const SceneSolver& solver) {
  return solver.thin_walls == ThinWalls::kOff ? kCubicCollocationRule : kCubicTestedRule;
}

// Of the smaller kind, all vertices tested.
std::size_t operator_bytes(const SurfaceMesh& mesh) {
  const std::size_t n = mesh.vertex_count(), dense = 9 * n * n * sizeof(float);
  return std::min(dense, FastOperator::estimated_bytes(mesh.triangle_count(), n, n));
}

// Said before the run starts, not at the first impact.
void require_solvable(const Body& body, Real edge_length) {
  const std::size_t bytes = operator_bytes(*body.mesh), allowed = ElasticOptions{}.max_bytes;
  if (bytes <= allowed) return;
  const Real edge = edge_length * std::pow(static_cast<Real>(bytes) / static_cast<Real>(allowed), 0.5) * 1.02;
  throw InputError(fmt::format(
      "body \"{}\": {} triangles need {} MiB for the stress, more than the {} MiB allowed; raise edge_length "
      "from {:.3g} to {:.3g} m, or set breakable = false",
      body.name, body.mesh->triangle_count(), bytes >> 20, allowed >> 20, edge_length, edge));
}

}  // namespace

struct Simulation::Impl {
  static constexpr std::size_t kUnrecorded = static_cast<std::size_t>(-1);
  // Beside each body, in the same order.
  struct Companion {
    std::shared_ptr<Solid> solid;
    std::size_t scene_body = 0;
    std::size_t mesh = kUnrecorded;  // index into RunRecord::meshes
    std::size_t last_solve = 0;      // step, for dropping operators
    int failed_solves = 0;           // on this mesh
    Real stress_per_force = 0;       // the most that earlier solves of this mesh gave, Pa/N
  };

  Scene scene;
  ThreadLimit threads;
  std::vector<Body> bodies;
  std::vector<Companion> companions;
  GroundPlane ground;
  RigidOptions rigid;
  ContactCache cache;
  RigidState rigid_state;
  RunRecord record;
  std::vector<Contact> contacts;
  std::size_t steps = 0, frames_served = 0;
  std::uint32_t next_id = 0;
  std::int32_t next_crack = 0;
  std::vector<std::string> pending, pending_warnings;  // messages nobody has taken yet
  Frame last_frame;
  std::vector<std::size_t> last_frame_roots;  // scene body of each body of last_frame
  Box start_box;

  Impl(const Scene& s, const SimulationOptions& options) : scene(s), threads(options.threads) {
    record.scene = s.file.filename().string();
    record.threads = options.threads;
    const Stopwatch watch(record.prepare_seconds);
    for (std::size_t i = 0; i < s.bodies.size(); ++i) {
      const BuiltBody built = build_body(s.bodies[i], BodyId{0});
      for (const std::string& m : built.messages) record.messages.push_back(built.body.name + ": " + m);
      add_solids(built, i);
    }
    ground = {s.ground.enabled, s.ground.height, s.ground.restitution, s.ground.friction};
    rigid.dt = s.time_step, rigid.gravity = s.gravity;
    pending = record.messages;
    start_box = world_box();
  }

  // A mesh of several solids becomes as many bodies: nothing holds them together.
  void add_solids(const BuiltBody& built, std::size_t scene_body);

  Real time() const { return static_cast<Real>(steps) * scene.time_step; }

  Box world_box() const {
    Box box;
    for (const Body& b : bodies)
      for (std::size_t v = 0; v < b.mesh->vertex_count(); ++v) box.grow(to_world(b, b.mesh->vertices[v]));
    return box;
  }

  ContactLoadOptions load_options() const {
    ContactLoadOptions o;
    o.time_step = scene.time_step;
    o.duration = scene.contact.duration.value_or(0);
    o.min_duration = scene.contact.min_duration;
    o.patch_radius = scene.contact.patch_radius.value_or(0);
    o.min_patch_radius = scene.contact.min_patch_radius;
    return o;
  }

  std::size_t index_of(BodyId id) const {
    const auto it = std::find_if(bodies.begin(), bodies.end(), [&](const Body& b) { return b.id == id; });
    SHERD_CHECK(it != bodies.end(), "no body {}", id.value);
    return static_cast<std::size_t>(it - bodies.begin());
  }

  // Measures body i's mesh against its walls, once a mesh.
  const MeshRecord& record_mesh(std::size_t i);

  Real curvature_at(BodyId id, const Vec3& world_point);
  std::vector<BodyContact> loads_on(std::size_t i);
  std::string cannot_break(std::size_t i) const;
  std::string too_light(std::size_t i, Real force, Real pressure) const;  // N; mean over a contact patch, Pa
  // Why body i's stress need not be solved in this step; empty with `loads` set when it must.
  std::string reason_to_skip(std::size_t i, std::vector<BodyContact>& loads);
  FractureOptions fracture_options(std::size_t i) const;
  bool fracture(std::size_t i, std::vector<BodyContact>&& loads, StepRecord& step);
  void report(const EventRecord& event);
  void apply_shapes(std::size_t i, FractureResult& result, EventRecord& event);
  void limit_operators();
  void advance();
};

void Simulation::Impl::add_solids(const BuiltBody& built, std::size_t scene_body) {
  std::vector<Piece> solids = split_pieces(*built.body.mesh);
  std::vector<Body> parts(solids.size(), built.body);
  if (parts.size() > 1) {
    record.messages.push_back(
        fmt::format("{}: {} separate solids become {} bodies", built.body.name, parts.size(), parts.size()));
    for (std::size_t k = 0; k < parts.size(); ++k) {
      parts[k].mesh = std::make_shared<SurfaceMesh>(std::move(solids[k].mesh));
      parts[k].name = fmt::format("{}_{}", built.body.name, k);
    }
    inherit_motion(built.body, parts);
  }
  for (Body& part : parts) {
    part.id = part.parent = BodyId{next_id++};
    if (part.breakable && scene.fracture.enabled) require_solvable(part, built.edge_length);
    const RootScale root{built.edge_length, part.mass.volume, bounding_box(*part.mesh).diagonal(),
                         scene.bodies[scene_body].edge_per_thickness};
    companions.push_back({.solid = std::make_shared<Solid>(part.mesh, root), .scene_body = scene_body});
    bodies.push_back(std::move(part));
    if (!bodies.back().breakable || !scene.fracture.enabled) continue;
    for (const std::string& w : record_mesh(bodies.size() - 1).warnings)
      pending_warnings.push_back(bodies.back().name + ": " + w);
  }
}

const MeshRecord& Simulation::Impl::record_mesh(std::size_t i) {
  Companion& companion = companions[i];
  if (companion.mesh == kUnrecorded) {
    const SurfaceMesh& mesh = companion.solid->mesh();
    const ResolutionRule& rule = resolution_rule(scene.solver);
    MeshRecord m;
    m.step = steps, m.body = bodies[i].name, m.body_id = bodies[i].id.value, m.triangles = mesh.triangle_count();
    m.rule = &rule, m.resolution = resolution_report(mesh, rule), m.warnings = resolution_warnings(m.resolution, rule);
    companion.mesh = record.meshes.size();
    record.meshes.push_back(std::move(m));
  }
  return record.meshes[companion.mesh];
}

Real Simulation::Impl::curvature_at(BodyId id, const Vec3& world_point) {
  const std::size_t i = index_of(id);
  Solid& solid = *companions[i].solid;
  return curvature_radius(solid.mesh(), solid.twins(), solid.bvh(), to_material(bodies[i], world_point));
}

std::vector<BodyContact> Simulation::Impl::loads_on(std::size_t i) {
  std::vector<BodyContact> loads;
  const Body& body = bodies[i];
  for (const Contact& c : contacts) {
    if ((c.a != body.id && c.b != body.id) || norm2(c.impulse) == 0) continue;
    const BodyId other = c.a == body.id ? c.b : c.a;
    Real radius = curvature_at(body.id, c.point);
    if (other != kGround) radius = 1 / (1 / radius + 1 / curvature_at(other, c.point));
    loads.push_back(body_contact(body, other == kGround ? nullptr : &bodies[index_of(other)], c, radius,
                                 companions[i].solid->diagonal(), load_options()));
  }
  return loads;
}

std::string Simulation::Impl::cannot_break(std::size_t i) const {
  const Body& body = bodies[i];
  if (!scene.fracture.enabled) return "fracture is off";
  if (body.fixed || !body.breakable) return "unbreakable";
  if (body.generation >= scene.fracture.max_generation) return "last generation";
  if (bodies.size() >= static_cast<std::size_t>(scene.fracture.max_fragments)) return "fragment limit";
  if (companions[i].solid->mesh().triangle_count() < 20) return "too small";
  if (companions[i].failed_solves >= kMaxFailedSolves) return "its stress could not be solved";
  return {};
}

std::string Simulation::Impl::too_light(std::size_t i, Real force, Real pressure) const {
  const Real strength = bodies[i].material.strength, wall = companions[i].solid->thickness();
  if (force < kBendingShare * strength * wall * wall && pressure < kPressureShare * strength)
    return "load below strength";
  const Real needed = companions[i].solid->partial.empty() ? strength : bodies[i].material.propagation_strength;
  if (companions[i].stress_per_force > 0 && kLearnedShare * companions[i].stress_per_force * force < needed)
    return "load below what earlier ones bore";
  return {};
}

std::string Simulation::Impl::reason_to_skip(std::size_t i, std::vector<BodyContact>& loads) {
  // Cheapest questions first: most bodies of a heap only rest.
  Real impulse = 0, largest = 0;
  for (const Contact& c : contacts)
    if (c.a == bodies[i].id || c.b == bodies[i].id)
      impulse += norm(c.impulse), largest = std::max(largest, norm(c.impulse));
  if (impulse == 0) return "no contact";
  if (std::string reason = cannot_break(i); !reason.empty()) return reason;
  const ContactLoadOptions options = load_options();
  const auto disc = [](Real radius) { return std::numbers::pi * radius * radius; };
  const Real shortest = shortest_duration(options),
             area = disc(smallest_patch(companions[i].solid->diagonal(), options));
  if (std::string reason = too_light(i, impulse / shortest, largest / shortest / area); !reason.empty()) return reason;
  loads = loads_on(i);
  Real force = 0, pressure = 0;
  for (const BodyContact& c : loads)
    force += norm(c.force), pressure = std::max(pressure, norm(c.force) / disc(c.patch_radius));
  return too_light(i, force, pressure);
}

FractureOptions Simulation::Impl::fracture_options(std::size_t i) const {
  const Body& body = bodies[i];
  FractureOptions o;
  o.elastic = elastic_options(scene.solver);
  o.strength = body.material.strength;
  o.propagation_strength = body.material.propagation_strength;
  // The default follows the scene body, not the fragment, so that all cracks of a body look alike.
  o.thickness =
      body.material.crack_thickness > 0 ? body.material.crack_thickness : 1e-3 * companions[i].solid->root().diagonal;
  o.speed = scene.fracture.speed;
  o.net_section = scene.fracture.net_section;
  o.max_cracks = scene.fracture.max_cracks;
  o.max_pieces = static_cast<std::size_t>(scene.fracture.max_fragments) - bodies.size() + 1;
  o.min_fragment_volume = scene.fracture.min_fragment_volume;
  o.first_crack_id = next_crack;
  return o;
}

void Simulation::Impl::apply_shapes(std::size_t i, FractureResult& result, EventRecord& event) {
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
    auto solid = clean_kept ? companion.solid : std::make_shared<Solid>(shape.clean, companion.solid->root());
    solid->partial = std::move(shape.partial);
    solids.push_back({.solid = std::move(solid),
                      .scene_body = companion.scene_body,
                      .mesh = clean_kept ? companion.mesh : kUnrecorded,
                      .last_solve = companion.last_solve,
                      .failed_solves = clean_kept ? companion.failed_solves : 0,
                      .stress_per_force = clean_kept ? companion.stress_per_force : 0});
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

bool Simulation::Impl::fracture(std::size_t i, std::vector<BodyContact>&& loads, StepRecord& step) {
  const Body& body = bodies[i];
  Solid& solid = *companions[i].solid;
  companions[i].last_solve = steps;
  // Mass of the clean mesh, the one the load must balance on; its density makes up for the notches of the shown one.
  MassProperties mass = mass_properties(solid.mesh(), 1);
  const Real density = body.mass.mass / mass.volume;
  mass.mass = body.mass.mass, mass.inertia *= density;
  const Vec3 omega = rotate(conjugate(body.pose.orientation), body.angular_velocity);
  const Elastic material{shear_modulus(body.material), body.material.poisson};
  EventRecord event;
  event.step = steps, event.time = time(), event.body = body.name, event.body_id = body.id.value;
  record_mesh(i);
  event.mesh = companions[i].mesh;
  event.result = fracture_solid(solid, mass, material, loads, omega, fracture_options(i));
  Real force = 0;
  for (const BodyContact& c : loads) force += norm(c.force);
  if (!event.result.solved) ++companions[i].failed_solves;
  if (event.result.solved)
    companions[i].stress_per_force =
        std::max(companions[i].stress_per_force, event.result.strongest.stress.value / force);
  event.contacts = std::move(loads);
  for (const CrackRecord& c : event.result.cracks) next_crack = std::max(next_crack, c.id + 1);
  next_crack +=
      static_cast<std::int32_t>(event.result.shapes.size());  // ids used for stopped cracks that split a piece
  ++step.solves, step.solver_iterations += static_cast<std::size_t>(event.result.krylov.iterations);
  step.cracks += event.result.cracks.size();
  report(event);
  const bool changed = event.result.changed;
  if (changed) apply_shapes(i, event.result, event);
  step.fragments += event.new_bodies.size();
  event.result.shapes.clear();
  record.events.push_back(std::move(event));
  return changed;
}

void Simulation::Impl::report(const EventRecord& event) {
  const FractureResult& r = event.result;
  if (!r.solved)
    pending.push_back(fmt::format("{:.3f} s: {}: no stress under this impact: {}", event.time, event.body, r.reason));
  else if (r.shapes.size() > 1)
    pending.push_back(fmt::format("{:.3f} s: {} breaks into {} pieces (tension up to {:.3g} MPa)", event.time,
                                  event.body, r.shapes.size(), r.strongest.stress.value * 1e-6));
  else if (r.changed)
    pending.push_back(fmt::format("{:.3f} s: {} cracks (tension up to {:.3g} MPa)", event.time, event.body,
                                  r.strongest.stress.value * 1e-6));
}

// Frees the operators solved longest ago until the rest fits the budget.
void Simulation::Impl::limit_operators() {
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

void Simulation::Impl::advance() {
  StepRecord step;
  RigidStats stats;
  {
    const Stopwatch watch(step.rigid_seconds);
    rigid_step(bodies, ground, rigid, cache, rigid_state, contacts, stats);
  }
  ++steps;
  step.step = steps, step.time = time();
  step.pairs_near = stats.contact.pairs_near, step.contacts = contacts.size(),
  step.fields_built = stats.contact.fields_built;
  step.contact_iterations = stats.iterations, step.asleep = stats.asleep;
  {
    const Stopwatch watch(step.fracture_seconds);
    // By id: bodies shift while fragments replace their parents, and fragments of this step carry no contact yet.
    struct Due {
      BodyId id;
      std::vector<BodyContact> loads;
    };
    std::vector<Due> due;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      std::vector<BodyContact> loads;
      if (const std::string reason = reason_to_skip(i, loads); !reason.empty())
        ++step.skipped[reason];
      else
        due.push_back({bodies[i].id, std::move(loads)});
    }
    for (Due& d : due) fracture(index_of(d.id), std::move(d.loads), step);
    limit_operators();
  }
  step.bodies = bodies.size();
  for (const Body& b : bodies) step.triangles += b.mesh->triangle_count();
  record.steps.push_back(std::move(step));
}

Simulation::Simulation(const Scene& scene, const SimulationOptions& options)
    : impl_(std::make_unique<Impl>(scene, options)) {}
Simulation::~Simulation() = default;

bool Simulation::done() const {
  return impl_->time() >= impl_->scene.duration - 0.5 * impl_->scene.time_step;
}
void Simulation::step() {
  impl_->advance();
}
Real Simulation::time() const {
  return impl_->time();
}

std::size_t Simulation::frame_count() const {
  return static_cast<std::size_t>(std::floor(impl_->scene.duration * impl_->scene.frame_rate + 1e-9)) + 1;
}

bool Simulation::frame_due() const {
  const Real next = static_cast<Real>(impl_->frames_served) / impl_->scene.frame_rate;
  return impl_->frames_served < frame_count() && impl_->time() >= next - 0.5 * impl_->scene.time_step;
}

Frame Simulation::snapshot() {
  Frame frame;
  frame.index = impl_->frames_served++;
  frame.time = impl_->time();
  impl_->last_frame_roots.clear();
  for (std::size_t i = 0; i < impl_->bodies.size(); ++i) {
    const Body& b = impl_->bodies[i];
    const std::size_t scene_index = impl_->companions[i].scene_body;
    const SceneBody& s = impl_->scene.bodies[scene_index];
    impl_->last_frame_roots.push_back(scene_index);
    FrameBody f;
    f.id = b.id.value, f.name = b.name, f.mesh = b.mesh, f.mesh_version = b.mesh_version;
    f.parent = b.parent == b.id ? kNone : b.parent.value;
    f.rotation = to_matrix(b.pose.orientation);
    f.translation = b.pose.position - f.rotation * b.mass.centre;
    f.colour = s.colour ? to_colour(*s.colour) : palette(scene_index);
    f.crack_colour = s.crack_colour ? to_colour(*s.crack_colour) : Colour{0.62f, 0.30f, 0.20f};
    frame.bodies.push_back(std::move(f));
  }
  impl_->last_frame = frame;
  return frame;
}

Frame Simulation::material_snapshot() const {
  Frame frame = impl_->last_frame;
  const std::size_t shown = impl_->scene.output.material_view.value_or(0);
  frame.bodies.clear();
  for (std::size_t i = 0; i < impl_->last_frame.bodies.size(); ++i) {
    if (impl_->last_frame_roots[i] != shown) continue;
    frame.bodies.push_back(impl_->last_frame.bodies[i]);
    frame.bodies.back().rotation = Mat3::identity(), frame.bodies.back().translation = Vec3{};
    frame.bodies.back().opacity = 0.35f;
  }
  return frame;
}

View Simulation::view() const {
  const Scene& s = impl_->scene;
  View v;
  v.width = s.output.width, v.height = s.output.height, v.samples = s.output.samples;
  v.field_of_view = s.camera.field_of_view, v.up = s.camera.up;
  v.light = s.light.direction;
  v.ground = s.ground.enabled, v.ground_height = s.ground.height;
  if (!s.camera.automatic) {
    v.eye = s.camera.eye, v.target = s.camera.target;
    return v;
  }
  Box box = impl_->start_box;
  if (s.ground.enabled) {  // and where they fall, with room for the pieces to spread
    const Real size = box.diagonal();
    box.low.y = std::min(box.low.y, s.ground.height);
    const Vec3 c = box.centre();
    box.grow(Vec3{c.x - 0.6 * size, s.ground.height, c.z - 0.4 * size});
    box.grow(Vec3{c.x + 0.6 * size, s.ground.height, c.z + 0.4 * size});
  }
  return frame_box(box, v);
}

View Simulation::material_view() const {
  View v;
  v.width = impl_->scene.output.width, v.height = impl_->scene.output.height, v.samples = impl_->scene.output.samples;
  v.light = impl_->scene.light.direction;
  v.ground = false;
  v.sky_colour = {0.93f, 0.94f, 0.95f};
  Box box;
  for (const FrameBody& b : material_snapshot().bodies) box.grow(bounding_box(*b.mesh));
  return frame_box(box, v);
}

std::string Simulation::stats_json() const {
  return to_json(impl_->record);
}
std::vector<std::string> Simulation::take_messages() {
  return std::exchange(impl_->pending, {});
}
std::vector<std::string> Simulation::take_warnings() {
  return std::exchange(impl_->pending_warnings, {});
}

}  // namespace sherd
