// A run that goes on from checkpoints is bit for bit the run that never stopped, whatever it is in the middle of.
#include <gtest/gtest.h>

#include "engine/step/run_state.h"
#include "kernels/core/error.h"
#include "tests/step/run_scene.h"

namespace sherd {
namespace {

std::size_t cracks(const nlohmann::json& stats, const std::string& key, const std::string& value) {
  std::size_t n = 0;
  for (const auto& event : stats["events"])
    for (const auto& crack : event["cracks"]) n += crack[key] == value;
  return n;
}

// Two bars that fall on the ground and each other: free fall, impacts, fracture, fragments in contact.
const std::string kFall = R"(
time_step = 0.001
duration = 0.012
frame_rate = 200
[[body]]
name = "bar"
shape = {kind = "bar", length = 0.3, height = 0.025, width = 0.025}
edge_length = 0.0125
anchor = "base"
position = [0, 0.008, 0]
rotation = {axis = [0, 0, 1], angle = 12}
velocity = [0, -5, 0]
material = {preset = "plaster", crack_thickness = 1e-4, strength = {kind = "noise", amplitude = 0.2, wavelength = 0.05}}
[[body]]
name = "ball"
shape = {kind = "sphere", radius = 0.02}
edge_length = 0.01
position = [0.02, 0.12, 0]
velocity = [0, -6, 0]
breakable = false
)";

TEST(Resume, InAFallThatBreaksChangesNothing) {
  const RunResult whole = run_scene(kFall, 2);
  ASSERT_GE(whole.frames.back().bodies.size(), 4u);
  const auto& steps = whole.stats["steps"];
  EXPECT_EQ(steps.front()["contacts"], 0);  // it begins in free fall
  EXPECT_GT(steps.back()["contacts"], 0);
  EXPECT_GT(steps.back()["fields_built"], 2);
  expect_same(whole, run_scene(kFall, 1, 7));
}

// Comes to rest, sleeps, and is woken by what falls on it; coarse steps, so that a second is 200.
const std::string kStack = R"(
time_step = 0.005
duration = 1.1
frame_rate = 20
[[body]]
name = "box"
shape = {kind = "box", size = [0.1, 0.05, 0.1]}
edge_length = 0.05
anchor = "base"
position = [0, 0, 0]
breakable = false
[[body]]
name = "top"
shape = {kind = "box", size = [0.08, 0.05, 0.08]}
edge_length = 0.05
anchor = "base"
position = [0, 0.0501, 0]
breakable = false
[[body]]
name = "late"
shape = {kind = "sphere", radius = 0.03}
edge_length = 0.03
position = [0.01, 3.6, 0]
breakable = false
)";

TEST(Resume, AmongSleepersAndWhenTheyWakeChangesNothing) {
  const RunResult whole = run_scene(kStack, 1);
  std::size_t most = 0;
  for (const auto& step : whole.stats["steps"]) most = std::max<std::size_t>(most, step["asleep"]);
  ASSERT_EQ(most, 2u);
  EXPECT_EQ(whole.stats["steps"].back()["asleep"], 0);
  expect_same(whole, run_scene(kStack, 1, 31));
}

// A guided crack stops inside a notched bar that turns; a load too small for it, then bending that lets it go through.
const std::string kStopped = R"(
time_step = 0.001
duration = 0.009
frame_rate = 1000
gravity = [0, 0, 0]
[ground]
enabled = false
[[body]]
name = "bar"
shape = {kind = "bar", length = 0.3, height = 0.05, width = 0.05}
edge_length = 0.0125
angular_velocity = [0, 3, 1]
material = {preset = "plaster", crack_thickness = 1e-4}
[[body.notch]]
kind = "plane"
point = [0.08, -0.025, 0]
normal = [1, 0, 0]
depth = 0.01
width = 0.006
[[body.crack]]
kind = "plane"
point = [-0.01, -0.025, 0]
normal = [1, 0.1, 0]
depth = 0.02
time = 0.002
[[body.crack]]
kind = "plane"
point = [-0.11, 0, 0]
normal = [1, 0, 0.2]
time = 0.008
[[load]]
body = "bar"
region = {low = [0.149, -1, -1], high = [0.151, 1, 1]}
facing = [1, 0, 0]
moment = [0, 0, 60]
from = 0.0061
[[load]]
body = "bar"
region = {low = [-0.151, -1, -1], high = [-0.149, 1, 1]}
facing = [-1, 0, 0]
moment = [0, 0, -60]
from = 0.0061
[[load]]
body = "bar"
region = {low = [0.149, -1, -1], high = [0.151, 1, 1]}
moment = [0, 0, 1]
from = 0.0031
)";

TEST(Resume, WithStoppedCracksGuidesNotchesAndLoadsChangesNothing) {
  const RunResult whole = run_scene(kStopped, 2);
  ASSERT_EQ(whole.stats["frames"][3]["bodies"], 1);
  EXPECT_GT(whole.stats["frames"][3]["volume"]["notches"], 0);  // the crack has stopped inside
  EXPECT_GE(cracks(whole.stats, "outcome", "arrested"), 1u);
  EXPECT_GT(whole.stats["totals"]["skipped"]["load borne before"], 0);
  EXPECT_GE(cracks(whole.stats, "cause", "resumed"), 1u);
  EXPECT_GE(cracks(whole.stats, "cause", "guide"), 2u);
  EXPECT_GE(whole.frames.back().bodies.size(), 3u);
  expect_same(whole, run_scene(kStopped, 2, 2));
}

TEST(SlowResume, AfterEveryStepChangesNothing) {
  std::string longer = kFall;  // until fragments break again
  longer.replace(longer.find("duration = 0.012"), 16, "duration = 0.018");
  for (const std::string& text : {longer, kStack, kStopped}) expect_same(run_scene(text, 1), run_scene(text, 2, 1));
}

TEST(Resume, FromAGuidedCrackOfTimeZeroDoesNotRunItAgain) {
  std::string text = kStopped;
  text.replace(text.find("time = 0.002"), 12, "time = 0.000");
  text.replace(text.find("time = 0.008"), 12, "time = 0.001");
  text.replace(text.find("duration = 0.009"), 16, "duration = 0.007");
  const RunResult whole = run_scene(text, 1);
  EXPECT_GE(cracks(whole.stats, "cause", "guide"), 2u);
  expect_same(whole, run_scene(text, 1, 4));
}

TEST(Resume, KeepsMessagesNobodyHasTaken) {
  const Scene scene = scene_of(kStopped);
  Simulation a(scene, {});
  while (a.steps() < 3) a.step();
  Simulation b(scene, {}, a.state());
  const std::vector<std::string> said = a.take_messages();
  EXPECT_GE(said.size(), 2u);
  EXPECT_EQ(b.take_messages(), said);
  EXPECT_EQ(Simulation(scene, {}, a.state()).take_messages().size(), 0u);
}

TEST(Resume, RefusesAStateThatDoesNotFit) {
  const Scene scene = scene_of(kStopped);
  const std::string state = Simulation(scene, {}).state();
  for (const std::size_t length : {std::size_t{0}, state.size() / 3, state.size() - 1})
    EXPECT_THROW(Simulation(scene, {}, state.substr(0, length)), ArchiveError);
  EXPECT_THROW(Simulation(scene, {}, state + '\0'), ArchiveError);
  std::string finer = kStopped;
  finer.replace(finer.find("edge_length = 0.0125"), 20, "edge_length = 0.0120");
  try {
    Simulation(scene_of(finer), {}, state);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("come out otherwise"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace sherd
