// What each switch of [skip] saves: the scene with all on, with each off, with all off.
#include <fmt/format.h>

#include <cstdio>

#include "engine/scene/skip.h"
#include "tools/bench/scenes.h"

namespace sherd::bench {
namespace {

// The outcome that skipping must not change: bodies at the end, cracks by outcome.
std::string outcome(const nlohmann::json& stats) {
  return fmt::format("{} bodies, {}", stats["totals"]["bodies"].get<std::size_t>(),
                     stats["totals"]["crack_outcomes"].dump());
}

std::vector<std::string> rows_of(const ScenesOptions& o) {
  if (!o.off.empty()) return o.off;
  std::vector<std::string> keys;
  for (const SkipSwitch& s : kSkipSwitches) keys.emplace_back(s.key);
  keys.emplace_back("all");
  return keys;
}

}  // namespace

nlohmann::json scene_skips(const ScenesOptions& o, const std::vector<std::string>& scenes, bool& failed) {
  nlohmann::json rows = nlohmann::json::array();
  for (const std::string& scene : scenes) {
    std::printf(
        "\nWhat skipping saves in %s (%s, %d frames, %d threads): CPU seconds against all switches on.\n%-16s %9s %8s "
        "%12s %12s  %s\n",
        scene.c_str(), o.quality.c_str(), o.frames, o.threads.back(), "off", "CPU s", "ratio", "done", "skipped",
        "outcome");
    double all_on = 0;
    const auto row = [&](const char* name, const std::vector<std::string>& off) {
      const SceneRun run = run_scene(o, scene, o.quality, o.threads.back(), off);
      if (run.exit_code != 0) {
        failed = true;
        std::printf("%-16s failed with exit code %d\n", name, run.exit_code);
        return;
      }
      if (off.empty()) all_on = run.cpu_s;
      const bool single = off.size() == 1 && off[0] != "all";
      const auto count = [&](const char* key) {
        return single ? run.stats["skips"][off[0]][key].dump() : std::string("-");
      };
      std::printf("%-16s %9.1f %8.2f %12s %12s  %s\n", name, run.cpu_s, run.cpu_s / all_on, count("done").c_str(),
                  count("skipped").c_str(), outcome(run.stats).c_str());
      std::fflush(stdout);
      rows.push_back({{"scene", scene},
                      {"off", off},
                      {"cpu_s", run.cpu_s},
                      {"ratio", run.cpu_s / all_on},
                      {"skips", run.stats["skips"]},
                      {"outcome", outcome(run.stats)}});
    };
    row("nothing", {});
    for (const std::string& key : rows_of(o)) row(key.c_str(), {key});
  }
  return rows;
}

}  // namespace sherd::bench
