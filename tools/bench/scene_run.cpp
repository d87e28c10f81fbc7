// A process a run, so that its time and memory are its own.
#include <algorithm>
#include <filesystem>

#include "kernels/core/error.h"
#include "kernels/core/file.h"
#include "tools/bench/process.h"
#include "tools/bench/scenes.h"

namespace sherd::bench {
namespace {

namespace fs = std::filesystem;

void count_solve(const nlohmann::json& solve, SceneNumbers& n) {
  const int iterations = solve["iterations"];
  n.least_iterations = n.solves == 0 ? iterations : std::min(n.least_iterations, iterations);
  n.most_iterations = std::max(n.most_iterations, iterations);
  ++n.solves;
  const std::size_t triangles = solve["triangles"];
  if (triangles > n.largest) n.largest = triangles, n.unknowns = solve["unknowns"];
}

}  // namespace

std::string scene_file(const ScenesOptions& o, const std::string& name) {
  for (const fs::path& file : {fs::path(o.folder) / (name + ".toml"), fs::path(name)})
    if (fs::is_regular_file(file)) return file.string();
  throw InputError(fmt::format("{}: no such scene in {}; name the folder with --folder", name, o.folder));
}

SceneRun run_scene(const ScenesOptions& o, const std::string& scene, const std::string& quality, int threads,
                   const std::vector<std::string>& no_skip) {
  const TemporaryFolder folder;
  SceneRun run{scene, quality, threads, no_skip, 0, 0, 0, 0, {}};
  std::vector<std::string> words{sherd_program(o.program),
                                 "run",
                                 scene_file(o, scene),
                                 "--out",
                                 folder.path.string(),
                                 "--no-render",
                                 "--quiet",
                                 "--quality",
                                 quality,
                                 "--threads",
                                 std::to_string(threads)};
  if (o.frames > 0) words.insert(words.end(), {"--frames", std::to_string(o.frames)});
  for (const std::string& key : no_skip) words.insert(words.end(), {"--no-skip", key});
  const ProcessResult process = run_process(words);
  run.exit_code = process.exit_code;
  run.wall_s = process.wall_s, run.cpu_s = process.cpu_s, run.peak_bytes = process.peak_bytes;
  const fs::path file = folder.path / "stats.json";
  if (std::error_code none; fs::exists(file, none)) run.stats = nlohmann::json::parse(read_bytes(file), nullptr, false);
  if (run.exit_code == 0 && !run.stats.is_object()) run.exit_code = -1;
  return run;
}

SceneNumbers scene_numbers(const nlohmann::json& stats) {
  SceneNumbers n;
  std::size_t event_steps = 0;
  double first_assembly = 0;
  for (const auto& event : stats["events"]) {
    const std::size_t before = n.largest;
    if (event.contains("solve")) count_solve(event["solve"], n);
    if (n.largest > before)
      first_assembly = event["seconds"]["assemble"].get<double>() + event["seconds"]["solve"].get<double>();
    if (event.contains("later_solves"))
      for (const auto& solve : event["later_solves"]) count_solve(solve, n);
    for (const auto& crack : event["cracks"]) event_steps += crack["steps"].get<std::size_t>();
  }
  const auto& s = stats["seconds"];
  const auto per = [](double total, std::size_t count) { return count > 0 ? total / static_cast<double>(count) : 0; };
  n.first_solve_s = first_assembly;
  n.solve_s = per(s["assemble"].get<double>() + s["solve"].get<double>(), n.solves);
  n.steps = event_steps;
  n.stress_s = per(s["front"].get<double>(), n.steps);
  n.crack_s = per(s["grow"].get<double>() + s["cut"].get<double>() + s["remesh"].get<double>(), n.steps);
  n.skipped = stats["skips"]["load_bounds"]["skipped"];
  if (!stats["steps"].empty()) n.triangles = stats["steps"][0]["triangles"];
  n.bodies = stats["totals"]["bodies"];
  return n;
}

}  // namespace sherd::bench
