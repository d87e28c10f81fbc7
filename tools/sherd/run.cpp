#include <algorithm>
#include <exception>
#include <fstream>
#include <limits>
#include <optional>

#include "engine/step/simulation.h"
#include "kernels/core/error.h"
#include "kernels/core/trace.h"
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

// Written at the end; the file is opened at the start, so that a wrong path does not cost a run.
class TraceFile {
 public:
  explicit TraceFile(const std::filesystem::path& path) : path_(path) {
    if (path_.empty()) return;
    stream_.open(path_, std::ios::binary);
    if (!stream_) throw InputError(fmt::format("{}: cannot be written; choose a folder that exists", path_.string()));
    trace_.emplace();
  }
  // Says where the trace is; nothing when none was asked for.
  std::optional<std::string> finish() {
    if (!trace_) return std::nullopt;
    stream_ << chrome_trace(trace_->events());
    stream_.flush();
    if (!stream_) throw InputError(fmt::format("{}: cannot be written; is the disk full?", path_.string()));
    return fmt::format("trace:      {}", path_.string());
  }

 private:
  std::filesystem::path path_;
  std::ofstream stream_;
  std::optional<Trace> trace_;
};

}  // namespace

int run_command(const RunOptions& options) {
  catch_interrupts();
  TraceFile trace(options.trace);
  Scene scene = load_scene(options.scene);
  for (const SkipSwitch& s : kSkipSwitches)
    for (const std::string& key : options.no_skip)
      if (key == "all" || key == s.key) scene.skip.set(s.skip, false);
  // Meshes are read and repaired here: nothing is written for a scene that cannot run.
  Simulation simulation(scene, {.threads = options.threads});
  const std::filesystem::path folder =
      options.out.empty() ? std::filesystem::path("out") / options.scene.stem() : options.out;
  RunWriter writer(scene.output, scene.frame_rate, folder, options.render);
  if (!scene.skip[Skip::kUploads]) writer.upload_always();
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
  if (const auto line = trace.finish()) progress.note(*line);
  if (failure) std::rethrow_exception(failure);
  if (!interrupted()) return kSuccess;
  progress.note("ended early by a signal; everything so far is on disk");
  return kInterrupted;
}

}  // namespace sherd
