#include "tools/bench/scenes.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <thread>

#include "kernels/core/file.h"

namespace sherd::bench {
namespace {

// The paper's Table 3 (averages; triangles and threads not given): seconds a solve, a stress evaluation, a crack
// tracking step.
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

// Prints what more threads save beside the first number of them.
nlohmann::json compare_threads(const std::vector<int>& threads, const std::vector<double>& total,
                               const std::vector<double>& control) {
  nlohmann::json rows = nlohmann::json::array();
  for (std::size_t i = 0; i < threads.size(); ++i) {
    const double share = static_cast<double>(threads[i]) / threads[0];
    const double ratio = total[0] / total[i], most = share * control[0] / control[i];
    std::printf("%14s threads %d: %.1f s, %.2f times as fast; the same arithmetic alone %.2f\n", "", threads[i],
                total[i], ratio, most);
    rows.push_back({{"threads", threads[i]}, {"wall_s", total[i]}, {"ratio", ratio}, {"control", most}});
  }
  std::fflush(stdout);
  return rows;
}

}  // namespace

nlohmann::json scene_table(const ScenesOptions& o, const std::vector<std::string>& scenes, bool& failed) {
  std::printf(
      "Seconds of the paper's Table 3 beside ours (%s, %d threads, no pictures). solve: assembly, preconditioner and\n"
      "iterations, mean of all solves and that of the largest mesh; stress, crack: mean a step of propagation.\n",
      o.quality.c_str(), o.threads.back());
  std::printf("%-14s %9s %8s %7s %6s %6s %7s | %7s %7s %7s %5s | %8s %8s %5s | %8s %8s %5s | %7s %6s %6s\n", "scene",
              "triangles", "largest", "solves", "skip", "iter", "theirs", "solve", "largest", "theirs", "", "stress",
              "theirs", "", "crack", "theirs", "", "total s", "MB", "bodies");
  nlohmann::json rows = nlohmann::json::array();
  for (const std::string& scene : scenes) {
    std::vector<double> control, total;  // seconds, of each number of threads
    SceneRun run;
    for (const int threads : o.threads) {
      if (o.threads.size() > 1) control.push_back(compute_only(threads));
      run = run_scene(o, scene, o.quality, threads);
      if (report_failure(run, failed)) break;
      total.push_back(run.wall_s);
    }
    if (run.exit_code != 0) continue;
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
    if (!control.empty()) rows.back()["by_threads"] = compare_threads(o.threads, total, control);
    if (p)
      rows.back()["paper"] = {{"iterations", p->iterations},
                              {"solve_s", p->solve_s},
                              {"stress_step_s", p->stress_s},
                              {"crack_step_s", p->crack_s}};
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
