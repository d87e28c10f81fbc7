// The whole run on small scenes: what breaks is valid, conserves, and is the same in every run.
#include "engine/step/simulation.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "engine/body/mass.h"
#include "engine/mesh/thickness_resolution.h"
#include "engine/mesh/validate.h"
#include "kernels/core/error.h"
#include "tests/step/run_scene.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;

// A plaster bar that lands on one end: bending breaks it.
const std::string kBar = R"(
time_step = 0.001
duration = 0.03
frame_rate = 100
[[body]]
name = "bar"
shape = {kind = "bar", length = 0.3, height = 0.025, width = 0.025}
edge_length = 0.0125
anchor = "base"
position = [0, 0.004, 0]
rotation = {axis = [0, 0, 1], angle = 12}
velocity = [0, -5, 0]
material = {preset = "plaster", crack_thickness = 1e-4}
)";

const RunResult& bar_run() {
  static const RunResult r = run_scene(kBar, 2);
  return r;
}

TEST(Simulation, BarBreaksIntoValidFragments) {
  const Frame& last = bar_run().frames.back();
  ASSERT_GE(last.bodies.size(), 2u);
  for (const FrameBody& b : last.bodies) {
    const MeshReport report = report_mesh(*b.mesh, {.count_self_intersections = true});
    EXPECT_TRUE(is_valid(report)) << b.name << "\n" << to_text(report);
    EXPECT_NE(std::count(b.mesh->faces.kind.begin(), b.mesh->faces.kind.end(), FaceKind::kCrack), 0) << b.name;
  }
}

TEST(Simulation, FragmentsLoseThicknessTimesAreaOfVolumeAndNoMassOrMomentum) {
  int broken = 0;
  for (const auto& event : bar_run().stats["events"]) {
    if (!event.contains("volume") || event["new_bodies"].empty()) continue;
    ++broken;
    const auto& v = event["volume"];
    Real area = 0, removed = 0, dust = 0;
    for (const auto& crack : event["cracks"]) {
      removed += crack["removed_volume"].get<Real>(), dust += crack["dust_volume"].get<Real>();
      if (crack["outcome"] == "complete") area += crack["area"].get<Real>();
      EXPECT_LT(crack["volume_error"].get<Real>(), 1e-12);
      const std::string body = event["body"];  // "bar", its fragments append _0, _1, ...
      EXPECT_EQ(crack["generation"].get<std::ptrdiff_t>(), std::count(body.begin(), body.end(), '_'));
    }
    EXPECT_GT(area, 0);
    // Flat cracks across a bar: slab volume is thickness times area to the accuracy of area_inside (1 %).
    EXPECT_NEAR(removed, 1e-4 * area, 0.01 * 1e-4 * area);
    EXPECT_NEAR(v["removed"], removed, 1e-12 * removed);
    EXPECT_NEAR(v["dust"], dust, 1e-12 * removed);
    const Real before = v["before"], remeshing = v["remeshing"];
    EXPECT_NEAR(v["after"], before - removed - dust + remeshing, 1e-12 * before);
    EXPECT_LT(std::abs(remeshing), 0.01 * before);
    for (const char* key : {"mass", "momentum", "angular_momentum"})
      EXPECT_LT(event["conservation"][key].get<Real>(), 1e-9);
  }
  EXPECT_GT(broken, 0);
}

TEST(Simulation, EveryFrameIsCertifiedAndAccountsForAllVolume) {
  const nlohmann::json& stats = bar_run().stats;
  ASSERT_EQ(stats["frames"].size(), bar_run().frames.size());
  std::set<std::pair<std::uint32_t, std::uint32_t>> shown;
  for (std::size_t i = 0; i < stats["frames"].size(); ++i) {
    const auto& frame = stats["frames"][i];
    EXPECT_EQ(frame["bodies"], bar_run().frames[i].bodies.size());
    EXPECT_EQ(frame["valid"], frame["bodies"]);
    EXPECT_LT(frame["volume"]["error"].get<Real>(), 1e-12);
    Real volume = 0;
    for (std::size_t k = 0; k < bar_run().frames[i].bodies.size(); ++k) {
      const FrameBody& body = bar_run().frames[i].bodies[k];
      const auto& c = stats["certificates"][frame["certificates"][k].get<std::size_t>()];
      EXPECT_EQ(c["body_id"], body.id);
      EXPECT_EQ(c["triangles"], body.mesh->triangle_count());
      EXPECT_TRUE(c["closed"] && c["manifold"] && c["oriented"] && c["embedded"]);
      volume += signed_volume(*body.mesh);
      shown.insert({body.id, body.mesh_version});
    }
    EXPECT_NEAR(frame["volume"]["shown"], volume, 1e-12 * volume);
  }
  EXPECT_EQ(stats["certificates"].size(), shown.size());  // each mesh once
}

TEST(Simulation, SameFramesAndStatisticsForAnyNumberOfThreads) {
  for (const int threads : {1, 4}) expect_same(bar_run(), run_scene(kBar, threads));
}

TEST(Simulation, FrameCountFollowsDurationAndRate) {
  EXPECT_EQ(bar_run().frames.size(), 4u);
}

TEST(Simulation, ASlowTouchBreaksNothingAndSaysWhy) {
  std::string text = kBar;
  text.replace(text.find("velocity = [0, -5, 0]"), 21, "velocity = [0, -0.01, 0]");
  const RunResult r = run_scene(text, 1);
  EXPECT_EQ(r.frames.back().bodies.size(), 1u);
  EXPECT_EQ(r.stats["totals"]["cracks"], 0);
  EXPECT_FALSE(r.stats["totals"]["skipped"].empty());
}

TEST(Simulation, ABodyTooLargeForItsOperatorIsRefusedWithTheRemedy) {
  std::string text = kBar;
  text.replace(text.find("edge_length = 0.0125"), 20, "edge_length = 0.00031");
  try {
    Simulation simulation(scene_of(text), {});
    ADD_FAILURE() << "accepted";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("raise edge_length from 0.00031 to"), std::string::npos) << e.what();
  }
  Simulation rigid(scene_of(text + "breakable = false\n"), {});  // the remedy that keeps the mesh
}

TEST(Simulation, SaysWhatBreaksWhenItBreaks) {
  Simulation simulation(scene_of(kBar), {});
  std::string said;
  while (!simulation.done()) {
    simulation.step();
    for (const std::string& m : simulation.take_messages()) said += m + "\n";
  }
  EXPECT_NE(said.find("bar breaks into "), std::string::npos) << said;
  EXPECT_TRUE(simulation.take_messages().empty());
}

TEST(Simulation, SeparateSolidsOfOneMeshBecomeBodies) {
  const fs::path mesh = fs::temp_directory_path() / ("sherd_two_" + std::to_string(getpid()) + ".obj");
  std::ofstream out(mesh);
  for (int k = 0; k < 2; ++k)
    out << "v " << 2 * k << " 0 0\nv " << 2 * k + 1 << " 0 0\nv " << 2 * k << " 1 0\nv " << 2 * k << " 0 1\n";
  for (int k = 0; k < 2; ++k)
    for (const char* face : {"f -8 -6 -7\n", "f -8 -7 -5\n", "f -8 -5 -6\n", "f -7 -6 -5\n"}) {
      std::string text = face;
      if (k == 1)
        for (char& c : text)
          if (c >= '5' && c <= '8') c = static_cast<char>(c - 4);
      out << text;
    }
  out.close();
  Simulation simulation(scene_of("[[body]]\nname = \"a\"\nmesh = \"" + mesh.string() + "\"\nedge_length = 0.5\n"), {});
  const Frame frame = simulation.snapshot();
  ASSERT_EQ(frame.bodies.size(), 2u);
  EXPECT_EQ(frame.bodies[0].name, "a_0");
  EXPECT_NEAR(signed_volume(*frame.bodies[0].mesh), 1.0 / 6, 1e-12);
  EXPECT_EQ(frame.bodies[1].parent, kNone);
  fs::remove(mesh);
}

// A pane 2.5 mm thick meshed at 10 mm: its walls are a quarter of its edges.
const std::string kPane = R"(
duration = 0.01
[[body]]
name = "pane"
shape = {kind = "plate", width = 0.06, depth = 0.04, thickness = 0.0025}
edge_length = 0.01
anchor = "base"
position = [0, 0.002, 0]
rotation = {axis = [0, 0, 1], angle = 12}
velocity = [0, -3, 0]
material = "glass"
[contact]
min_duration = 1e-4
)";

TEST(Simulation, ThinWallsChooseTheRowsAndTheRuleOfTheCheck) {
  for (const std::string choice : {"auto", "off", "all"}) {
    const RunResult r = run_scene(kPane + "[solver]\nthin_walls = \"" + choice + "\"\n", 2);
    ASSERT_FALSE(r.stats["events"].empty()) << choice;
    const auto& solve = r.stats["events"][0]["solve"];
    const std::size_t vertices = solve["triangles"].get<std::size_t>() / 2 + 2;  // Euler, a closed surface of genus 0
    EXPECT_EQ(solve["unknowns"], 3 * vertices);
    EXPECT_GE(solve["products"], solve["iterations"]);
    const std::size_t averaged = solve["galerkin_vertices"];
    const std::size_t least = choice == "off" ? 0 : choice == "all" ? vertices : vertices / 2;
    EXPECT_GE(averaged, least);
    EXPECT_LE(averaged, choice == "off" ? 0 : vertices);
    const auto& mesh = r.stats["meshes"][solve["mesh"].get<std::size_t>()];
    EXPECT_EQ(mesh["triangles"], solve["triangles"]);
    EXPECT_EQ(mesh["resolution"]["limit_5_percent"],
              choice == "off" ? kCubicCollocationRule.at_5_percent : kCubicTestedRule.at_5_percent);
  }
}

TEST(Simulation, EachMeshIsMeasuredOnceAndOnlySceneBodiesWarn) {
  Simulation simulation(scene_of(kPane), {});
  const std::vector<std::string> warnings = simulation.take_warnings();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].find("pane: walls too thin for the mesh"), 0u) << warnings[0];
  EXPECT_TRUE(simulation.take_warnings().empty());
  std::string pane_unbreakable = kPane;
  pane_unbreakable.insert(pane_unbreakable.find("material"), "breakable = false\n");
  EXPECT_TRUE(Simulation(scene_of(pane_unbreakable), {}).take_warnings().empty());

  // The bar breaks: its fragments are meshes of their own, each once, however often it is solved.
  std::set<std::size_t> used;
  for (const auto& event : bar_run().stats["events"]) used.insert(event["solve"]["mesh"].get<std::size_t>());
  EXPECT_GT(bar_run().stats["events"].size(), 0u);
  EXPECT_EQ(used.size(), bar_run().stats["meshes"].size());
}

TEST(Simulation, UnbreakableAndFixedBodiesStayWhole) {
  std::string text = kBar + "breakable = false\n";
  const RunResult r = run_scene(text, 1);
  EXPECT_EQ(r.frames.back().bodies.size(), 1u);
  EXPECT_EQ(r.stats["totals"]["solves"], 0);
}

TEST(Simulation, AMeshThatIsNoSolidIsRefusedWithItsName) {
  const fs::path mesh = fs::temp_directory_path() / ("sherd_open_" + std::to_string(getpid()) + ".obj");
  std::ofstream(mesh) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\n";
  const Scene scene = scene_of("[[body]]\nname = \"a\"\nmesh = \"" + mesh.string() + "\"\n");
  try {
    Simulation simulation(scene, {});
    ADD_FAILURE() << "accepted";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find(mesh.filename().string()), std::string::npos) << e.what();
  }
  fs::remove(mesh);
}

}  // namespace
}  // namespace sherd
