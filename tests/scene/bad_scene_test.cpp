// Every refusal names the file, the place, the key, the value and what is allowed.
#include "tests/scene/scene_file.h"

namespace sherd {
namespace {

using BadScene = SceneFile;

TEST_F(BadScene, UnknownKeyNamesTheNearestOne) {
  EXPECT_EQ(problem(kBall + "postion = [0, 1, 0]\n"),
            "scene.toml:4:1: body.postion: unknown key; did you mean 'position'?");
  EXPECT_EQ(problem("time-step = 0.001\n" + kBall),
            "scene.toml:1:1: time-step: unknown key; did you mean 'time_step'?");
  EXPECT_EQ(
      problem("zzzzzzzzzz = 60\n" + kBall),
      "scene.toml:1:1: zzzzzzzzzz: unknown key; known keys: gravity, time_step, duration, frame_rate, quality, body, "
      "load, ground, "
      "contact, solver, fracture, skip, camera, light, output");
  EXPECT_EQ(problem(kBall + "[ground]\nfricton = 1\n"),
            "scene.toml:5:1: ground.fricton: unknown key; did you mean 'friction'?");
}

TEST_F(BadScene, WrongTypesAreRefused) {
  EXPECT_EQ(problem("time_step = \"fast\"\n" + kBall),
            "scene.toml:1:13: time_step: value \"fast\" not allowed; allowed type: a number; range 1e-06 to 0.1 s");
  EXPECT_EQ(
      problem(kBall + "position = 3\n"),
      "scene.toml:4:12: body.position: value 3 not allowed; allowed type: three numbers [x, y, z]; range -1e+06 to "
      "1e+06 m each");
  EXPECT_EQ(
      problem(kBall + "position = [0, true, 0]\n"),
      "scene.toml:4:16: body.position[1]: value true not allowed; allowed type: a number; range -1e+06 to 1e+06 m");
  EXPECT_EQ(problem(kBall + "fixed = 1\n"),
            "scene.toml:4:9: body.fixed: value 1 not allowed; allowed values: true, false");
  EXPECT_EQ(problem(kBall + "[output]\nwidth = 640.5\n"),
            "scene.toml:5:9: output.width: value 640.5 not allowed; allowed type: a whole number; range 16 to 8192");
  EXPECT_EQ(problem(kBall + "[ground]\n[[ground.height]]\n"),
            "scene.toml:5:1: ground.height: value [{}] not allowed; allowed type: a number; range -1e+06 to 1e+06 m");
  EXPECT_EQ(problem(kBall + "[solver]\nthin_walls = true\n"),
            "scene.toml:5:14: solver.thin_walls: value true not allowed; allowed values: auto, off, all");
  EXPECT_EQ(problem("ground = 3\n" + kBall), "scene.toml:1:10: ground: value 3 not allowed; allowed type: a table");
  EXPECT_EQ(
      problem("body = \"ball\"\n"),
      "scene.toml:1:8: body: value \"ball\" not allowed; allowed type: one or more tables, each begun by [[body]]");
  EXPECT_EQ(
      problem("duration = 1979-05-27\n" + kBall),
      "scene.toml:1:12: duration: value (a date or time) not allowed; allowed type: a number; range 0.001 to 3600 s");
}

TEST_F(BadScene, ImpossibleMaterialsAreRefused) {
  const auto with = [&](const std::string& change) { return problem(kBall + "material = {" + change + "}\n"); };
  EXPECT_EQ(with("poisson = 0.5"),
            "scene.toml:4:23: body.material.poisson: value 0.5 not allowed; allowed range above -1 and below 0.5");
  EXPECT_EQ(with("density = -2400"),
            "scene.toml:4:23: body.material.density: value -2400 not allowed; allowed range 10 to 30000 kg/m^3");
  EXPECT_EQ(with("young = 70"),
            "scene.toml:4:21: body.material.young: value 70 not allowed; allowed range 100000 to 2e+12 Pa");
  EXPECT_EQ(with("strength = nan"),
            "scene.toml:4:24: body.material.strength: value nan not allowed; allowed range 100 to 1e+12 Pa");
  EXPECT_EQ(with("friction = inf"),
            "scene.toml:4:24: body.material.friction: value inf not allowed; allowed range 0 to 10");
  EXPECT_EQ(
      with("preset = \"glas\""),
      "scene.toml:4:22: body.material.preset: value \"glas\" not allowed; allowed values: glass, ceramic, porcelain, "
      "plaster, concrete, brick");
  EXPECT_EQ(problem(kBall + "material = 7\n"),
            "scene.toml:4:12: body.material: value 7 not allowed; allowed type: a preset's name or a table");
}

TEST_F(BadScene, PropagationStrengthAboveInitiationIsRefusedAtTheKeyThatWasGiven) {
  EXPECT_EQ(
      problem(kBall + "material = {preset = \"glass\", propagation_strength = 5e7}\n"),
      "scene.toml:4:54: body.material.propagation_strength: value 50000000 not allowed; allowed range 1 to 4.5e+07 Pa, "
      "the strength");
  EXPECT_EQ(
      problem(kBall + "material = {preset = \"glass\", strength = 1e6}\n"),
      "scene.toml:4:42: body.material.strength: value 1000000 not allowed; allowed range 1.3e+06 to 1e+12 Pa, from "
      "the propagation_strength");
}

TEST_F(BadScene, TimesMustMoveForward) {
  EXPECT_EQ(problem("time_step = 0\n" + kBall),
            "scene.toml:1:13: time_step: value 0 not allowed; allowed range 1e-06 to 0.1 s");
  EXPECT_EQ(problem("duration = -1\n" + kBall),
            "scene.toml:1:12: duration: value -1 not allowed; allowed range 0.001 to 3600 s");
  EXPECT_EQ(
      problem("frame_rate = 2000\n" + kBall),
      "scene.toml:1:14: frame_rate: value 2000 not allowed; allowed range 0.001 to 1000 frames/s, at most one a step");
}

TEST_F(BadScene, MeshFilesMustExist) {
  EXPECT_EQ(
      problem("[[body]]\nname = \"a\"\nmesh = \"none.obj\"\n"),
      "scene.toml:3:8: body.mesh: value \"none.obj\" not allowed; allowed files: one that exists (none.obj does not)");
  std::filesystem::create_directories(folder_ / "models");
  EXPECT_EQ(problem("[[body]]\nname = \"a\"\nmesh = \"models\"\n"),
            "scene.toml:3:8: body.mesh: value \"models\" not allowed; allowed files: a mesh file (models is a folder)");
  EXPECT_EQ(problem("[[body]]\nname = \"a\"\nmesh = 1\n"),
            "scene.toml:3:8: body.mesh: value 1 not allowed; allowed type: the path of a mesh file, in quotes");
  write("a.obj", "v 0 0 0\n");
  EXPECT_EQ(
      problem("[[body]]\nname = \"a\"\nmesh = \"a.obj\"\nscale = 2\nfit_size = 1\n"),
      "scene.toml:5:12: body.fit_size: value 1 not allowed; allowed count: one of scale, fit_height and fit_size");
}

TEST_F(BadScene, BodiesNeedAUniqueNameAndOneSource) {
  EXPECT_EQ(problem(kBall + kBall),
            "scene.toml:5:8: body.name: value \"ball\" not allowed; allowed names: one that no other body has");
  EXPECT_EQ(problem("[[body]]\nshape = {kind = \"sphere\", radius = 0.1}\n"),
            "scene.toml:1:1: body.name: missing; allowed names: 1 to 64 of letters, digits, '_' and '-'");
  EXPECT_EQ(
      problem("[[body]]\nname = \"../x\"\nshape = {kind = \"sphere\", radius = 0.1}\n"),
      "scene.toml:2:8: body.name: value \"../x\" not allowed; allowed names: 1 to 64 of letters, digits, '_' and '-'");
  EXPECT_EQ(problem("[[body]]\nname = \"a\"\n"),
            "scene.toml:1:1: body: needs one of mesh (a file) and shape (a generated solid)");
}

TEST_F(BadScene, ShapesMustBeSolids) {
  const auto shape = [&](const std::string& text) {
    return problem("[[body]]\nname = \"a\"\nshape = {" + text + "}\n");
  };
  EXPECT_EQ(shape("kind = \"cube\""),
            "scene.toml:3:17: body.shape.kind: value \"cube\" not allowed; allowed values: box, sphere, hollow_sphere, "
            "plate, "
            "bar, cylinder, dinner_plate, goblet, torus, tumbler, vase, figurine, twisted_column");
  EXPECT_EQ(shape("kind = \"sphere\""), "scene.toml:3:9: body.shape.radius: missing; allowed range 1e-06 to 10000 m");
  EXPECT_EQ(shape("kind = \"sphere\", radius = -1"),
            "scene.toml:3:36: body.shape.radius: value -1 not allowed; allowed range 1e-06 to 10000 m");
  EXPECT_EQ(shape("kind = \"hollow_sphere\", radius = 0.1, inner_radius = 0.1"),
            "scene.toml:3:63: body.shape.inner_radius: value 0.1 not allowed; allowed range 1e-06 to 0.0999 m");
  EXPECT_EQ(shape("kind = \"box\", size = [1, 0, 1]"),
            "scene.toml:3:35: body.shape.size[1]: value 0 not allowed; allowed range 1e-06 to 10000 m");
  EXPECT_EQ(problem(kBall + "edge_per_thickness = -1\n"),
            "scene.toml:4:22: body.edge_per_thickness: value -1 not allowed; allowed range 0 to 20");
  EXPECT_EQ(problem(kBall + "edge_length = 1e-9\n"),
            "scene.toml:4:15: body.edge_length: value 1e-09 not allowed; allowed range 0.00034641 to 0.34641 m");
}

TEST_F(BadScene, RotationsAreDirectionsWithAngles) {
  const auto turn = [&](const std::string& text) { return problem(kBall + "rotation = {" + text + "}\n"); };
  EXPECT_EQ(turn("axis = [0, 0, 0], angle = 90"),
            "scene.toml:4:20: body.rotation.axis: value [0, 0, 0] not allowed; allowed range: a direction, not zero");
  EXPECT_EQ(turn("axis = [0, 0, 1]"),
            "scene.toml:4:12: body.rotation.angle: missing; allowed range -36000 to 36000 degrees");
  EXPECT_EQ(
      turn("quaternion = [1, 1, 0, 0]"),
      "scene.toml:4:26: body.rotation.quaternion: value [1, 1, 0, 0] not allowed; allowed type: four numbers [w, x, y, "
      "z] of length 1");
  EXPECT_EQ(turn("euler = [1, 2, 3], axis = [1, 0, 0]"),
            "scene.toml:4:12: body.rotation: value {axis = [1, 0, 0], euler = [1, 2, 3]} not allowed; allowed forms: "
            "axis with "
            "angle, euler, or quaternion");
}

TEST_F(BadScene, FixedBodiesStandStill) {
  EXPECT_EQ(problem(kBall + "fixed = true\nvelocity = [1, 0, 0]\n"),
            "scene.toml:5:12: body.velocity: value [1, 0, 0] not allowed; allowed values: [0, 0, 0], since the body is "
            "fixed");
  EXPECT_EQ(problem(kBall + "fixed = true\nbreakable = true\n"),
            "scene.toml:5:13: body.breakable: value true not allowed; allowed values: false, since the body is fixed");
}

TEST_F(BadScene, ViewsAndOutputMustBePossible) {
  EXPECT_EQ(
      problem(kBall + "[camera]\neye = [0, 1, 0]\ntarget = [0, 0, 0]\n"),
      "scene.toml:5:7: camera.eye: value [0, 1, 0] not allowed; allowed range: a point off the line through the target "
      "along up");
  EXPECT_EQ(problem(kBall + "[camera]\ntarget = [0, 0, 0]\n"),
            "scene.toml:5:10: camera.target: value [0, 0, 0] not allowed; allowed use: together with camera.eye");
  EXPECT_EQ(problem(kBall + "[light]\ndirection = [0, 0, 0]\n"),
            "scene.toml:5:13: light.direction: value [0, 0, 0] not allowed; allowed range: a direction, not zero");
  EXPECT_EQ(problem(kBall + "[output]\nsamples = 3\n"),
            "scene.toml:5:11: output.samples: value 3 not allowed; allowed values: 1, 2, 4, 8");
  EXPECT_EQ(
      problem(kBall + "[output]\nframes = false\nmovie = true\n"),
      "scene.toml:6:9: output.movie: value true not allowed; allowed values: false, since output.frames is false");
  EXPECT_EQ(problem(kBall + "[output]\nmaterial_view = \"bal\"\n"),
            "scene.toml:5:17: output.material_view: value \"bal\" not allowed; allowed values: ball");
  EXPECT_EQ(
      problem(kBall + "colour = \"red\"\n"),
      "scene.toml:4:10: body.colour: value \"red\" not allowed; allowed forms: \"#rrggbb\" or [r, g, b] from 0 to 1");
  EXPECT_EQ(
      problem(kBall + "[contact]\nduration = \"short\"\n"),
      "scene.toml:5:12: contact.duration: value \"short\" not allowed; allowed values: \"hertz\" or a number, range "
      "1e-09 to 1 s");
}

TEST_F(BadScene, AllProblemsAreNamedAtOnceInFileOrder) {
  EXPECT_EQ(problem("time_step = -1\nspeed = 3\n" + kBall + "[output]\nwidth = 1\n"),
            "scene.toml:1:13: time_step: value -1 not allowed; allowed range 1e-06 to 0.1 s\n"
            "scene.toml:2:1: speed: unknown key; known keys: gravity, time_step, duration, frame_rate, quality, body, "
            "load, ground, "
            "contact, "
            "solver, fracture, skip, camera, light, output\n"
            "scene.toml:7:9: output.width: value 1 not allowed; allowed range 16 to 8192");
}

TEST_F(BadScene, SyntaxErrorsNameTheirPlace) {
  const std::string broken = problem(kBall + "position = [0, 1\nvelocity = [1, 0, 0]\n");
  EXPECT_EQ(broken.substr(0, broken.find(' ')), "scene.toml:5:1:") << broken;
  const std::string doubled = problem("duration = 1\nduration = 2\n" + kBall);
  EXPECT_EQ(doubled.substr(0, 13), "scene.toml:2:") << doubled;
  const std::string binary = problem(std::string("\x00\xff\xfe\x01 nonsense", 14));
  EXPECT_EQ(binary.substr(0, 13), "scene.toml:1:") << binary;
}

TEST_F(BadScene, ScenesWithoutBodiesAreRefused) {
  EXPECT_EQ(problem("# nothing\n"), "scene.toml:1:1: body: missing; a scene needs at least one [[body]]");
  EXPECT_EQ(problem("body = []\n"),
            "scene.toml:1:8: body: value [] not allowed; allowed type: one or more tables, each begun by [[body]]");
  EXPECT_EQ(problem(""), "scene.toml: the file is empty; a scene needs at least one [[body]]");
}

TEST_F(BadScene, WhatIsNoFileIsRefused) {
  EXPECT_EQ(problem_of(folder_ / "absent.toml"), "absent.toml: no such file; check the path");
  std::filesystem::create_directories(folder_ / "inner");
  EXPECT_EQ(problem_of(folder_ / "inner"), "inner: is a folder; name the scene file in it");
  EXPECT_EQ(problem_of("/dev/null"), "/dev/null: is not a regular file; name a TOML scene file");
}

TEST_F(BadScene, DeepNestingIsAnErrorNotACrash) {
  const std::string deep = "a = " + std::string(5000, '[') + std::string(5000, ']') + "\n";
  const std::string message = problem(deep + kBall);
  EXPECT_EQ(message.substr(0, 13), "scene.toml:1:") << message;
}

}  // namespace
}  // namespace sherd
