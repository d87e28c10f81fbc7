#include "engine/step/world.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/fracture/guide.h"
#include "engine/fragment/pieces.h"
#include "engine/step/elastic_settings.h"
#include "engine/step/inherit.h"
#include "engine/step/stopwatch.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

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

std::vector<HeldLoad> held_loads(const Scene& scene, std::size_t scene_body, const SurfaceMesh& mesh) {
  std::vector<HeldLoad> held;
  for (std::size_t k = 0; k < scene.loads.size(); ++k) {
    const SceneLoad& s = scene.loads[k];
    if (s.body != scene_body) continue;
    const AppliedLoad load{s.region, s.facing, s.force, s.moment, s.from, s.until};
    try {
      held.push_back({load, spread(mesh, load)});
    } catch (const InputError& e) {
      throw InputError(fmt::format("{}: body \"{}\", load {}: {}", scene.file.string(), scene.bodies[scene_body].name,
                                   k + 1, e.what()));
    }
  }
  return held;
}

}  // namespace

World::World(const Scene& s, int thread_count) : scene(s), threads(thread_count) {
  record.scene = s.file.filename().string(), record.scene_digest = s.digest;
  record.quality = kQualityNames[static_cast<std::size_t>(s.quality)];
  record.threads = thread_count;
  record.skip = s.skip;
  const Stopwatch watch(record.prepare_seconds, "prepare");
  for (std::size_t i = 0; i < s.bodies.size(); ++i) add_body(i);
  ground = {s.ground.enabled, s.ground.height, s.ground.restitution, s.ground.friction};
  rigid.dt = s.time_step, rigid.gravity = s.gravity;
  if (!s.skip[Skip::kSleep]) rigid.sleep_speed = 0;
  if (s.output.field) record.field = field_scale(*s.output.field);
  pending = record.messages;
  start_box = world_box();
  prepared = kDigestStart;
  for (const Body& b : bodies) record.start_volume += b.mass.volume, prepared = digest(*b.mesh, prepared);
}

void World::start() {
  const Stopwatch watch(record.prepare_seconds, "prepare");
  StepRecord first;
  run_guides(first);
  if (first.cracks > 0) record.steps.push_back(std::move(first));
}

void World::keep(Archive& a) {
  const std::uint64_t here = prepared;
  const Real prepare_seconds = record.prepare_seconds;
  const int thread_count = record.threads;
  if (!a.reading()) contact_history = cache.history();
  archive(a, static_cast<RunState&>(*this));
  if (!a.reading()) return;
  if (prepared != here)
    throw InputError(
        "the meshes of the bodies come out otherwise than when the run began: a file they are read from has changed, "
        "or "
        "this machine computes differently; start anew, without --resume");
  cache.restore(bodies, contact_history);
  record.prepare_seconds += prepare_seconds;
  record.scene = scene.file.filename().string();
  record.threads = thread_count;
}

Box World::world_box() const {
  Box box;
  for (const Body& b : bodies)
    for (std::size_t v = 0; v < b.mesh->vertex_count(); ++v) box.grow(to_world(b, b.mesh->vertices[v]));
  return box;
}

std::size_t World::index_of(BodyId id) const {
  const auto it = std::find_if(bodies.begin(), bodies.end(), [&](const Body& b) { return b.id == id; });
  SHERD_CHECK(it != bodies.end(), "no body {}", id.value);
  return static_cast<std::size_t>(it - bodies.begin());
}

void World::add_body(std::size_t scene_body) {
  const SceneBody& s = scene.bodies[scene_body];
  BuiltBody built = build_body(s, BodyId{0});
  Root root{scene_fields(s, *built.body.mesh), {}};
  guided.emplace_back(s.cracks.size(), false);
  if (!s.cracks.empty()) {
    const TriangleBvh bvh(*built.body.mesh);
    for (const SceneCrack& crack : s.cracks) root.guides.push_back(pinned(scene_guide(s, crack, built.messages), bvh));
  }
  for (const std::string& m : built.messages) record.messages.push_back(built.body.name + ": " + m);
  roots.push_back(std::move(root));
  add_solids(built, scene_body, held_loads(scene, scene_body, *built.body.mesh));
}

void World::add_solids(const BuiltBody& built, std::size_t scene_body, const std::vector<HeldLoad>& loads) {
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
    companions.push_back({.solid = std::make_shared<Solid>(part.mesh, root), .scene_body = scene_body, .loads = loads});
    bodies.push_back(std::move(part));
    if (!bodies.back().breakable || !scene.fracture.enabled) continue;
    for (const std::string& w : record_mesh(bodies.size() - 1).warnings)
      pending_warnings.push_back(bodies.back().name + ": " + w);
  }
}

const MeshRecord& World::record_mesh(std::size_t i) {
  Companion& companion = companions[i];
  if (companion.mesh == Companion::kUnrecorded) {
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

void World::certify_frame(std::size_t index) {
  const Stopwatch watch(record.certify_seconds, "certify");
  FrameRecord frame;
  frame.index = index, frame.time = time();
  Real clean = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Body& b = bodies[i];
    const std::size_t at = record.certificate_of(b.id.value, b.mesh_version, b.name, *b.mesh);
    const MeshCertificate& c = record.certificates[at].certificate;
    frame.certificates.push_back(at);
    frame.valid += c.ok();
    frame.volume += c.volume;
    clean += companions[i].solid->mesh_volume();
  }
  frame.notches = clean - frame.volume;
  for (const EventRecord& e : record.events) {
    const FractureResult& r = e.result;
    frame.removed += r.removed_volume, frame.dust += r.dust_volume, frame.remeshing += r.remeshing_volume;
  }
  const Real expected = record.start_volume - frame.removed - frame.dust + frame.remeshing;
  frame.volume_error = std::abs(clean - expected) / record.start_volume;
  record.frames.push_back(std::move(frame));
}

}  // namespace sherd
