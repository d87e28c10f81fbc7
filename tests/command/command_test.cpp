// The `sherd` program from outside: exit codes, messages, and what it leaves on disk.
#include <nlohmann/json.hpp>
#include <string>

#include "tests/command/command.h"

namespace {

namespace fs = std::filesystem;
using sherd::test::Command;
using sherd::test::Outcome;

// Two small bodies, few pixels: a fraction of a second.
constexpr const char* kSmallScene = R"(
duration = 0.05
frame_rate = 100
[[body]]
name = "box"
shape = {kind = "box", size = [0.1, 0.1, 0.1]}
edge_length = 0.05
position = [0, 0.06, 0]
[[body]]
name = "ball"
shape = {kind = "sphere", radius = 0.05}
edge_length = 0.03
position = [0.2, 0.2, 0]
[output]
width = 64
height = 48
samples = 1
)";

TEST_F(Command, VersionAndHelpSucceed) {
  const Outcome version = sherd("--version");
  EXPECT_EQ(version.code, 0);
  EXPECT_EQ(version.output.substr(0, 6), "sherd ");
  const Outcome help = sherd("--help");
  EXPECT_EQ(help.code, 0);
  EXPECT_NE(help.output.find("Examples:"), std::string::npos);
  EXPECT_NE(help.output.find("sherd run scenes/bunny.toml"), std::string::npos);
}

TEST_F(Command, BadOptionsAreBadInput) {
  for (const char* arguments :
       {"", "fly", "run", "run a.toml --threads 0", "run a.toml --frames x", "run a.toml --quality best",
        "run a.toml --field heat", "check", "check a.obj --max-hole -1", "check a.obj --frob"}) {
    const Outcome outcome = sherd(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_FALSE(outcome.errors.empty()) << arguments;
  }
}

TEST_F(Command, CheckAcceptsASolid) {
  write_tetrahedron("solid.obj", true);
  const Outcome outcome = sherd("check solid.obj");
  EXPECT_EQ(outcome.code, 0) << outcome.output << outcome.errors;
  EXPECT_NE(outcome.output.find("Usable as it is."), std::string::npos) << outcome.output;
}

TEST_F(Command, CheckFillsHolesOnlyUpToTheStatedSize) {
  // The missing face's longest edge is sqrt(2).
  write_tetrahedron("open.obj", false);
  EXPECT_EQ(sherd("check open.obj --max-hole 0.5").code, 2);
  const Outcome filled = sherd("check open.obj --max-hole 2");
  EXPECT_EQ(filled.code, 0) << filled.output << filled.errors;
  EXPECT_NE(filled.output.find("Usable after repair."), std::string::npos) << filled.output;
}

TEST_F(Command, CheckReportsJson) {
  write_tetrahedron("open.obj", false);
  const auto refused = nlohmann::json::parse(sherd("check --json open.obj").output);
  EXPECT_EQ(refused.at("usable"), false);
  EXPECT_EQ(refused.at("loaded").at("border_edges"), 3);
  EXPECT_TRUE(refused.contains("refusal"));
  const auto filled = nlohmann::json::parse(sherd("check --json --max-hole 2 open.obj").output);
  EXPECT_EQ(filled.at("usable"), true);
  EXPECT_EQ(filled.at("repaired").at("border_edges"), 0);
  EXPECT_EQ(filled.at("repaired").at("triangles"), 4);
}

TEST_F(Command, CheckNamesAMissingFile) {
  const Outcome outcome = sherd("check none.obj");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.errors.find("none.obj"), std::string::npos) << outcome.errors;
}

TEST_F(Command, NothingIsCreatedForABadScene) {
  write("bad.toml", std::string(kSmallScene) + "[ground]\nfriction = -1\n");
  const Outcome outcome = sherd("run bad.toml --out results");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.errors, "bad.toml:19:12: ground.friction: value -1 not allowed; allowed range 0 to 10\n");
  EXPECT_FALSE(fs::exists(folder_ / "results"));
  EXPECT_EQ(sherd("run none.toml --out results").code, 2);
  EXPECT_FALSE(fs::exists(folder_ / "results"));
}

TEST_F(Command, NothingIsCreatedForABadMesh) {
  write_tetrahedron("open.obj", false);
  write("scene.toml", "[[body]]\nname = \"a\"\nmesh = \"open.obj\"\nmax_hole = 0.1\n");
  const Outcome outcome = sherd("run scene.toml --out results");
  EXPECT_EQ(outcome.code, 2) << outcome.errors;
  EXPECT_NE(outcome.errors.find("open.obj"), std::string::npos) << outcome.errors;
  EXPECT_FALSE(fs::exists(folder_ / "results"));
}

TEST_F(Command, AFileInTheWayOfTheResultsIsBadInput) {
  write("scene.toml", kSmallScene);
  write("results", "mine");
  const Outcome outcome = sherd("run scene.toml --no-render --out results");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(read(folder_ / "results"), "mine");
}

TEST_F(Command, RunLeavesFramesPiecesAndStatistics) {
  write("scene.toml", kSmallScene);
  const Outcome outcome = sherd("run scene.toml --out results --frames 3");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("results"), std::string::npos);
  EXPECT_EQ(outcome.output.find('\r'), std::string::npos) << "plain lines in a pipe";
  for (const char* name : {"frame_0000.png", "frame_0001.png", "frame_0002.png"})
    EXPECT_EQ(read(folder_ / "results/frames" / name).substr(1, 3), "PNG") << name;
  EXPECT_FALSE(fs::exists(folder_ / "results/frames/frame_0003.png"));
  EXPECT_TRUE(nlohmann::json::accept(read(folder_ / "results/stats.json")));
  const auto pieces = nlohmann::json::parse(read(folder_ / "results/pieces/transforms.json"));
  EXPECT_EQ(pieces.at("frames"), 3);
  EXPECT_EQ(pieces.at("pieces").size(), 2u);
}

TEST_F(Command, RunTakesAQualityAndAField) {
  write("scene.toml", std::string(kSmallScene) +
                          "field = \"displacement\"\nfield_range = [0, 1]\n[[load]]\nbody = \"box\"\nregion = {low = "
                          "[-1, 0.0499, -1], high = [1, 1, 1]}\nforce = [0, -10, 0]\n");
  const auto stats = [&](const std::string& options) {
    const Outcome outcome = sherd("run scene.toml --no-render --out results --frames 2 " + options);
    EXPECT_EQ(outcome.code, 0) << outcome.errors;
    return nlohmann::json::parse(read(folder_ / "results/stats.json"));
  };
  const auto plain = stats("");
  EXPECT_EQ(plain.at("quality"), "default");
  EXPECT_EQ(plain.at("field").at("name"), "displacement");
  EXPECT_EQ(plain.at("field").at("high"), 1);
  const auto other = stats("--quality preview --field strain_energy");
  EXPECT_EQ(other.at("quality"), "preview");
  EXPECT_EQ(other.at("field").at("name"), "strain_energy");
  EXPECT_NE(other.at("field").at("high"), 1) << "a range is of the scene's own field";
  EXPECT_LT(other.at("meshes").at(0).at("triangles").get<int>(), plain.at("meshes").at(0).at("triangles").get<int>());
}

TEST_F(Command, AShorterRunLeavesNoPicturesOfALongerOne) {
  write("scene.toml", kSmallScene);
  ASSERT_EQ(sherd("run scene.toml --out results --frames 4").code, 0);
  write("results/notes.txt", "mine");
  write("results/frames/frame_note.txt", "mine");
  ASSERT_EQ(sherd("run scene.toml --out results --frames 2 --quiet").code, 0);
  EXPECT_TRUE(fs::exists(folder_ / "results/frames/frame_0001.png"));
  EXPECT_FALSE(fs::exists(folder_ / "results/frames/frame_0002.png"));
  EXPECT_TRUE(fs::exists(folder_ / "results/notes.txt"));
  EXPECT_TRUE(fs::exists(folder_ / "results/frames/frame_note.txt"));
}

TEST_F(Command, QuietAndUnrenderedRunsSayAndDrawNothing) {
  write("scene.toml", kSmallScene);
  const Outcome outcome = sherd("run scene.toml --quiet --no-render --out results");
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_EQ(outcome.output, "");
  EXPECT_FALSE(fs::exists(folder_ / "results/frames"));
  EXPECT_TRUE(fs::exists(folder_ / "results/stats.json"));
  EXPECT_TRUE(fs::exists(folder_ / "results/pieces/transforms.json"));
}

TEST_F(Command, WallsTooThinForTheMeshAreSaidOnceOnTheErrorStream) {
  write("scene.toml", R"(
duration = 0.02
[[body]]
name = "pane"
shape = {kind = "plate", width = 0.06, depth = 0.04, thickness = 0.0025}
edge_length = 0.01
position = [0, 1, 0]
)");
  const Outcome outcome = sherd("run scene.toml --no-render --out results");
  EXPECT_EQ(outcome.code, 0);
  const std::string begin = "warning: pane: walls too thin for the mesh";
  EXPECT_EQ(outcome.errors.find(begin), 0u) << outcome.errors;
  EXPECT_EQ(outcome.errors.find("warning", 1), std::string::npos) << outcome.errors;
  const auto stats = nlohmann::json::parse(read(folder_ / "results/stats.json"));
  ASSERT_EQ(stats.at("meshes").size(), 1u);
  EXPECT_EQ(stats["meshes"][0].at("warnings").size(), 1u);
  EXPECT_EQ(sherd("run scene.toml --no-render --quiet --out results").errors, "");
}

TEST_F(Command, AnInterruptLeavesACompleteFolder) {
  // Long enough that a signal after the first picture finds it running.
  std::string text = kSmallScene;
  text.replace(text.find("duration = 0.05"), 15, "duration = 3000");
  write("scene.toml", text);
  const Outcome outcome = shell(
      "\"$SHERD\" run scene.toml --out results & run=$!; n=0; "
      "while [ ! -e results/frames/frame_0000.png ] && [ $n -lt 300 ]; do sleep 0.1; n=$((n + 1)); done; "
      "kill -INT $run; wait $run");
  EXPECT_EQ(outcome.code, 130);
  EXPECT_TRUE(nlohmann::json::accept(read(folder_ / "results/stats.json")));
  EXPECT_TRUE(nlohmann::json::accept(read(folder_ / "results/pieces/transforms.json")));
}

}  // namespace
