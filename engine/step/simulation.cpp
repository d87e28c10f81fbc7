#include "engine/step/simulation.h"

#include <algorithm>
#include <utility>

#include "engine/step/framing.h"
#include "engine/step/world.h"

namespace sherd {
namespace {

Colour palette(std::size_t i) {
  static const Colour colours[] = {{0.82f, 0.76f, 0.68f}, {0.62f, 0.72f, 0.74f}, {0.74f, 0.63f, 0.56f},
                                   {0.66f, 0.70f, 0.60f}, {0.72f, 0.66f, 0.74f}, {0.78f, 0.72f, 0.55f}};
  return colours[i % std::size(colours)];
}
Colour to_colour(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

struct Simulation::Impl {
  World world;
  // What snapshots leave behind; part of a checkpoint as RunState is.
  struct Frames {
    std::size_t served = 0;
    Frame last;
    std::vector<std::size_t> last_roots;  // scene body of each body of `last`
  } frames;

  Impl(const Scene& scene, const SimulationOptions& options) : world(scene, options.threads) {}

  void keep(Archive& a) {
    archive(a, frames);
    world.keep(a);
  }
};

Simulation::Simulation(const Scene& scene, const SimulationOptions& options)
    : impl_(std::make_unique<Impl>(scene, options)) {
  impl_->world.start();
}
Simulation::Simulation(const Scene& scene, const SimulationOptions& options, std::string_view state)
    : impl_(std::make_unique<Impl>(scene, options)) {
  Archive a(state);
  impl_->keep(a);
  a.finish();
}
Simulation::~Simulation() = default;

bool Simulation::done() const {
  return impl_->world.time() >= impl_->world.scene.duration - 0.5 * impl_->world.scene.time_step;
}
void Simulation::step() {
  impl_->world.advance();
}
Real Simulation::time() const {
  return impl_->world.time();
}

std::size_t Simulation::bodies() const {
  return impl_->world.bodies.size();
}
std::size_t Simulation::steps() const {
  return impl_->world.steps;
}
std::string Simulation::state() {
  Archive a;
  impl_->keep(a);
  return a.take();
}

std::size_t Simulation::frame_count() const {
  return static_cast<std::size_t>(std::floor(impl_->world.scene.duration * impl_->world.scene.frame_rate + 1e-9)) + 1;
}

bool Simulation::frame_due() const {
  const Real next = static_cast<Real>(impl_->frames.served) / impl_->world.scene.frame_rate;
  return impl_->frames.served < frame_count() && impl_->world.time() >= next - 0.5 * impl_->world.scene.time_step;
}

Frame Simulation::snapshot() {
  Frame frame;
  frame.index = impl_->frames.served++;
  impl_->world.certify_frame(frame.index);
  frame.time = impl_->world.time();
  if (const auto& scale = impl_->world.record.field; scale && scale->low < scale->high) frame.scale = scale;
  impl_->frames.last_roots.clear();
  for (std::size_t i = 0; i < impl_->world.bodies.size(); ++i) {
    const Body& b = impl_->world.bodies[i];
    const std::size_t scene_index = impl_->world.companions[i].scene_body;
    const SceneBody& s = impl_->world.scene.bodies[scene_index];
    impl_->frames.last_roots.push_back(scene_index);
    FrameBody f;
    f.id = b.id.value, f.name = b.name, f.mesh = b.mesh, f.mesh_version = b.mesh_version;
    f.parent = b.parent == b.id ? kNone : b.parent.value;
    f.rotation = to_matrix(b.pose.orientation);
    f.translation = b.pose.position - f.rotation * b.mass.centre;
    f.colour = s.colour ? to_colour(*s.colour) : palette(scene_index);
    f.crack_colour = s.crack_colour ? to_colour(*s.crack_colour) : Colour{0.62f, 0.30f, 0.20f};
    if (frame.scale) f.field = impl_->world.companions[i].field;
    frame.bodies.push_back(std::move(f));
  }
  for (const FrameBody& b : frame.bodies) {
    const auto same = [&](const FrameBody& o) { return o.id == b.id && o.mesh_version == b.mesh_version; };
    const bool there = std::any_of(impl_->frames.last.bodies.begin(), impl_->frames.last.bodies.end(), same);
    impl_->world.record.skips.add(Skip::kUploads, there && impl_->world.scene.skip[Skip::kUploads]);
  }
  impl_->frames.last = frame;
  return frame;
}

Frame Simulation::material_snapshot() const {
  Frame frame = impl_->frames.last;
  const std::size_t shown = impl_->world.scene.output.material_view.value_or(0);
  frame.bodies.clear();
  for (std::size_t i = 0; i < impl_->frames.last.bodies.size(); ++i) {
    if (impl_->frames.last_roots[i] != shown) continue;
    frame.bodies.push_back(impl_->frames.last.bodies[i]);
    frame.bodies.back().rotation = Mat3::identity(), frame.bodies.back().translation = Vec3{};
    frame.bodies.back().opacity = 0.35f;
  }
  return frame;
}

View Simulation::view() const {
  const Scene& s = impl_->world.scene;
  View v;
  v.width = s.output.width, v.height = s.output.height, v.samples = s.output.samples;
  v.field_of_view = s.camera.field_of_view, v.up = s.camera.up;
  v.light = s.light.direction;
  v.ground = s.ground.enabled, v.ground_height = s.ground.height;
  if (!s.camera.automatic) {
    v.eye = s.camera.eye, v.target = s.camera.target;
    return v;
  }
  Box box = impl_->world.start_box;
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
  v.width = impl_->world.scene.output.width, v.height = impl_->world.scene.output.height,
  v.samples = impl_->world.scene.output.samples;
  v.light = impl_->world.scene.light.direction;
  v.ground = false;
  v.sky_colour = {0.93f, 0.94f, 0.95f};
  Box box;
  for (const FrameBody& b : material_snapshot().bodies) box.grow(bounding_box(*b.mesh));
  return frame_box(box, v);
}

std::string Simulation::stats_json() const {
  return to_json(impl_->world.record, done());
}
std::vector<std::string> Simulation::take_messages() {
  return std::exchange(impl_->world.pending, {});
}
std::vector<std::string> Simulation::take_warnings() {
  return std::exchange(impl_->world.pending_warnings, {});
}

}  // namespace sherd
