// Events that scenes ask for beside impacts: loads without contact, several solves in one event, guided cracks,
// notches.
#include <gtest/gtest.h>

#include "engine/mesh/certificate.h"
#include "kernels/core/error.h"
#include "tests/step/run_scene.h"

namespace sherd {
namespace {

// A bar floating in space, pulled or bent by the loads that tests append.
const std::string kFreeBar = R"(
time_step = 0.001
duration = 0.004
frame_rate = 1000
gravity = [0, 0, 0]
[ground]
enabled = false
[[body]]
name = "bar"
shape = {kind = "bar", length = 0.3, height = 0.05, width = 0.05}
edge_length = 0.0125
material = {preset = "plaster", crack_thickness = 1e-4}
)";

// Ends of the bar, each with a box around its face.
std::string end_load(Real side, const std::string& what) {
  const Real x = 0.15 * side;
  return fmt::format(
      "[[load]]\nbody = \"bar\"\nregion = {{low = [{}, -1, -1], high = [{}, 1, 1]}}\nfacing = [{}, 0, 0]\n{}\n",
      x - 0.001, x + 0.001, side, what);
}

TEST(AppliedLoads, OppositePullsStressABarByForceOverArea) {
  // 1 MPa, below plaster's strength of a few MPa: nothing breaks, and what is solved once is not solved again.
  const std::string text = kFreeBar + end_load(1, "force = [2500, 0, 0]") + end_load(-1, "force = [-2500, 0, 0]");
  const RunResult r = run_scene(text, 2);
  ASSERT_EQ(r.stats["events"].size(), 1u);
  const auto& event = r.stats["events"][0];
  EXPECT_EQ(event["applied_loads"], 2);
  EXPECT_NEAR(event["solve"]["max_principal"], 1e6, 1e3);  // uniform stress is exact but for the solver's tolerance
  EXPECT_LT(event["solve"]["relief"], 1e-12);
  EXPECT_EQ(r.stats["totals"]["skipped"]["load borne before"], 3);
  EXPECT_EQ(r.frames.back().bodies.size(), 1u);
}

TEST(AppliedLoads, ALoadActsFromItsTimeUntilItsTime) {
  const std::string times = "\nfrom = 0.0015\nuntil = 0.0031";
  const std::string text =
      kFreeBar + end_load(1, "force = [2500, 0, 0]" + times) + end_load(-1, "force = [-2500, 0, 0]" + times);
  const RunResult r = run_scene(text, 1);
  ASSERT_EQ(r.stats["events"].size(), 1u);
  EXPECT_EQ(r.stats["events"][0]["step"], 2);
  EXPECT_EQ(r.stats["totals"]["skipped"]["no contact"], 2);  // steps 1 and 4
  EXPECT_EQ(r.stats["totals"]["skipped"]["load borne before"], 1);
}

TEST(AppliedLoads, BendingBreaksABarWithoutContactAndLeavesItAtRest) {
  // Four-point bending by two couples: 6 M / (b h^2) = 7.2 MPa at the bottom.
  const std::string text = kFreeBar + end_load(1, "moment = [0, 0, 150]") + end_load(-1, "moment = [0, 0, -150]");
  const RunResult r = run_scene(text, 1);
  ASSERT_GE(r.stats["events"].size(), 1u);
  const auto& event = r.stats["events"][0];
  EXPECT_NEAR(event["solve"]["max_principal"], 7.2e6, 0.05 * 7.2e6);  // coarse mesh at the loaded edges
  ASSERT_GE(r.frames[1].bodies.size(), 2u);
  for (const FrameBody& b : r.frames[1].bodies) {
    EXPECT_LT(norm(b.translation - r.frames[0].bodies[0].translation), 1e-12);
    EXPECT_TRUE(certify(*b.mesh).ok());
  }
  // Fragments bear the load no more.
  EXPECT_EQ(r.stats["events"].size(), 1u);
}

TEST(Rounds, PiecesAreSolvedAnewUnderTheirPartOfTheLoad) {
  // The bent bar breaks in the middle in the first round; each half, held by its inertia, still bears its couple.
  const std::string text = kFreeBar + end_load(1, "moment = [0, 0, 150]") + end_load(-1, "moment = [0, 0, -150]") +
                           "[fracture]\nrounds = 2\n";
  const RunResult r = run_scene(text, 1);
  ASSERT_EQ(r.stats["events"].size(), 1u);
  const auto& event = r.stats["events"][0];
  int first = 0;
  for (const auto& crack : event["cracks"]) first += crack["round"] == 0 && crack["outcome"] == "complete";
  EXPECT_EQ(first, 1);  // a piece is cut once a round
  ASSERT_EQ(event["later_solves"].size(), 2u);
  for (const auto& solve : event["later_solves"]) {
    EXPECT_TRUE(solve["ok"]) << solve;
    EXPECT_EQ(solve["round"], 1);
    // The half's own end bears the whole couple, 7.2 MPa beside the loaded face, and less towards the cut.
    EXPECT_NEAR(solve["max_principal"], 7.2e6, 0.1 * 7.2e6);
  }
  EXPECT_EQ(r.stats["totals"]["solves"], 3);
  const auto& v = event["volume"];
  const Real rest =
      v["before"].get<Real>() - v["removed"].get<Real>() - v["dust"].get<Real>() + v["remeshing"].get<Real>();
  EXPECT_NEAR(v["after"], rest, 1e-12 * rest);
  for (const auto& frame : r.stats["frames"]) EXPECT_EQ(frame["valid"], frame["bodies"]);
}

TEST(AppliedLoads, ALoadBesideTheBodyIsRefusedWithItsBody) {
  const std::string text = kFreeBar + end_load(1.2, "force = [2500, 0, 0]");
  try {
    run_scene(text, 1);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("body \"bar\", load 1"), std::string::npos) << e.what();
  }
}

TEST(GuidedCrack, CutsAlongItsPlaneAtItsTimeWithoutASolve) {
  const std::string text =
      kFreeBar + "[[body.crack]]\nkind = \"plane\"\npoint = [0.031, 0, 0]\nnormal = [1, 0.2, 0]\ntime = 0.002\n";
  const RunResult r = run_scene(text, 1);
  EXPECT_EQ(r.stats["totals"]["solves"], 0);
  ASSERT_EQ(r.stats["events"].size(), 1u);
  const auto& event = r.stats["events"][0];
  EXPECT_EQ(event["step"], 2);
  ASSERT_EQ(event["cracks"].size(), 1u);
  const auto& crack = event["cracks"][0];
  EXPECT_EQ(crack["cause"], "guide");
  EXPECT_EQ(crack["outcome"], "complete");
  const Real exact = 0.05 * 0.05 * std::sqrt(1.04);
  EXPECT_NEAR(crack["area"], exact, 0.01 * exact);
  ASSERT_EQ(r.frames.back().bodies.size(), 2u);
  // Where the guide is: volumes of the two sides of the plane through (0.031, 0, 0).
  Real least = 1, sum = 0;
  for (const FrameBody& b : r.frames.back().bodies)
    least = std::min(least, signed_volume(*b.mesh)), sum += signed_volume(*b.mesh);
  EXPECT_NEAR(least, (0.15 - 0.031) * 0.0025 - 0.5e-4 * exact, 1e-3 * sum);
}

TEST(Notch, IsCutAtItsPlaceAndStaysSurface) {
  const std::string text =
      kFreeBar +
      "[[body.notch]]\nkind = \"plane\"\npoint = [0, 0.025, 0]\nnormal = [1, 0, 0]\ndepth = 0.015\n"
      "width = 0.006\n";
  const RunResult r = run_scene(text, 1);
  const SurfaceMesh& mesh = *r.frames[0].bodies[0].mesh;
  EXPECT_TRUE(certify(mesh).ok());
  EXPECT_NEAR(signed_volume(mesh), 0.3 * 0.0025 - 0.5 * 0.006 * 0.015 * 0.05, 1e-3 * 0.3 * 0.0025);
  for (const FaceKind kind : mesh.faces.kind) EXPECT_EQ(kind, FaceKind::kOriginal);
}

TEST(Notch, ThatCutsTheBodyInTwoIsRefused) {
  const std::string text = kFreeBar +
                           "[[body.notch]]\nkind = \"plane\"\npoint = [0, 0.025, 0]\nnormal = [1, 0, 0]\ndepth = 0.06\n"
                           "width = 0.006\n";
  EXPECT_THROW(run_scene(text, 1), InputError);
}

}  // namespace
}  // namespace sherd
