// What the three accuracy settings do to a scene.
#include "engine/scene/quality.h"

#include "tests/scene/scene_file.h"

namespace sherd {
namespace {

using SceneQuality = SceneFile;

const std::string kTwoBodies = R"(
[[body]]
name = "ball"
shape = {kind = "sphere", radius = 0.1}
edge_length = 0.02
[[body]]
name = "plate"
shape = {kind = "dinner_plate", radius = 0.1, thickness = 0.005}
edge_per_thickness = 2.5
[contact]
min_duration = 1e-4
[output]
samples = 4
)";

TEST_F(SceneQuality, DefaultIsTheSceneAsItIsWritten) {
  const Scene scene = load(kTwoBodies);
  EXPECT_EQ(scene.quality, Quality::kDefault);
  EXPECT_EQ(scene.bodies[0].edge_factor, 1);
  EXPECT_EQ(scene.bodies[1].edge_per_thickness, 2.5);
  EXPECT_EQ(scene.solver.tolerance, 1e-4);
  EXPECT_EQ(scene.time_step, 1e-3);
  EXPECT_EQ(scene.frame_rate, 60);
  EXPECT_EQ(scene.output.samples, 4);
}

TEST_F(SceneQuality, EdgesGrowInPreviewAndShrinkInFineWhetherGivenOrNot) {
  const std::string at[] = {"quality = \"preview\"\n" + kTwoBodies, kTwoBodies, "quality = \"fine\"\n" + kTwoBodies};
  std::vector<Real> ball, plate, triangles;
  for (const std::string& text : at) {
    const Scene scene = load(text);
    std::vector<std::string> messages;
    ball.push_back(scene_edge_length(scene.bodies[0], 1));
    plate.push_back(scene_edge_length(scene.bodies[1], 1));
    triangles.push_back(static_cast<Real>(scene_mesh(scene.bodies[0], messages).triangle_count()));
  }
  // One rounded product each.
  EXPECT_DOUBLE_EQ(ball[0], 1.6 * ball[1]);
  EXPECT_DOUBLE_EQ(ball[2], 0.6 * ball[1]);
  EXPECT_DOUBLE_EQ(plate[0], 1.6 * kDefaultEdge);
  EXPECT_DOUBLE_EQ(plate[2], 0.6 * kDefaultEdge);
  // The mesh follows: triangles go with the inverse square, up to the rounding of the sphere's whole numbers of edges.
  EXPECT_NEAR(triangles[1] / triangles[0], 1.6 * 1.6, 0.8);
  EXPECT_NEAR(triangles[2] / triangles[1], 1 / 0.36, 0.8);
}

TEST_F(SceneQuality, WhatTheSceneDescribesStays) {
  for (const Quality quality : {Quality::kPreview, Quality::kFine}) {
    const Scene scene = load_scene(write("scene.toml", kTwoBodies), quality);
    EXPECT_EQ(scene.quality, quality);
    EXPECT_EQ(scene.contact.min_duration, 1e-4);
    EXPECT_EQ(scene.duration, 2);
    EXPECT_EQ(scene.bodies[0].material.strength, load(kTwoBodies).bodies[0].material.strength);
  }
  // Also a contact time that stands for the time step: a shorter step must not make blows harder.
  const Scene fine = load_scene(write("scene.toml", kBall), Quality::kFine);
  EXPECT_EQ(fine.contact.min_duration, 1e-3);
  EXPECT_EQ(fine.time_step, 5e-4);
}

TEST_F(SceneQuality, WallsThatAreResolvedStayResolvedInPreview) {
  const auto per_thickness = [&](const std::string& text) {
    return load_scene(write("scene.toml", kBall + "edge_per_thickness = " + text + "\n"), Quality::kPreview)
        .bodies[0]
        .edge_per_thickness;
  };
  EXPECT_DOUBLE_EQ(per_thickness("1.5"), 2.4);  // 1.6 times
  EXPECT_EQ(per_thickness("2.5"), 3);           // not 4
  EXPECT_EQ(per_thickness("4"), 4);             // the scene's own choice
  EXPECT_EQ(per_thickness("0"), 0);             // off stays off
}

TEST_F(SceneQuality, TheSameWallsAreAveragedInAllThree) {
  for (const Quality quality : {Quality::kPreview, Quality::kDefault, Quality::kFine}) {
    const Scene scene = load_scene(write("scene.toml", kBall), quality);
    EXPECT_EQ(scene.solver.edge_factor, scene.bodies[0].edge_factor);
  }
}

TEST_F(SceneQuality, TheCommandStandsBeforeTheScene) {
  const auto file = write("scene.toml", "quality = \"fine\"\n" + kBall);
  EXPECT_EQ(load_scene(file).quality, Quality::kFine);
  EXPECT_EQ(load_scene(file, Quality::kDefault).bodies[0].edge_factor, 1);
}

TEST_F(SceneQuality, ToleranceStaysInItsRange) {
  const auto tolerance = [&](const std::string& text, Quality quality) {
    return load_scene(write("scene.toml", kBall + "[solver]\ntolerance = " + text + "\n"), quality).solver.tolerance;
  };
  EXPECT_DOUBLE_EQ(tolerance("1e-4", Quality::kPreview), 1e-3);
  EXPECT_DOUBLE_EQ(tolerance("1e-4", Quality::kFine), 1e-5);
  EXPECT_EQ(tolerance("0.05", Quality::kPreview), 0.1);
  EXPECT_EQ(tolerance("1e-14", Quality::kFine), 1e-14);
}

TEST_F(SceneQuality, OtherWordsAreRefused) {
  EXPECT_EQ(problem("quality = \"best\"\n" + kBall),
            "scene.toml:1:11: quality: value \"best\" not allowed; allowed values: preview, default, fine");
}

}  // namespace
}  // namespace sherd
