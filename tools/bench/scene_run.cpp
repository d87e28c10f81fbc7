// A process a run, so that its time and memory are its own.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>

#include "kernels/core/error.h"
#include "tools/bench/scenes.h"

namespace sherd::bench {
namespace {

namespace fs = std::filesystem;

std::string program_of(const ScenesOptions& o) {
  const fs::path program =
      o.program.empty() ? fs::read_symlink("/proc/self/exe").parent_path() / "sherd" : fs::path(o.program);
  if (access(program.c_str(), X_OK) != 0)
    throw InputError(fmt::format("{}: no program there; name the command with --program", program.string()));
  return program.string();
}

// Removed with the object.
struct TemporaryFolder {
  fs::path path;
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "sherd-bench-XXXXXX").string();
    SHERD_CHECK(mkdtemp(name.data()) != nullptr, "no temporary folder");
    path = name;
  }
  ~TemporaryFolder() {
    std::error_code error;
    fs::remove_all(path, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
};

// Runs it and waits; the exit code, -1 for a process that a signal ended.
int run_process(const std::vector<std::string>& words, rusage& usage) {
  std::vector<char*> arguments;
  for (const std::string& w : words) arguments.push_back(const_cast<char*>(w.c_str()));
  arguments.push_back(nullptr);
  const pid_t child = fork();
  SHERD_CHECK(child >= 0, "no new process");
  if (child == 0) {
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  int status = 0;
  SHERD_CHECK(wait4(child, &status, 0, &usage) == child, "a process was lost");
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

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
  std::vector<std::string> words{program_of(o),          "run",     scene_file(o, scene), "--out", folder.path.string(),
                                 "--no-render",          "--quiet", "--quality",          quality, "--threads",
                                 std::to_string(threads)};
  if (o.frames > 0) words.insert(words.end(), {"--frames", std::to_string(o.frames)});
  for (const std::string& key : no_skip) words.insert(words.end(), {"--no-skip", key});
  rusage usage{};
  const auto start = std::chrono::steady_clock::now();
  run.exit_code = run_process(words, usage);
  run.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  run.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  run.peak_bytes = 1024.0 * static_cast<double>(usage.ru_maxrss);
  std::ifstream file(folder.path / "stats.json");
  if (file) run.stats = nlohmann::json::parse(file, nullptr, false);
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
