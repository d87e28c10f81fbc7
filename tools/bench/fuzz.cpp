#include "tools/bench/fuzz.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "kernels/core/error.h"
#include "kernels/core/file.h"
#include "tools/bench/process.h"
#include "tools/campaign/random_scene.h"

namespace sherd::bench {
namespace {

namespace fs = std::filesystem;

constexpr int kStopped = 130;  // the command's exit code after SIGINT

struct SceneVerdict {
  std::vector<std::string> broken;
  bool stopped = false, cracked = false;
  std::size_t steps = 0, solves = 0;
};

// The last line a failed run printed, which says why.
std::string last_line(const fs::path& log) {
  std::ifstream file(log);
  std::string line, last;
  while (std::getline(file, line))
    if (!line.empty()) last = line;
  return last;
}

SceneVerdict judge(const FuzzOptions& o, const std::string& program, const std::string& text) {
  const TemporaryFolder folder;
  const fs::path scene = folder.path / "scene.toml", log = folder.path / "log";
  replace_file(scene, text);
  const ProcessResult run = run_process({program, "run", scene.string(), "--out", (folder.path / "out").string(),
                                         "--no-render", "--quiet", "--threads", std::to_string(o.threads)},
                                        o.seconds, log);
  SceneVerdict v;
  v.stopped = run.stopped;
  if (run.hung) v.broken.push_back(fmt::format("hangs: a step took over a minute"));
  if (!run.hung && run.exit_code != 0 && !(run.stopped && run.exit_code == kStopped))
    v.broken.push_back(fmt::format("exit code {}: {}", run.exit_code, last_line(log)));
  const fs::path file = folder.path / "out" / "stats.json";
  std::error_code none;
  if (!fs::exists(file, none)) return v;
  const auto stats = nlohmann::json::parse(read_bytes(file), nullptr, false);
  if (!stats.is_object()) {
    v.broken.emplace_back("stats.json cannot be read");
    return v;
  }
  for (std::string& line : campaign::broken_laws(stats)) v.broken.push_back(std::move(line));
  v.steps = stats["totals"]["steps"], v.solves = stats["totals"]["solves"];
  v.cracked = stats["totals"]["cracks"] > 0;
  return v;
}

}  // namespace

int run_fuzz(const FuzzOptions& o) {
  const std::string program = sherd_program(o.program);
  std::size_t failed = 0, stopped = 0, cracked = 0, steps = 0, solves = 0;
  nlohmann::json failures = nlohmann::json::array();
  for (std::size_t i = 0; i < o.count; ++i) {
    const std::uint64_t seed = o.seed + i;
    const std::string text = campaign::random_scene(seed, o.duration);
    const SceneVerdict v = judge(o, program, text);
    stopped += v.stopped, cracked += v.cracked, steps += v.steps, solves += v.solves;
    if (v.broken.empty()) continue;
    ++failed;
    failures.push_back({{"seed", seed}, {"broken", v.broken}});
    std::printf("seed %llu: %s%s\n", static_cast<unsigned long long>(seed), v.broken[0].c_str(),
                v.broken.size() > 1 ? fmt::format(" (and {} more)", v.broken.size() - 1).c_str() : "");
    std::fflush(stdout);
    if (!o.keep.empty()) replace_file(fs::path(o.keep) / fmt::format("seed_{}.toml", seed), text);
  }
  std::printf(
      "%zu scenes, %zu failed; %zu reached %g s, %zu were stopped after %g s; %zu cracked; %zu steps, %zu solves\n",
      o.count, failed, o.count - stopped, o.duration, stopped, o.seconds, cracked, steps, solves);
  if (!o.json.empty())
    replace_file(o.json, nlohmann::json{{"scenes", o.count},
                                        {"failures", failures},
                                        {"stopped", stopped},
                                        {"cracked", cracked},
                                        {"steps", steps},
                                        {"solves", solves}}
                                 .dump(1) +
                             "\n");
  return failed > 0 ? 1 : 0;
}

}  // namespace sherd::bench
