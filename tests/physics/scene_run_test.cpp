// Every scene of scenes/ runs: the beginning of each, at preview.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "engine/step/simulation.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(fs::path(SHERD_SOURCE) / "scenes"))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

class SceneRuns : public testing::TestWithParam<std::string> {};

// Until the first of its bodies is hit or loaded and a little longer.
TEST_P(SceneRuns, AtPreviewWithoutAWarningOrAFailure) {
  const fs::path file = fs::path(SHERD_SOURCE) / "scenes" / (GetParam() + ".toml");
  const std::string bunny = "/usr/share/glmark2/models/bunny.obj";
  std::ifstream text(file);
  const std::string content{std::istreambuf_iterator<char>(text), std::istreambuf_iterator<char>()};
  if (content.find(bunny) != std::string::npos && !fs::exists(bunny)) GTEST_SKIP() << "no bunny";
  Scene scene = load_scene(file, Quality::kPreview);
  scene.duration = 0.065;
  Simulation simulation(scene, {});
  EXPECT_EQ(simulation.take_warnings(), std::vector<std::string>{});
  for (;;) {
    if (simulation.frame_due()) simulation.snapshot();
    if (simulation.done()) break;
    simulation.step();
  }
  const nlohmann::json stats = nlohmann::json::parse(simulation.stats_json());
  EXPECT_EQ(stats.at("quality"), "preview");
  std::size_t solves = 0;
  for (const auto& event : stats.at("events"))
    if (event.contains("solve")) {
      ++solves;
      EXPECT_TRUE(event.at("solve").at("ok").get<bool>()) << event.at("solve").dump();
    }
  const bool guided = content.find("[[body.crack]]") != std::string::npos;
  EXPECT_EQ(solves == 0, guided);
  for (const auto& certificate : stats.at("certificates")) EXPECT_TRUE(certificate.at("ok").get<bool>());
}

INSTANTIATE_TEST_SUITE_P(Slow, SceneRuns, testing::ValuesIn(scene_names()),
                         [](const auto& scene) { return scene.param; });

}  // namespace
}  // namespace sherd
