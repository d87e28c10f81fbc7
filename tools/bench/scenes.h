// Whole scenes: where the time goes beside the paper's Table 3 and what more threads save, what accuracy costs, what
// skipping saves.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace sherd::bench {

enum class SceneStudy { kTable, kSkips, kError };

struct ScenesOptions {
  std::vector<std::string> scenes;  // names of files in `folder`, or files; empty: the paper's five
  std::vector<SceneStudy> studies;  // empty: table
  std::string folder = "scenes";
  std::string quality = "default";  // of table and skips
  std::string finest = "fine";      // of the error study, whose reference it is
  int frames = 0;                   // of every run; 0: the scene's duration
  std::vector<int> threads{1, 2};   // the table's runs; the other studies run with the last
  std::vector<std::string> off;     // rows of the skips study: switches, "all"; empty: each in turn, then all
  std::string program;              // the command `sherd`; empty: beside this one
  std::string json;
  std::string plots;  // folder for the error study's plots, one a scene
};
// Prints tables. 0, or 1 when a run failed. InputError when a scene or the command is not there.
int run_scenes(const ScenesOptions& options);

// One run of the command, without pictures, in a process of its own.
struct SceneRun {
  std::string scene, quality;
  int threads = 0;
  std::vector<std::string> no_skip;
  int exit_code = 0;
  double wall_s = 0, cpu_s = 0, peak_bytes = 0;  // of the process, as the operating system counts
  nlohmann::json stats;                          // stats.json
};
SceneRun run_scene(const ScenesOptions& options, const std::string& scene, const std::string& quality, int threads,
                   const std::vector<std::string>& no_skip = {});
// The file a name of ScenesOptions::scenes stands for.
std::string scene_file(const ScenesOptions& options, const std::string& name);

// What the paper's Table 3 is about, of one run.
struct SceneNumbers {
  std::size_t triangles = 0;            // of all bodies at the start
  std::size_t largest = 0;              // of the largest mesh solved
  std::size_t unknowns = 0;             // of its system
  std::size_t solves = 0, skipped = 0;  // loads on breakable bodies: solved, known to be harmless
  int least_iterations = 0, most_iterations = 0;
  double first_solve_s = 0;  // of the largest mesh: assembly, preconditioner and solve
  double solve_s = 0;        // the same, mean of all solves
  double stress_s = 0;       // at the fronts, mean a step of propagation
  double crack_s = 0;        // growth, cut and remeshing, mean a step of propagation
  std::size_t steps = 0;     // of propagation, all cracks together
  std::size_t bodies = 0;    // at the end
};
SceneNumbers scene_numbers(const nlohmann::json& stats);

// The studies; each prints its table and returns its part of the JSON file. `failed` is set when a run failed.
nlohmann::json scene_table(const ScenesOptions& options, const std::vector<std::string>& scenes, bool& failed);
nlohmann::json scene_skips(const ScenesOptions& options, const std::vector<std::string>& scenes, bool& failed);
nlohmann::json scene_errors(const ScenesOptions& options, const std::vector<std::string>& scenes, bool& failed);

}  // namespace sherd::bench
