// Skipping changes the cost, never the outcome: a run with a switch off ends as the run with all switches on.
#include <gtest/gtest.h>

#include "tests/step/run_scene.h"

namespace sherd {
namespace {

// A plate breaks on a brick that may not; beside them a falling bar is pulled by its ends, harder later on.
constexpr const char* kScene = R"(
time_step = 0.001
duration = 0.08
frame_rate = 50
[[body]]
name = "plate"
shape = {kind = "plate", width = 0.2, depth = 0.2, thickness = 0.02}
edge_length = 0.03
anchor = "base"
position = [0, 0.045, 0]
velocity = [0, -10, 0]
rotation = {axis = [0, 0, 1], angle = 10}
material = {preset = "porcelain", restitution = 0.05, friction = 0.8}
[[body]]
name = "brick"
shape = {kind = "box", size = [0.08, 0.04, 0.25]}
edge_length = 0.04
anchor = "base"
position = [0, 0, 0]
breakable = false
[[body]]
name = "bar"
shape = {kind = "bar", length = 0.2, height = 0.05, width = 0.05}
edge_length = 0.03
position = [0, 1, 0.5]
[[load]]
body = "bar"
region = {low = [0.099, -1, -1], high = [0.101, 1, 1]}
force = [1e3, 0, 0]
from = 0.01
[[load]]
body = "bar"
region = {low = [-0.101, -1, -1], high = [-0.099, 1, 1]}
force = [-1e3, 0, 0]
from = 0.01
[[load]]
body = "bar"
region = {low = [0.099, -1, -1], high = [0.101, 1, 1]}
force = [2e3, 0, 0]
from = 0.03
[[load]]
body = "bar"
region = {low = [-0.101, -1, -1], high = [-0.099, 1, 1]}
force = [-2e3, 0, 0]
from = 0.03
[fracture]
max_generation = 2
[ground]
friction = 0.8
restitution = 0.05
[contact]
min_duration = 2e-4
)";

const RunResult& all_on() {
  static const RunResult result = run_scene(kScene, 0);
  return result;
}

RunResult without(const std::string& key, const std::string& more = "") {
  return run_scene(std::string(kScene) + "\n[skip]\n" + key + " = false\n" + more, 0);
}

nlohmann::json counts(const RunResult& r, const std::string& key) {
  return r.stats["skips"][key];
}

// What is physical of a run: the number and the volume of the pieces, and the cracks' outcomes.
void expect_same_breakage(const RunResult& a, const RunResult& b) {
  ASSERT_EQ(a.frames.size(), b.frames.size());
  EXPECT_EQ(a.stats["totals"]["crack_outcomes"], b.stats["totals"]["crack_outcomes"]);
  ASSERT_EQ(a.frames.back().bodies.size(), b.frames.back().bodies.size());
}

// Every pose and every mesh of every frame, bit for bit.
void expect_same_frames(const RunResult& a, const RunResult& b) {
  expect_same_breakage(a, b);
  for (std::size_t f = 0; f < a.frames.size(); ++f) {
    ASSERT_EQ(a.frames[f].bodies.size(), b.frames[f].bodies.size()) << "frame " << f;
    for (std::size_t i = 0; i < a.frames[f].bodies.size(); ++i) {
      const FrameBody &p = a.frames[f].bodies[i], &q = b.frames[f].bodies[i];
      EXPECT_EQ(p.name, q.name);
      for (int k = 0; k < 3; ++k) EXPECT_EQ(p.translation[k], q.translation[k]) << p.name << " frame " << f;
      EXPECT_EQ(p.mesh->triangles, q.mesh->triangles) << p.name << " frame " << f;
      EXPECT_EQ(p.mesh->vertices.x, q.mesh->vertices.x) << p.name << " frame " << f;
    }
  }
}

// A switch that is on leaves work out, and off does all of it.
void expect_counts(const RunResult& off, const std::string& key) {
  EXPECT_GT(counts(all_on(), key)["skipped"], 0) << key;
  EXPECT_TRUE(counts(all_on(), key)["on"]);
  EXPECT_EQ(counts(off, key)["skipped"], 0) << key;
  EXPECT_GT(counts(off, key)["done"], counts(all_on(), key)["done"]) << key;
  EXPECT_FALSE(counts(off, key)["on"]);
}

TEST(Skip, TheSceneBreaks) {
  EXPECT_GT(all_on().frames.back().bodies.size(), 3u);
  EXPECT_GT(all_on().stats["totals"]["solves"], 2);
}

class ExactSkip : public testing::TestWithParam<const char*> {};

// Fields, systems and stresses that are made again are the same ones, and what is solved for bodies that may not break,
// or for loads that cannot break one, is used for nothing.
TEST_P(ExactSkip, ChangesNoBitOfAnyFrame) {
  const RunResult off = without(GetParam());
  expect_same_frames(all_on(), off);
  expect_counts(off, GetParam());
}
INSTANTIATE_TEST_SUITE_P(Switches, ExactSkip,
                         testing::Values("distance_fields", "unbreakable", "operators", "front_stress", "uploads"),
                         [](const auto& p) { return std::string(p.param); });

// A load that cannot break a body changes nothing when it is solved; but later solves would start from it, so they all
// start from zero here.
TEST(Skip, LoadsBelowTheirBoundChangeNoBit) {
  const RunResult on = without("warm_start"), off = without("load_bounds", "warm_start = false\n");
  expect_same_frames(on, off);
  EXPECT_GT(counts(on, "load_bounds")["skipped"], 0);
  EXPECT_EQ(counts(off, "load_bounds")["skipped"], 0);
  EXPECT_GT(off.stats["totals"]["solves"], on.stats["totals"]["solves"]);
}

// A brick at rest stays where it is, asleep or not.
TEST(Skip, SleepMovesNothingByAMillimetre) {
  const std::string resting = R"(
time_step = 0.002
duration = 1.2
frame_rate = 5
[[body]]
name = "brick"
shape = {kind = "box", size = [0.1, 0.05, 0.07]}
edge_length = 0.04
anchor = "base"
position = [0, 0.001, 0]
rotation = {axis = [0, 1, 0], angle = 20}
)";
  const RunResult on = run_scene(resting, 0), off = run_scene(resting + "[skip]\nsleep = false\n", 0);
  EXPECT_GT(counts(on, "sleep")["skipped"], 0);
  EXPECT_EQ(counts(off, "sleep")["skipped"], 0);
  EXPECT_LT(distance(on.frames.back().bodies[0].translation, off.frames.back().bodies[0].translation), 1e-3);
}

class NearlyExactSkip : public testing::TestWithParam<const char*> {};

// The stress changes within the solver's tolerance, 1e-4; the cracks are the same ones. What the sheets' nodes differ
// by grows along the motion of pieces that strike each other, so these stay whole, and poses are not compared.
TEST_P(NearlyExactSkip, BreaksTheSame) {
  std::string scene = kScene;
  const std::string breaks_on = "max_generation = 2";
  scene.replace(scene.find(breaks_on), breaks_on.size(), "max_generation = 1");
  const RunResult on = run_scene(scene, 0), off = run_scene(scene + "\n[skip]\n" + GetParam() + " = false\n", 0);
  expect_same_breakage(on, off);
  const auto &a = on.stats["events"][0], &b = off.stats["events"][0];
  const double value = a["solve"]["max_principal"], other = b["solve"]["max_principal"];
  EXPECT_NEAR(value, other, 1e-3 * value);
  EXPECT_GE(a["new_bodies"].size(), 2u);
  EXPECT_EQ(a["new_bodies"], b["new_bodies"]);
}
INSTANTIATE_TEST_SUITE_P(Switches, NearlyExactSkip, testing::Values("warm_start", "far_field", "zero_terms"),
                         [](const auto& p) { return std::string(p.param); });

TEST(Skip, AnUnknownSwitchIsRefusedWithItsLine) {
  try {
    scene_of("[[body]]\nname = \"b\"\nshape = {kind = \"sphere\", radius = 1}\n[skip]\nslep = false\n");
    FAIL();
  } catch (const std::exception& e) {
    EXPECT_NE(std::string(e.what()).find(":5:"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("skip.slep"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace sherd
