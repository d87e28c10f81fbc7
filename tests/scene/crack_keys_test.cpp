// Keys that say where and how cracks run: fields of the material, guided cracks, notches, loads.
#include <cmath>

#include "engine/mesh/shapes.h"
#include "tests/scene/scene_file.h"

namespace sherd {
namespace {

using CrackKeys = SceneFile;

std::string material(const std::string& text) {
  return kBall + "material = {" + text + "}\n";
}

TEST_F(CrackKeys, NumbersStayNumbersEverywhere) {
  const Scene scene = load(material("strength = 5e6, propagation_strength = 2e6"));
  const SceneBody& ball = scene.bodies[0];
  EXPECT_FALSE(ball.strength || ball.propagation_strength || ball.crack_thickness);
  const MaterialFields fields = scene_fields(ball, make_sphere(0.1, 0.05));
  EXPECT_EQ(fields.strength->lower(), 5e6);
  EXPECT_EQ(fields.propagation_strength->upper(), 2e6);
  EXPECT_NEAR(fields.crack_thickness->at({}), 1e-3 * 0.2 * std::sqrt(3), 1e-5);
  EXPECT_EQ(scene.fracture.rounds, 1);
  EXPECT_FALSE(scene.fracture.interior_seeds);
  EXPECT_EQ(scene.fracture.dust, SceneDust::kDrop);
}

TEST_F(CrackKeys, EveryKindOfFieldArrives) {
  const Scene scene = load(material(
      "strength = {kind = \"noise\", mean = 3e7, amplitude = 0.4, wavelength = 0.02, seed = 7, lognormal = true}, "
      "propagation_strength = {kind = \"grains\", mean = 1e6, size = 0.01, spread = 0.2, boundary = 0.5, width = 0.05, "
      "seed = 9}, crack_thickness = {kind = \"layers\", axis = [0, 0, 2], offsets = [0.1, 0.2], values = [1e-4, 2e-4, "
      "3e-4], blend = 0.01}"));
  const SceneBody& ball = scene.bodies[0];
  const NoiseSpec& noise = std::get<NoiseSpec>(ball.strength.value());
  EXPECT_EQ(noise.mean, 3e7);
  EXPECT_EQ(noise.amplitude, 0.4);
  EXPECT_EQ(noise.wavelength, 0.02);
  EXPECT_EQ(noise.seed, 7u);
  EXPECT_TRUE(noise.lognormal);
  EXPECT_EQ(ball.material.strength, 3e7);
  const GrainSpec& grains = std::get<GrainSpec>(ball.propagation_strength.value());
  EXPECT_EQ(grains.size, 0.01);
  EXPECT_EQ(grains.spread, 0.2);
  EXPECT_EQ(grains.boundary, 0.5);
  EXPECT_EQ(grains.width, 0.05);
  EXPECT_EQ(grains.seed, 9u);
  const LayerSpec& layers = std::get<LayerSpec>(ball.crack_thickness.value());
  EXPECT_EQ(layers.axis, (Vec3{0, 0, 1}));
  EXPECT_EQ(layers.offsets, (std::vector<Real>{0.1, 0.2}));
  EXPECT_EQ(layers.values, (std::vector<Real>{1e-4, 2e-4, 3e-4}));
  EXPECT_EQ(layers.blend, 0.01);
  EXPECT_NEAR(ball.material.crack_thickness, 2e-4, 1e-19);
}

TEST_F(CrackKeys, AFieldsMeanIsThePresetsUnlessGiven) {
  const Scene scene = load(material("preset = \"glass\", strength = {kind = \"grains\", size = 0.01, spread = 0.3}"));
  EXPECT_EQ(std::get<GrainSpec>(scene.bodies[0].strength.value()).mean, 45e6);
}

TEST_F(CrackKeys, PropagationStrengthFollowsAStrengthThatVariesAndNeverExceedsIt) {
  const SurfaceMesh mesh = make_sphere(0.1, 0.05);
  const std::string noise = "strength = {kind = \"noise\", mean = 4e7, amplitude = 0.9, wavelength = 0.03}";
  const Scene shared = load(material("preset = \"ceramic\", " + noise));
  const MaterialFields fields = scene_fields(shared.bodies[0], mesh);
  // Interleaved with the strength's range, so only a pointwise bound keeps it below.
  const Scene crossing = load(material(noise + ", propagation_strength = {kind = \"layers\", offsets = [0], values = "
                                               "[1e6, 5e7]}"));
  const MaterialFields bounded = scene_fields(crossing.bodies[0], mesh);
  bool met = false;
  for (int i = 0; i < 200; ++i) {
    const Vec3 x{0.001 * i, 0.01 * std::sin(i), 0};
    EXPECT_NEAR(fields.propagation_strength->at(x), fields.strength->at(x) * (1.8e6 / 4e7), 1);
    EXPECT_LE(bounded.propagation_strength->at(x), bounded.strength->at(x));
    met = met || bounded.propagation_strength->at(x) == bounded.strength->at(x);
  }
  EXPECT_TRUE(met);
}

TEST_F(CrackKeys, PropagationStrengthsAboveTheStrengthAreRefusedWithBothRanges) {
  EXPECT_EQ(
      problem(material("strength = {kind = \"noise\", mean = 2e6, amplitude = 0.5, wavelength = 0.01}, "
                       "propagation_strength = 1.5e6")),
      "scene.toml:4:113: body.material.propagation_strength: value 1500000 not allowed; allowed range at most the "
      "strength: it spans 1.5e+06 to 1.5e+06 Pa, the strength 1e+06 to 3e+06 Pa; lower it, or use {kind = "
      "\"share\", factor = 0.1}");
  EXPECT_EQ(problem(material("strength = 1e6, propagation_strength = {kind = \"layers\", offsets = [0], values = [1e5, "
                             "2e6]}")),
            "scene.toml:4:52: body.material.propagation_strength: value {kind = \"layers\", offsets = [0], values = "
            "[100000, 2000000]} not allowed; allowed range at most the strength: it spans 100000 to 2e+06 Pa, the "
            "strength 1e+06 to 1e+06 Pa; lower it, or use {kind = \"share\", factor = 0.1}");
}

TEST_F(CrackKeys, ImpossibleFieldsAreRefusedAtTheirPlace) {
  const auto strength = [&](const std::string& text) { return problem(material("strength = {" + text + "}")); };
  EXPECT_EQ(strength("kind = \"nois\""),
            "scene.toml:4:32: body.material.strength.kind: value \"nois\" not allowed; allowed values: noise, layers, "
            "grains, attribute");
  EXPECT_EQ(strength("kind = \"noise\", wavelength = 0.1"),
            "scene.toml:4:24: body.material.strength.amplitude: missing; allowed range from 0 and below 1 of the mean");
  EXPECT_EQ(
      strength("kind = \"noise\", amplitude = 1, wavelength = 0.1"),
      "scene.toml:4:53: body.material.strength.amplitude: value 1 not allowed; allowed range from 0 and below 1 of "
      "the mean");
  EXPECT_EQ(strength("kind = \"noise\", mean = 200, amplitude = 0.9, wavelength = 0.1"),
            "scene.toml:4:24: body.material.strength: value {amplitude = 0.9, kind = \"noise\", mean = 200, wavelength "
            "... not allowed; allowed range 100 to 1e+12 Pa at every place; the field spans 20 to 380");
  EXPECT_EQ(
      strength("kind = \"layers\", offsets = [0, 1], values = [1e6, 2e6]"),
      "scene.toml:4:69: body.material.strength.values: value [1000000, 2000000] not allowed; allowed count: 3, one "
      "more than offsets");
  EXPECT_EQ(strength("kind = \"layers\", offsets = [1, 0], values = [1e6, 2e6, 3e6]"),
            "scene.toml:4:52: body.material.strength.offsets: value [1, 0] not allowed; allowed order: ascending, at "
            "least `blend` apart");
  EXPECT_EQ(strength("kind = \"share\", factor = 0.1"),
            "scene.toml:4:32: body.material.strength.kind: value \"share\" not allowed; allowed values: noise, layers, "
            "grains, attribute");
  EXPECT_EQ(strength("kind = \"grains\", size = 0.01, sped = 3"),
            "scene.toml:4:55: body.material.strength.sped: unknown key; did you mean 'seed'?");
  EXPECT_EQ(problem(material("crack_thickness = {kind = \"noise\", amplitude = 0.1, wavelength = 0.1}")),
            "scene.toml:4:31: body.material.crack_thickness.mean: missing; allowed range 1e-09 to 1 m");
  EXPECT_EQ(
      problem(material("density = {kind = \"noise\"}")),
      "scene.toml:4:23: body.material.density: value {kind = \"noise\"} not allowed; allowed type: a number; range "
      "10 to 30000 kg/m^3");
}

TEST_F(CrackKeys, AMissingAttributeNamesTheBody) {
  const Scene scene = load(material("strength = {kind = \"attribute\", name = \"paint\", low = 1e7, high = 2e7}"));
  try {
    scene_fields(scene.bodies[0], make_sphere(0.1, 0.05));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).substr(0, 53), "ball: the mesh has no vertex attribute \"paint\"; it ha");
  }
}

TEST_F(CrackKeys, PaintOnAFilesVerticesBecomesAStrength) {
  // A cube with 0 painted on its lower and 1 on its upper vertices.
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
      "property float paint\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n";
  for (int i = 0; i < 8; ++i)
    ply += std::to_string(i & 1) + " " + std::to_string((i >> 1) & 1) + " " + std::to_string(i >> 2) + " " +
           std::to_string((i >> 1) & 1) + "\n";
  write("cube.ply", ply + "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n");
  const Scene scene = load(
      "[[body]]\nname = \"cube\"\nmesh = \"cube.ply\"\nscale = 0.1\n"
      "material = {strength = {kind = \"attribute\", name = \"paint\", low = 1e7, high = 3e7}}\n");
  std::vector<std::string> messages;
  const SurfaceMesh mesh = scene_mesh(scene.bodies[0], messages);
  const MaterialFields fields = scene_fields(scene.bodies[0], mesh);
  for (const Real y : {0.0, 0.03, 0.1}) EXPECT_NEAR(fields.strength->at({0.1, y, 0.05}), 1e7 + 2e8 * y, 10);
}

TEST_F(CrackKeys, GuidedCracksAndNotchesArrive) {
  write("cut.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Scene scene = load(kBall + R"([[body.crack]]
kind = "plane"
point = [0, 0.1, 0]
normal = [2, 0, 0]
time = 0.5
[[body.crack]]
kind = "polyline"
points = [[-0.1, 0, 0.1], [0, 0.01, 0.1], [0.1, 0, 0.1]]
inward = [0, 0, -1]
depth = 0.05
[[body.crack]]
kind = "surface"
mesh = "cut.obj"
[[body.notch]]
kind = "plane"
point = [0, 0.1, 0]
normal = [1, 0, 0]
depth = 0.02
width = 0.004
[[body.notch]]
kind = "polyline"
points = [[-0.1, 0, 0.1], [0.1, 0, 0.1]]
inward = [0, 0, -1]
depth = 0.03
width = 0.005
)");
  const SceneBody& ball = scene.bodies[0];
  ASSERT_EQ(ball.cracks.size(), 3u);
  const GuidePlane& plane = std::get<GuidePlane>(ball.cracks[0].guide);
  EXPECT_EQ(plane.point, (Vec3{0, 0.1, 0}));
  EXPECT_EQ(plane.normal, (Vec3{1, 0, 0}));
  EXPECT_EQ(plane.depth, 0);
  EXPECT_EQ(ball.cracks[0].time, 0.5);
  const GuidePolyline& line = std::get<GuidePolyline>(ball.cracks[1].guide);
  EXPECT_EQ(line.points.size(), 3u);
  EXPECT_EQ(line.points[1], (Vec3{0, 0.01, 0.1}));
  EXPECT_EQ(line.inward, (Vec3{0, 0, -1}));
  EXPECT_EQ(line.depth, 0.05);
  EXPECT_EQ(std::get<std::filesystem::path>(ball.cracks[2].guide), folder_ / "cut.obj");
  std::vector<std::string> messages;
  EXPECT_EQ(std::get<SurfaceMesh>(scene_guide(ball, ball.cracks[2], messages)).triangle_count(), 1u);
  ASSERT_EQ(ball.notches.size(), 2u);
  EXPECT_EQ(std::get<GuidePlane>(ball.notches[0].guide).depth, 0.02);
  EXPECT_EQ(ball.notches[0].width, 0.004);
  EXPECT_EQ(std::get<GuidePolyline>(ball.notches[1].guide).depth, 0.03);
}

TEST_F(CrackKeys, ASurfaceIsScaledAndTurnedAsTheBodysFile) {
  write("cube.obj", [] {
    // Twice as high (z up) as wide.
    std::string text;
    for (int i = 0; i < 8; ++i)
      text +=
          "v " + std::to_string(i & 1) + " " + std::to_string((i >> 1) & 1) + " " + std::to_string(2 * (i >> 2)) + "\n";
    return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  }());
  write("cut.obj", "v -1 -1 1\nv 2 -1 1\nv 2 2 1\nv -1 2 1\nf 1 2 3\nf 1 3 4\n");
  const Scene scene = load(
      "[[body]]\nname = \"box\"\nmesh = \"cube.obj\"\nup = \"z\"\nfit_height = 0.5\n"
      "[[body.crack]]\nkind = \"surface\"\nmesh = \"cut.obj\"\n");
  std::vector<std::string> messages;
  const SurfaceMesh cut = std::get<SurfaceMesh>(scene_guide(scene.bodies[0], scene.bodies[0].cracks[0], messages));
  ASSERT_EQ(cut.vertex_count(), 4u);
  for (std::size_t v = 0; v < 4; ++v) EXPECT_EQ(cut.vertices[v].y, 0.25);  // half of the height
  EXPECT_EQ(bounding_box(cut).high.x, 0.5);
}

TEST_F(CrackKeys, ASurfaceThatIsNoneIsRefused) {
  write("cut.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n");
  const Scene scene = load(kBall + "[[body.crack]]\nkind = \"surface\"\nmesh = \"cut.obj\"\n");
  std::vector<std::string> messages;
  try {
    scene_guide(scene.bodies[0], scene.bodies[0].cracks[0], messages);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(
        std::string(error.what()).substr(folder_.string().size()),
        "/cut.obj: cannot guide a crack: 1 edges with more than two triangles, 0 with neighbours that face opposite "
        "ways, 0 triangles without area; make it one consistently oriented surface without them");
  }
}

TEST_F(CrackKeys, ImpossibleGuidesAreRefused) {
  const auto crack = [&](const std::string& text) { return problem(kBall + "[[body.crack]]\n" + text); };
  EXPECT_EQ(crack("point = [0, 0, 0]\n"),
            "scene.toml:4:1: body.crack.kind: missing; allowed values: plane, polyline, "
            "surface");
  EXPECT_EQ(crack("kind = \"plane\"\npoint = [0, 0, 0]\n"),
            "scene.toml:4:1: body.crack.normal: missing; allowed range: a direction [x, y, z], not zero");
  EXPECT_EQ(crack("kind = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, 0]\n"),
            "scene.toml:7:10: body.crack.normal: value [0, 0, 0] not allowed; allowed range: a direction, not zero");
  EXPECT_EQ(crack("kind = \"polyline\"\npoints = [[0, 0, 0]]\ninward = [0, 0, 1]\n"),
            "scene.toml:6:10: body.crack.points: value [[0, 0, 0]] not allowed; allowed type: at least two points [[x, "
            "y, z], ...], successive ones apart");
  EXPECT_EQ(crack("kind = \"polyline\"\npoints = [[0, 0, 0], [0, 0, 0]]\ninward = [0, 0, 1]\n"),
            "scene.toml:6:22: body.crack.points[1]: value [0, 0, 0] not allowed; allowed place: another than the point "
            "before");
  EXPECT_EQ(crack("kind = \"polyline\"\npoints = [[0, 0, 0], [0, 0, 2]]\ninward = [0, 0, 1]\n"),
            "scene.toml:7:10: body.crack.inward: value [0, 0, 1] not allowed; allowed direction: off the line; between "
            "points 0 and 1 it lies along it");
  // The direction that stands in for a missing one lies along this line.
  EXPECT_EQ(crack("kind = \"polyline\"\npoints = [[0, 0, 0], [0, 2, 0], [0, 2, 1], [1, 2, 1]]\n"),
            "scene.toml:4:1: body.crack.inward: missing; allowed range: a direction [x, y, z], not zero");
  EXPECT_EQ(crack("kind = \"surface\"\nmesh = \"none.obj\"\n"),
            "scene.toml:6:8: body.crack.mesh: value \"none.obj\" not allowed; allowed files: one that exists (none.obj "
            "does not)");
  EXPECT_EQ(crack("kind = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\ntime = 3\n"),
            "scene.toml:8:8: body.crack.time: value 3 not allowed; allowed range 0 to 2 s, the scene's duration");
  EXPECT_EQ(problem(kBall + "breakable = false\n[[body.crack]]\nkind = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, "
                            "1]\n"),
            "scene.toml:5:1: body.crack: value {kind = \"plane\", normal = [0, 0, 1], point = [0, 0, 0]} not allowed; "
            "allowed use: in a breakable body");
  EXPECT_EQ(problem(kBall + "crack = 3\n"),
            "scene.toml:4:9: body.crack: value 3 not allowed; allowed type: tables, each begun by [[body.crack]]");
  EXPECT_EQ(problem(kBall + "[[body.notch]]\nkind = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\nwidth = 0\n"),
            "scene.toml:4:1: body.notch.depth: missing; allowed range 1e-06 to 10000 m\n"
            "scene.toml:8:9: body.notch.width: value 0 not allowed; allowed range 1e-06 to 10000 m");
  EXPECT_EQ(problem(kBall + "[[body.notch]]\nkind = \"surface\"\n"),
            "scene.toml:5:8: body.notch.kind: value \"surface\" not allowed; allowed values: plane, polyline");
}

const std::string kRegion = "region = {low = [-1, 0.05, -1], high = [1, 1, 1]}\n";

TEST_F(CrackKeys, LoadsArrive) {
  const Scene scene = load(kBall + "[[load]]\nbody = \"ball\"\n" + kRegion +
                           "facing = [0, 3, 0]\nforce = [0, 10, 0]\nmoment = [0, 2, 0]\nfrom = 0.1\nuntil = 0.2\n"
                           "[[load]]\nbody = \"ball\"\n" +
                           kRegion + "force = [0, 10, 0]\n");
  ASSERT_EQ(scene.loads.size(), 2u);
  const SceneLoad& load = scene.loads[0];
  EXPECT_EQ(load.body, 0u);
  EXPECT_EQ(load.region.low, (Vec3{-1, 0.05, -1}));
  EXPECT_EQ(load.region.high, (Vec3{1, 1, 1}));
  EXPECT_EQ(load.facing, (Vec3{0, 1, 0}));
  EXPECT_EQ(load.force, (Vec3{0, 10, 0}));
  EXPECT_EQ(load.moment, (Vec3{0, 2, 0}));
  EXPECT_EQ(load.from, 0.1);
  EXPECT_EQ(load.until, 0.2);
  EXPECT_EQ(scene.loads[1].facing, Vec3{});
  EXPECT_EQ(scene.loads[1].from, 0);
  EXPECT_GT(scene.loads[1].until, 1e300);
}

TEST_F(CrackKeys, ImpossibleLoadsAreRefused) {
  const auto load_problem = [&](const std::string& text) { return problem(kBall + "[[load]]\n" + text); };
  EXPECT_EQ(load_problem("body = \"bal\"\nforce = [1, 0, 0]\n" + kRegion),
            "scene.toml:5:8: load.body: value \"bal\" not allowed; allowed values: breakable bodies: ball");
  EXPECT_EQ(load_problem("body = \"ball\"\n" + kRegion), "scene.toml:4:1: load: needs a force or a moment");
  EXPECT_EQ(load_problem("body = \"ball\"\nforce = [1, 0, 0]\n"),
            "scene.toml:4:1: load.region: missing; allowed type: a table {low = [x, y, z], high = [x, y, z]}");
  EXPECT_EQ(
      load_problem("body = \"ball\"\nforce = [1, 0, 0]\nregion = {low = [0, 0, 0], high = [1, 0, 1]}\n"),
      "scene.toml:7:35: load.region.high: value [1, 0, 1] not allowed; allowed range: above low along every axis");
  EXPECT_EQ(load_problem("body = \"ball\"\nforce = [1, 0, 0]\nfrom = 1\nuntil = 1\n" + kRegion),
            "scene.toml:8:9: load.until: value 1 not allowed; allowed range above 1 and up to 3600 s, after `from`");
}

TEST_F(CrackKeys, FractureOptionsArriveAndAreChecked) {
  const Scene scene = load(kBall + "[fracture]\nrounds = 3\ninterior_seeds = true\ndust = \"keep\"\n");
  EXPECT_EQ(scene.fracture.rounds, 3);
  EXPECT_TRUE(scene.fracture.interior_seeds);
  EXPECT_EQ(scene.fracture.dust, SceneDust::kKeep);
  EXPECT_EQ(problem(kBall + "[fracture]\ndust = \"sweep\"\nrounds = 0\n"),
            "scene.toml:5:8: fracture.dust: value \"sweep\" not allowed; allowed values: drop, keep\n"
            "scene.toml:6:10: fracture.rounds: value 0 not allowed; allowed range 1 to 8");
}

}  // namespace
}  // namespace sherd
