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

// `restore_every`: after so many steps each, all that goes on is what a checkpoint holds; 0: never.
inline RunResult run_scene(const std::string& text, int threads, std::size_t restore_every = 0) {
  const Scene scene = scene_of(text);
  auto simulation = std::make_unique<Simulation>(scene, SimulationOptions{.threads = threads});
  RunResult r;
  for (;;) {
    if (simulation->frame_due()) r.frames.push_back(simulation->snapshot());
    if (restore_every > 0 && simulation->steps() % restore_every == 0) {
      const std::string state = simulation->state();
      simulation = nullptr;
      simulation = std::make_unique<Simulation>(scene, SimulationOptions{.threads = threads}, state);
    }
    if (simulation->done()) break;
    simulation->step();
  }
  r.stats = nlohmann::json::parse(simulation->stats_json());
  drop_seconds(r.stats);
  r.stats.erase("scene");
  return r;
}

// Equal bit for bit; of statistics all but times.
inline void expect_same(const RunResult& a, const RunResult& b) {
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    ASSERT_EQ(a.frames[i].bodies.size(), b.frames[i].bodies.size());
    for (std::size_t k = 0; k < a.frames[i].bodies.size(); ++k) {
      const FrameBody &p = a.frames[i].bodies[k], &q = b.frames[i].bodies[k];
      EXPECT_EQ(*p.mesh, *q.mesh);
      EXPECT_EQ(p.translation, q.translation);
      for (int row = 0; row < 3; ++row) EXPECT_EQ(p.rotation.row(row), q.rotation.row(row));
      EXPECT_EQ(p.id, q.id);
      EXPECT_EQ(p.name, q.name);
    }
  }
  EXPECT_EQ(a.stats, b.stats);
}

}  // namespace sherd
