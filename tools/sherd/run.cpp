#include <algorithm>
#include <charconv>
#include <cmath>
#include <exception>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "engine/step/checkpoint.h"
#include "engine/step/simulation.h"
#include "engine/step/stats.h"
#include "kernels/core/error.h"
#include "kernels/core/file.h"
#include "kernels/core/trace.h"
#include "tools/sherd/commands.h"
#include "tools/sherd/identity.h"
#include "tools/sherd/progress.h"
#include "tools/sherd/run_writer.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;

// When checkpoints are due: each time so many steps, or so much simulated time, lie behind.
class Cadence {
 public:
  Cadence(const CheckpointEvery& every, Real time_step) : every_(every), time_step_(time_step) {}
  bool due(std::size_t step) const { return step > 0 && mark(step) > mark(step - 1); }

 private:
  std::size_t mark(std::size_t step) const {
    if (every_.steps > 0) return step / every_.steps;
    if (!(every_.seconds > 0)) return 0;
    return static_cast<std::size_t>(std::floor(static_cast<Real>(step) * time_step_ / every_.seconds + 1e-9));
  }
  CheckpointEvery every_;
  Real time_step_;
};

// One run into one folder: simulation, writer, checkpoints.
struct Run {
  const RunOptions& options;
  const Scene& scene;
  fs::path folder;
  RunIdentity identity;
  std::size_t frame_limit = 0;
  std::unique_ptr<Simulation> simulation;
  std::unique_ptr<RunWriter> writer;

  void keep() {
    write_checkpoint(folder, {identity, simulation->steps(), simulation->time(), simulation->state(), writer->state()});
  }
};

// The run in the folder as its last whole checkpoint has it; nothing when there is none, or the run is complete.
std::optional<Checkpoint> last_checkpoint(const Run& run, Progress& progress) {
  FoundCheckpoint found = find_checkpoint(run.folder);
  for (const std::string& line : found.damaged) progress.warn(line + "; going on from the one before");
  if (!found.checkpoint) return std::nullopt;
  require_same_run(run.folder, found.checkpoint->identity, run.identity);
  return std::move(found.checkpoint);
}

// What its statistics say, which are written at the end alone, before the checkpoints go. Throws InputError when they
// are of another scene.
bool is_complete(const Run& run) {
  const fs::path file = run.folder / "stats.json";
  std::error_code none;
  if (!fs::exists(file, none)) return false;
  const auto stats = nlohmann::json::parse(read_bytes(file), nullptr, false);
  if (!stats.is_object() || !stats.contains("scene_digest") ||
      stats.at("scene_digest") != digest_text(run.scene.digest))
    throw InputError(
        fmt::format("{}: is of another scene than {}; choose another folder with --out, or start anew, "
                    "without --resume",
                    file.string(), run.scene.file.string()));
  return stats.value("complete", false);
}

// Meshes are read and repaired here: nothing is written for a scene that cannot run.
void open(Run& run, const std::optional<Checkpoint>& from, Progress& progress) {
  const SimulationOptions options{.threads = run.options.threads};
  try {
    run.simulation = from ? std::make_unique<Simulation>(run.scene, options, from->simulation)
                          : std::make_unique<Simulation>(run.scene, options);
    run.writer = std::make_unique<RunWriter>(run.scene.output, run.scene.frame_rate, run.folder, run.options.render,
                                             from ? std::string_view(from->writer) : std::string_view());
  } catch (const ArchiveError& e) {  // its bytes are those that were written: it must be the layout
    throw InternalError(fmt::format("{}: the checkpoint cannot be taken up ({})", run.folder.string(), e.what()));
  }
  if (!run.scene.skip[Skip::kUploads]) run.writer->upload_always();
  if (!from) return;
  progress.begin_at(from->time);
  progress.note(fmt::format("going on at {:.3f} s, step {}", from->time, from->step));
}

// At each due frame (the start is one) a snapshot goes to the writer, until the end, the frame limit or Ctrl-C.
void simulate(Run& run, Progress& progress) {
  Simulation& simulation = *run.simulation;
  RunWriter& writer = *run.writer;
  const bool material = writer.draws() && run.scene.output.material_view.has_value();
  const Cadence cadence(run.options.checkpoint_every, run.scene.time_step);
  const std::size_t first = simulation.steps();
  View view = simulation.view();
  view.wireframe |= run.options.wireframe;
  for (;;) {
    for (const std::string& message : simulation.take_messages()) progress.note(message);
    for (const std::string& warning : simulation.take_warnings()) progress.warn(warning);
    if (simulation.frame_due() && writer.frames() < run.frame_limit) {
      const Frame frame = simulation.snapshot();
      writer.add(frame, view);
      if (material) {
        View material_view = simulation.material_view();
        material_view.wireframe |= run.options.wireframe;
        writer.add_material(simulation.material_snapshot(), material_view);
      }
    }
    progress.update(simulation.time(), simulation.bodies(), writer.frames());
    if (simulation.done() || interrupted() || writer.frames() >= run.frame_limit) return;
    if (simulation.steps() > first && cadence.due(simulation.steps())) run.keep();
    simulation.step();
  }
}

// Written at the end, and empty at the start, so that a wrong path does not cost a run.
class TraceFile {
 public:
  explicit TraceFile(const fs::path& path) : path_(path) {
    if (path_.empty()) return;
    replace_file(path_, chrome_trace({}));
    trace_.emplace();
  }
  void finish(Progress& progress) {
    if (!trace_) return;
    replace_file(path_, chrome_trace(trace_->events()));
    progress.note(fmt::format("trace:      {}", path_.string()));
  }

 private:
  fs::path path_;
  std::optional<Trace> trace_;
};

// A range is of the scene's own field.
void show_field(SceneOutput& output, FieldKind kind) {
  if (output.field && output.field->kind == kind) return;
  SceneField field = output.field.value_or(SceneField{});
  field.kind = kind;
  field.range.reset();
  output.field = field;
}

Scene scene_of(const RunOptions& options) {
  Scene scene = load_scene(options.scene, options.quality);
  if (options.field) show_field(scene.output, *options.field);
  for (const SkipSwitch& s : kSkipSwitches)
    for (const std::string& key : options.no_skip)
      if (key == "all" || key == s.key) scene.skip.set(s.skip, false);
  return scene;
}

// What there is so far is written also after a failure, which then goes on.
void finish(Run& run, std::exception_ptr failure, Progress& progress) {
  try {
    // A run that can go on leaves what it takes.
    if (!failure && !run.simulation->done() && (interrupted() || run.options.checkpoint_every.wanted())) run.keep();
    for (const std::string& line : run.writer->finish(run.simulation->stats_json())) progress.note(line);
    if (!failure && run.simulation->done()) remove_checkpoints(run.folder);
  } catch (...) {
    if (!failure) throw;
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace

CheckpointEvery parse_checkpoint_every(const std::string& text) {
  CheckpointEvery every;
  const char* end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, every.steps);
  if (error == std::errc{} && last == end && every.steps > 0) return every;
  every.steps = 0;
  const auto [stop, wrong] = std::from_chars(text.data(), end, every.seconds);
  if (wrong == std::errc{} && std::string_view(stop, end) == "s" && every.seconds > 0 && std::isfinite(every.seconds))
    return every;
  throw InputError(fmt::format(
      "--checkpoint-every: value '{}' not allowed; give steps (20) or simulated seconds (0.1s), above 0", text));
}

int run_command(const RunOptions& options) {
  catch_interrupts();
  TraceFile trace(options.trace);
  const Scene scene = scene_of(options);
  const bool limited = options.frames > 0;
  const Real duration =
      limited ? std::min(scene.duration, static_cast<Real>(options.frames) / scene.frame_rate) : scene.duration;
  Progress progress(duration, options.quiet);
  Run run{options,
          scene,
          options.out.empty() ? fs::path("out") / options.scene.stem() : options.out,
          {program_identity(), scene.digest, options_identity(options)},
          limited ? static_cast<std::size_t>(options.frames) : std::numeric_limits<std::size_t>::max(),
          nullptr,
          nullptr};
  std::optional<Checkpoint> from;
  if (options.resume) {
    from = last_checkpoint(run, progress);
    if (!from && is_complete(run)) {
      progress.note(fmt::format("{}: the run is complete; to run it again, leave out --resume", run.folder.string()));
      return kSuccess;
    }
    if (!from) progress.note(fmt::format("{}: no checkpoint yet; starting at 0 s", run.folder.string()));
  }
  open(run, from, progress);
  std::exception_ptr failure;
  try {
    simulate(run, progress);
  } catch (...) {
    failure = std::current_exception();
  }
  finish(run, failure, progress);
  trace.finish(progress);
  if (!interrupted()) return kSuccess;
  progress.note("ended early by a signal; everything so far is on disk, --resume goes on");
  return kInterrupted;
}

}  // namespace sherd
