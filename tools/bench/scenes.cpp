#include "tools/bench/scenes.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <thread>

#include "kernels/core/file.h"

namespace sherd::bench {
namespace {

// The paper's Table 3, on one thread of an Intel i7-3770K: seconds a solve, a stress evaluation, a crack tracking step.
struct PaperRow {
  const char *scene, *iterations;
  double solve_s, stress_s, crack_s;
};
constexpr PaperRow kPaper[] = {{"ceramic_plate", "8-29", 176.349, 3.383, 0.877},
                               {"notched_bar", "22", 404.492, 17.008, 1.472},
                               {"glass_goblet", "4-33", 363.396, 8.411, 1.920},
                               {"hollow_sphere", "4-26", 289.146, 3.857, 1.043},
                               {"dinner_table", "7-47", 397.443, 14.736, 1.185}};

const PaperRow* paper_row(const std::string& scene) {
  for (const PaperRow& row : kPaper)
    if (scene == row.scene) return &row;
  return nullptr;
}

std::string times(double theirs, double ours) {
  return ours > 0 ? fmt::format("{:.0f}x", theirs / ours) : std::string("-");
}

nlohmann::json to_json(const SceneRun& run, const SceneNumbers& n) {
  return {{"scene", run.scene},
          {"quality", run.quality},
          {"threads", run.threads},
          {"triangles", n.triangles},
          {"largest_solved_triangles", n.largest},
          {"largest_solved_unknowns", n.unknowns},
          {"solves", n.solves},
          {"solves_skipped", n.skipped},
          {"iterations", {n.least_iterations, n.most_iterations}},
          {"largest_solve_s", n.first_solve_s},
          {"solve_s", n.solve_s},
          {"propagation_steps", n.steps},
          {"stress_step_s", n.stress_s},
          {"crack_step_s", n.crack_s},
          {"bodies", n.bodies},
          {"wall_s", run.wall_s},
          {"cpu_s", run.cpu_s},
          {"peak_bytes", run.peak_bytes},
          {"seconds", run.stats["seconds"]}};
}

bool report_failure(const SceneRun& run, bool& failed) {
  if (run.exit_code == 0) return false;
  std::printf("%-14s %-8s failed with exit code %d\n", run.scene.c_str(), run.quality.c_str(), run.exit_code);
  return failed = true;
}

// Arithmetic alone, so much on each of `threads` threads; seconds. What two threads are worth on this machine just now.
double compute_only(int threads) {
  const auto work = [] {
    volatile double sink = 0;
    double x = 0.5;
    for (long i = 0; i < 200'000'000; ++i) x = x * 1.000000001 + 1e-9;
    sink = x;
    (void)sink;
  };
  const auto start = std::chrono::steady_clock::now();
  std::vector<std::thread> pool;
  for (int t = 0; t < threads; ++t) pool.emplace_back(work);
  for (std::thread& t : pool) t.join();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

nlohmann::json scene_table(const ScenesOptions& o, const std::vector<std::string>& scenes, bool& failed) {
  std::printf(
      "Seconds of the paper's Table 3 beside ours (%s, %d threads, no pictures). solve: assembly, preconditioner and\n"
      "iterations, mean of all solves and that of the largest mesh; stress, crack: mean a step of propagation.\n",
      o.quality.c_str(), o.threads);
  std::printf("%-14s %9s %8s %7s %6s %6s %7s | %7s %7s %7s %5s | %8s %8s %5s | %8s %8s %5s | %7s %6s %6s\n", "scene",
              "triangles", "largest", "solves", "skip", "iter", "theirs", "solve", "largest", "theirs", "", "stress",
              "theirs", "", "crack", "theirs", "", "total s", "MB", "bodies");
  nlohmann::json rows = nlohmann::json::array();
  for (const std::string& scene : scenes) {
    const SceneRun run = run_scene(o, scene, o.quality, o.threads);
    if (report_failure(run, failed)) continue;
    const SceneNumbers n = scene_numbers(run.stats);
    const PaperRow* p = paper_row(scene);
    const auto theirs = [&](double PaperRow::*v) { return p ? fmt::format("{:.3g}", p->*v) : std::string("-"); };
    const auto ratio = [&](double PaperRow::*v, double ours) { return p ? times(p->*v, ours) : std::string("-"); };
    std::printf(
        "%-14s %9zu %8zu %7zu %6zu %6s %7s | %7.3f %7.3f %7s %5s | %8.5f %8s %5s | %8.5f %8s %5s | %7.1f %6.0f %6zu\n",
        scene.c_str(), n.triangles, n.largest, n.solves, n.skipped,
        fmt::format("{}-{}", n.least_iterations, n.most_iterations).c_str(), p ? p->iterations : "-", n.solve_s,
        n.first_solve_s, theirs(&PaperRow::solve_s).c_str(), ratio(&PaperRow::solve_s, n.solve_s).c_str(), n.stress_s,
        theirs(&PaperRow::stress_s).c_str(), ratio(&PaperRow::stress_s, n.stress_s).c_str(), n.crack_s,
        theirs(&PaperRow::crack_s).c_str(), ratio(&PaperRow::crack_s, n.crack_s).c_str(), run.wall_s,
        1e-6 * run.peak_bytes, n.bodies);
    std::fflush(stdout);
    rows.push_back(to_json(run, n));
    if (p)
      rows.back()["paper"] = {{"iterations", p->iterations},
                              {"solve_s", p->solve_s},
                              {"stress_step_s", p->stress_s},
                              {"crack_step_s", p->crack_s}};
  }
  return rows;
}

nlohmann::json scene_threads(const ScenesOptions& o, const std::vector<std::string>& scenes, bool& failed) {
  std::printf(
      "\nOne thread against two; control: the same arithmetic on one thread and on two.\n%-14s %9s %9s %8s %8s\n",
      "scene", "1 s", "2 s", "ratio", "control");
  nlohmann::json rows = nlohmann::json::array();
  for (const std::string& scene : scenes) {
    const double one_control = compute_only(1), two_control = compute_only(2);
    const SceneRun one = run_scene(o, scene, o.quality, 1), two = run_scene(o, scene, o.quality, 2);
    if (report_failure(one, failed) || report_failure(two, failed)) continue;
    const double control = 2 * one_control / two_control, ratio = one.wall_s / two.wall_s;
    std::printf("%-14s %9.1f %9.1f %8.2f %8.2f\n", scene.c_str(), one.wall_s, two.wall_s, ratio, control);
    std::fflush(stdout);
    rows.push_back({{"scene", scene},
                    {"one_thread_s", one.wall_s},
                    {"two_threads_s", two.wall_s},
                    {"ratio", ratio},
                    {"control", control}});
  }
  return rows;
}

int run_scenes(const ScenesOptions& options) {
  std::vector<std::string> scenes = options.scenes;
  if (scenes.empty())
    for (const PaperRow& row : kPaper) scenes.emplace_back(row.scene);
  for (const std::string& scene : scenes) scene_file(options, scene);  // before an hour is spent
  std::vector<SceneStudy> studies = options.studies;
  if (studies.empty()) studies = {SceneStudy::kTable};
  nlohmann::json out;
  bool failed = false;
  for (const SceneStudy study : studies) switch (study) {
      case SceneStudy::kTable:
        out["table"] = scene_table(options, scenes, failed);
        break;
      case SceneStudy::kThreads:
        out["threads"] = scene_threads(options, scenes, failed);
        break;
      case SceneStudy::kSkips:
        out["skips"] = scene_skips(options, scenes, failed);
        break;
      case SceneStudy::kError:
        out["error"] = scene_errors(options, scenes, failed);
        break;
    }
  if (!options.json.empty()) replace_file(options.json, out.dump(1) + "\n");
  return failed ? 1 : 0;
}

}  // namespace sherd::bench
