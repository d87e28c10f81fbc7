// Runs a scene given as text and keeps what it served.
#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/step/simulation.h"

namespace sherd {

inline Scene scene_of(const std::string& text) {
  namespace fs = std::filesystem;
  static int count = 0;
  const fs::path path = fs::temp_directory_path() / fmt::format("sherd_simulation_test_{}_{}.toml", getpid(), count++);
  std::ofstream(path) << text;
  const Scene scene = load_scene(path);
  fs::remove(path);
  return scene;
}

struct RunResult {
  std::vector<Frame> frames;
  nlohmann::json stats;  // without times and the temporary file's name
};

inline void drop_seconds(nlohmann::json& j) {
  if (j.is_object()) j.erase("seconds");
  for (auto& item : j)
    if (item.is_structured()) drop_seconds(item);
}

inline RunResult run_scene(const std::string& text, int threads) {
  Simulation simulation(scene_of(text), {.threads = threads});
  RunResult r;
  for (;;) {
    if (simulation.frame_due()) r.frames.push_back(simulation.snapshot());
    if (simulation.done()) break;
    simulation.step();
  }
  r.stats = nlohmann::json::parse(simulation.stats_json());
  drop_seconds(r.stats);
  r.stats.erase("scene");
  return r;
}

}  // namespace sherd
