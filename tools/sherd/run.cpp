#include <algorithm>
#include <exception>
#include <limits>

#include "engine/step/simulation.h"
#include "tools/sherd/commands.h"
#include "tools/sherd/progress.h"
#include "tools/sherd/run_writer.h"

namespace sherd {
namespace {

// At each due frame (the start is one) a snapshot goes to the writer, until the end, the frame limit or Ctrl-C.
void simulate(Simulation& simulation, RunWriter& writer, std::size_t frame_limit, bool material, bool wireframe,
              Progress& progress) {
  View view = simulation.view();
  view.wireframe |= wireframe;
  std::size_t bodies = 0;
  for (;;) {
    for (const std::string& message : simulation.take_messages()) progress.note(message);
    for (const std::string& warning : simulation.take_warnings()) progress.warn(warning);
    if (simulation.frame_due()) {
      const Frame frame = simulation.snapshot();
      bodies = frame.bodies.size();
      writer.add(frame, view);
      if (material) {
        View material_view = simulation.material_view();
        material_view.wireframe |= wireframe;
        writer.add_material(simulation.material_snapshot(), material_view);
      }
    }
    progress.update(simulation.time(), bodies, writer.frames());
    if (simulation.done() || interrupted() || writer.frames() >= frame_limit) return;
    simulation.step();
  }
}

// A range is of the scene's own field.
void show_field(SceneOutput& output, FieldKind kind) {
  if (output.field && output.field->kind == kind) return;
  SceneField field = output.field.value_or(SceneField{});
  field.kind = kind;
  field.range.reset();
  output.field = field;
}

}  // namespace

int run_command(const RunOptions& options) {
  catch_interrupts();
  Scene scene = load_scene(options.scene, options.quality);
  if (options.field) show_field(scene.output, *options.field);
  // Meshes are read and repaired here: nothing is written for a scene that cannot run.
  Simulation simulation(scene, {.threads = options.threads});
  const std::filesystem::path folder =
      options.out.empty() ? std::filesystem::path("out") / options.scene.stem() : options.out;
  RunWriter writer(scene.output, scene.frame_rate, folder, options.render);
  const bool limited = options.frames > 0;
  const std::size_t frame_limit =
      limited ? static_cast<std::size_t>(options.frames) : std::numeric_limits<std::size_t>::max();
  const Real duration =
      limited ? std::min(scene.duration, static_cast<Real>(options.frames) / scene.frame_rate) : scene.duration;
  Progress progress(duration, options.quiet);
  std::exception_ptr failure;
  try {
    simulate(simulation, writer, frame_limit, writer.draws() && scene.output.material_view.has_value(),
             options.wireframe, progress);
  } catch (...) {
    failure = std::current_exception();  // what there is so far is written before it goes on
  }
  for (const std::string& line : writer.finish(simulation.stats_json())) progress.note(line);
  if (failure) std::rethrow_exception(failure);
  if (!interrupted()) return kSuccess;
  progress.note("ended early by a signal; everything so far is on disk");
  return kInterrupted;
}

}  // namespace sherd
