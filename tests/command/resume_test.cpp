// `sherd run` that is stopped, killed, or runs out of disk: what is left is whole, and --resume ends with the bytes of
// a run that was never stopped.
#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/command/command.h"

namespace sherd::test {
namespace {

// Breaks twice, with pictures of the world and of the body alone; a second or two.
constexpr const char* kBreaking = R"(
time_step = 0.001
duration = 0.03
frame_rate = 250
[[body]]
name = "bar"
shape = {kind = "bar", length = 0.3, height = 0.025, width = 0.025}
edge_length = 0.0125
anchor = "base"
position = [0, 0.004, 0]
rotation = {axis = [0, 0, 1], angle = 12}
velocity = [0, -5, 0]
material = {preset = "plaster", crack_thickness = 1e-4}
[output]
width = 64
height = 48
samples = 1
material_view = "bar"
)";

void drop_seconds(nlohmann::json& j) {
  if (j.is_object()) j.erase("seconds");
  for (auto& item : j)
    if (item.is_structured()) drop_seconds(item);
}

class Resume : public Command {
 protected:
  // Every file by its path in the folder; of statistics all but times.
  std::map<std::string, std::string> results(const std::string& name) const {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / name)) {
      if (entry.is_directory()) continue;
      std::string bytes = read(entry.path());
      if (entry.path().filename() == "stats.json") {
        auto stats = nlohmann::json::parse(bytes);
        drop_seconds(stats);
        bytes = stats.dump();
      }
      all[fs::relative(entry.path(), folder_ / name).string()] = std::move(bytes);
    }
    return all;
  }
  void expect_same(const std::string& a, const std::string& b) const {
    const auto x = results(a), y = results(b);
    for (const auto& [name, bytes] : x) {
      ASSERT_TRUE(y.contains(name)) << name << " is missing in " << b;
      EXPECT_TRUE(y.at(name) == bytes) << name << " differs";
    }
    for (const auto& [name, bytes] : y) EXPECT_TRUE(x.contains(name)) << name << " should not be in " << b;
  }
  static std::string with(std::string text, const std::string& old, const std::string& fresh) {
    return text.replace(text.find(old), old.size(), fresh);
  }
  // Kills at moments spread over the run, until it ends by itself: each some milliseconds after a picture is there, so
  // that the run is on its way however slow the machine is. True when it was killed at least once.
  bool run_killed(int kills, int milliseconds, const std::string& options) const {
    constexpr int kPictures = 7;  // of kBreaking, but for the last
    const std::string run = "\"$SHERD\" run scene.toml --out killed --resume --quiet " + options;
    std::string script = "killed=0; ";
    for (int i = 0; i < kills; ++i)
      script += run + " & run=$!; while [ ! -e killed/frames/" + fmt::format("frame_{:04}.png", i * kPictures / kills) +
                " ] && kill -0 $run 2>/dev/null; do sleep 0.005; done; sleep " +
                std::to_string(1e-3 * milliseconds * (7 * i % 11)) +
                "; kill -9 $run 2>/dev/null; wait $run; code=$?; "
                "case $code in 137) killed=$((killed + 1));; 0) ;; *) exit $code;; esac; ";
    const Outcome o = shell(script + run + " || exit; echo $killed");
    EXPECT_EQ(o.code, 0) << o.errors;
    return o.code == 0 && std::stoi(o.output) > 0;
  }
  void expect_no_part(const std::string& name) const {
    for (const auto& [file, bytes] : results(name)) EXPECT_FALSE(file.ends_with(".part")) << file;
  }
};

class SlowResume : public Resume {};

TEST_F(Resume, ARunKilledAtAnyMomentEndsWithTheSameBytes) {
  write("scene.toml", kBreaking);
  ASSERT_EQ(sherd("run scene.toml --out whole --quiet --threads 2").code, 0);
  EXPECT_TRUE(run_killed(5, 10, "--threads 1 --checkpoint-every 3"));
  expect_same("whole", "killed");
}

TEST_F(SlowResume, ARunKilledAtFortyMomentsEndsWithTheSameBytes) {
  write("scene.toml", kBreaking);
  ASSERT_EQ(sherd("run scene.toml --out whole --quiet --threads 1").code, 0);
  for (int round = 0; round < 4; ++round) {
    EXPECT_TRUE(run_killed(10, 1 + 5 * round, round % 2 == 0 ? "--checkpoint-every 1" : "--checkpoint-every 0.004s"));
    expect_same("whole", "killed");
    fs::remove_all(folder_ / "killed");
  }
}

TEST_F(Resume, CtrlCLeavesACheckpointAlsoWhenNoneWereAskedFor) {
  write("scene.toml", kBreaking);
  ASSERT_EQ(sherd("run scene.toml --out whole --quiet").code, 0);
  const Outcome stopped = shell(
      "\"$SHERD\" run scene.toml --out results & run=$!; n=0; "
      "while [ ! -e results/frames/frame_0001.png ] && [ $n -lt 300 ]; do sleep 0.05; n=$((n + 1)); done; "
      "kill -INT $run; wait $run");
  ASSERT_EQ(stopped.code, 130) << stopped.errors;
  EXPECT_NE(stopped.output.find("--resume goes on"), std::string::npos) << stopped.output;
  EXPECT_TRUE(fs::exists(folder_ / "results/checkpoint"));
  const Outcome resumed = sherd("run scene.toml --out results --resume");
  EXPECT_EQ(resumed.code, 0) << resumed.errors;
  EXPECT_NE(resumed.output.find("going on at "), std::string::npos) << resumed.output;
  expect_same("whole", "results");
}

TEST_F(Resume, GoesOnBeyondAFrameLimitAndTakesCareOfWhatIsThere) {
  write("scene.toml", kBreaking);
  ASSERT_EQ(sherd("run scene.toml --out whole --quiet").code, 0);
  ASSERT_EQ(sherd("run scene.toml --out results --quiet --frames 3 --checkpoint-every 0.005s").code, 0);
  const std::string picture = read(folder_ / "results/frames/frame_0001.png");
  fs::remove(folder_ / "results/frames/frame_0001.png");
  const Outcome gone = sherd("run scene.toml --out results --resume");
  EXPECT_EQ(gone.code, 2);
  EXPECT_NE(gone.errors.find("frame_0001.png: a picture of the run so far is gone"), std::string::npos) << gone.errors;
  write("results/frames/frame_0001.png", picture);
  // What a run killed later would leave.
  write("results/frames/frame_0007.png", "later");
  write("results/frames/frame_0003.png.part", "half");
  write("results/pieces/0009_v0_bar_9.ply", "later");
  EXPECT_EQ(sherd("run scene.toml --out results --resume --quiet --frames 5 --checkpoint-every 4").code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "results/frames/frame_0007.png"));
  EXPECT_EQ(sherd("run scene.toml --out results --resume --quiet").code, 0);
  expect_same("whole", "results");
  const Outcome again = sherd("run scene.toml --out results --resume");
  EXPECT_EQ(again.code, 0);
  EXPECT_NE(again.output.find("the run is complete"), std::string::npos) << again.output;
  expect_same("whole", "results");
}

TEST_F(Resume, IsRefusedForAnotherSceneOtherOptionsAndDamage) {
  write("scene.toml", kBreaking);
  ASSERT_EQ(sherd("run scene.toml --out results --quiet --no-render --frames 3 --checkpoint-every 3").code, 0);
  const auto refused = [&](const std::string& options, const std::string& part) {
    const Outcome o = sherd("run scene.toml --out results --resume " + options);
    EXPECT_EQ(o.code, 2) << part;
    EXPECT_NE(o.errors.find(part), std::string::npos) << o.errors;
  };
  refused("", "began with the options '--no-render', not ''");
  write("scene.toml", with(kBreaking, "velocity = [0, -5, 0]", "velocity = [0, -6, 0]"));
  refused("--no-render", "the scene, or a mesh file it reads, has changed");
  // Comments and layout are not the scene.
  write("scene.toml", with(kBreaking, "velocity = [0, -5, 0]", "velocity  =  [0,-5.0,0]  # down"));
  EXPECT_EQ(sherd("run scene.toml --out results --resume --quiet --no-render --frames 4 --checkpoint-every 3").code, 0);
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder_ / "results/checkpoint")) files.push_back(entry.path());
  ASSERT_EQ(files.size(), 2u);
  std::sort(files.begin(), files.end());
  fs::resize_file(files[1], fs::file_size(files[1]) / 2);
  const Outcome before = sherd("run scene.toml --out results --resume --no-render --frames 5 --checkpoint-every 100");
  EXPECT_EQ(before.code, 0) << before.errors;
  EXPECT_NE(before.errors.find("damaged (its bytes are not those that were written); going on from the one before"),
            std::string::npos)
      << before.errors;
  for (const auto& entry : fs::directory_iterator(folder_ / "results/checkpoint")) fs::resize_file(entry.path(), 40);
  refused("--no-render", "no whole checkpoint is left; start anew, without --resume");
  ASSERT_EQ(sherd("run scene.toml --out results --quiet --no-render").code, 0);
  write("scene.toml", with(kBreaking, "velocity = [0, -5, 0]", "velocity = [0, -6, 0]"));
  refused("--no-render", "stats.json: is of another scene than scene.toml");
}

TEST_F(Resume, AChangedMeshFileIsAnotherScene) {
  write_tetrahedron("solid.obj", true);
  write("scene.toml",
        "duration = 0.02\n[[body]]\nname = \"a\"\nmesh = \"solid.obj\"\nedge_length = 0.5\nposition = [0, 2, 0]\n");
  ASSERT_EQ(sherd("run scene.toml --out results --quiet --no-render --frames 1 --checkpoint-every 1").code, 0);
  write("solid.obj", with(read(folder_ / "solid.obj"), "v 1 0 0", "v 1.1 0 0"));
  const Outcome o = sherd("run scene.toml --out results --resume --no-render");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.errors.find("the scene, or a mesh file it reads, has changed"), std::string::npos) << o.errors;
}

TEST_F(Resume, BadCadencesAreBadInput) {
  write("scene.toml", kBreaking);
  for (const char* cadence : {"0", "-3", "2.5", "0s", "nans", "1e999s", "5 s", "x", "1m"}) {
    const Outcome o = sherd(std::string("run scene.toml --out results --checkpoint-every '") + cadence + "'");
    EXPECT_EQ(o.code, 2) << cadence;
    EXPECT_NE(o.errors.find("--checkpoint-every"), std::string::npos) << cadence << ": " << o.errors;
  }
  EXPECT_FALSE(fs::exists(folder_ / "results"));
}

// A disk of its own, of a size that the run does not fit.
TEST_F(Resume, AFullDiskIsAClearErrorAndTheRunGoesOnWhenThereIsSpace) {
  fs::create_directories(folder_ / "disk");
  if (shell("mount -t tmpfs -o size=96k none disk").code != 0) GTEST_SKIP() << "cannot mount a small disk here";
  write("scene.toml", kBreaking);
  const Outcome full = sherd("run scene.toml --out disk/results --checkpoint-every 2");
  EXPECT_EQ(full.code, 2) << full.output << full.errors;
  EXPECT_NE(full.errors.find("disk/results/"), std::string::npos) << full.errors;
  EXPECT_NE(full.errors.find("cannot be written (No space left on device); free some space"), std::string::npos)
      << full.errors;
  expect_no_part("disk");
  EXPECT_EQ(shell("mount -o remount,size=100m disk").code, 0);
  const Outcome resumed = sherd("run scene.toml --out disk/results --resume");
  EXPECT_EQ(resumed.code, 0) << resumed.errors;
  EXPECT_NE(resumed.output.find("going on at "), std::string::npos) << resumed.output;
  EXPECT_EQ(sherd("run scene.toml --out whole --quiet").code, 0);
  expect_same("whole", "disk/results");
  EXPECT_EQ(shell("umount disk").code, 0);
}

TEST_F(Resume, ALimitOnFileSizesIsAClearErrorNotADeath) {
  write("scene.toml", kBreaking);
  // In blocks of 512 or 1024 bytes: less than any checkpoint or the statistics need.
  const Outcome o = shell("ulimit -f 4; \"$SHERD\" run scene.toml --out results --no-render --checkpoint-every 2");
  EXPECT_EQ(o.code, 2) << o.errors;
  EXPECT_NE(o.errors.find("cannot be written (File too large); raise the limit of file sizes"), std::string::npos)
      << o.errors;
  expect_no_part("results");
}

TEST_F(Resume, AFolderThatCannotBeWrittenIsNamedBeforeTheRun) {
  write("scene.toml", kBreaking);
  fs::create_directories(folder_ / "theirs");
  fs::permissions(folder_ / "theirs", fs::perms::owner_read | fs::perms::owner_exec | fs::perms::group_read |
                                          fs::perms::group_exec | fs::perms::others_read | fs::perms::others_exec);
  // Permissions do not bind root: as nobody then, if nobody can reach the program.
  std::string as;
  if (geteuid() == 0) {
    as = "setpriv --reuid 65534 --regid 65534 --clear-groups ";
    if (shell(as + "\"$SHERD\" --version").code != 0) GTEST_SKIP() << "only root can run the program here";
  }
  const Outcome o = shell(as + "\"$SHERD\" run scene.toml --out theirs --no-render");
  EXPECT_EQ(o.code, 2);
  EXPECT_EQ(o.errors, "theirs: cannot write into this folder (Permission denied); choose another folder with --out\n");
  const Outcome inner = shell(as + "\"$SHERD\" run scene.toml --out theirs/results --no-render");
  EXPECT_EQ(inner.code, 2);
  EXPECT_EQ(inner.errors.find("theirs/results: cannot write into this folder (Permission denied)"), 0u) << inner.errors;
}

TEST_F(Resume, AMovieThatFfmpegCannotWriteIsAnErrorAfterAllElseIsWritten) {
  write("scene.toml", kBreaking);
  write("ffmpeg", "#!/bin/sh\necho 'No space left on device' >&2\nexit 1\n");
  fs::permissions(folder_ / "ffmpeg", fs::perms::owner_all);
  const Outcome o = shell("PATH=\"$PWD\"; \"$SHERD\" run scene.toml --out results --frames 2");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.errors.find("no movie: ffmpeg could not write results/movie.mp4 (No space left on device)"),
            std::string::npos)
      << o.errors;
  EXPECT_TRUE(fs::exists(folder_ / "results/stats.json") && fs::exists(folder_ / "results/frames/frame_0001.png"));
}

// Every scene that comes with the program, until it has broken for the first time: one thread without a stop, against
// four threads stopped, then killed, then two that go on.
class Scenes : public Resume, public testing::WithParamInterface<std::string> {};

TEST_P(Scenes, GiveTheSameBytesForAnyThreadsAndAfterAKill) {
  const std::map<std::string, std::string> late{{"bunny", "4"}, {"dinner_table", "4"}, {"glass_goblet", "5"}};
  const auto found = late.find(GetParam());
  const std::string frames = found == late.end() ? "3" : found->second;
  const std::string run = "\"$SHERD\" run " SHERD_SOURCE "/scenes/" + GetParam() + ".toml --quality preview --quiet ";
  const Outcome whole = shell(run + "--out whole --threads 1 --frames " + frames);
  if (whole.errors.find("one that exists") != std::string::npos) GTEST_SKIP() << whole.errors;
  ASSERT_EQ(whole.code, 0) << whole.errors;
  if (GetParam() != "stress_cubes") {  // whose bodies may not break
    EXPECT_GT(nlohmann::json::parse(read(folder_ / "whole/stats.json"))["totals"]["cracks"], 0);
  }
  // Killed as soon as the second run has written a checkpoint of its own, or has ended.
  const Outcome parts =
      shell(run + "--out parts --threads 4 --frames 2 --checkpoint-every 0.004s || exit; touch stamp; " + run +
            "--out parts --threads 4 --resume --checkpoint-every 2 --frames " + frames +
            " & run=$!; while [ ! parts/checkpoint -nt stamp ] && kill -0 $run 2>/dev/null; do sleep "
            "0.01; done; kill -9 $run 2>/dev/null; wait $run; " +
            run + "--out parts --threads 2 --resume --frames " + frames);
  ASSERT_EQ(parts.code, 0) << parts.errors;
  fs::remove_all(folder_ / "parts/checkpoint");  // not at the end of its scene, so it may go on
  expect_same("whole", "parts");
}

std::vector<std::string> all_scenes() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(SHERD_SOURCE "/scenes"))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}
INSTANTIATE_TEST_SUITE_P(Slow, Scenes, testing::ValuesIn(all_scenes()), [](const auto& scene) { return scene.param; });

}  // namespace
}  // namespace sherd::test
