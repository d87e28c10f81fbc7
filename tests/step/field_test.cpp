// Fields shown as colours: values against elasticity by hand, and what becomes of them when bodies break.
#include <gtest/gtest.h>

#include "engine/step/shown_field.h"
#include "tests/step/run_scene.h"

namespace sherd {
namespace {

// 2 MPa of tension along x; nothing breaks.
std::string stretched(const std::string& output) {
  return R"(
gravity = [0, 0, 0]
time_step = 0.001
duration = 0.002
frame_rate = 1000
[[body]]
name = "bar"
shape = {kind = "bar", length = 0.4, height = 0.1, width = 0.1}
edge_length = 0.05
material = {preset = "concrete", strength = 1e12}
[[load]]
body = "bar"
region = {low = [0.199, -1, -1], high = [0.201, 1, 1]}
force = [2e4, 0, 0]
facing = [1, 0, 0]
[[load]]
body = "bar"
region = {low = [-0.201, -1, -1], high = [-0.199, 1, 1]}
force = [-2e4, 0, 0]
facing = [-1, 0, 0]
[ground]
enabled = false
[output]
)" + output;
}
constexpr Real kStress = 2e6, kYoung = 31e9, kPoisson = 0.2;  // of concrete

TEST(ShownField, StrainEnergyIsHalfStressTimesStrain) {
  const Elastic material{13e9, 0.27};
  const Sym3 s{1.5e6, -2e6, 0.4e6, 0.7e6, -0.3e6, 1.1e6};
  const Real young = 2 * material.mu * (1 + material.nu), nu = material.nu;
  // Hooke's law component by component.
  const Real ex = (s.xx - nu * (s.yy + s.zz)) / young, ey = (s.yy - nu * (s.xx + s.zz)) / young,
             ez = (s.zz - nu * (s.xx + s.yy)) / young;
  const Real shear = (s.yz * s.yz + s.xz * s.xz + s.xy * s.xy) / material.mu;
  const Real exact = 0.5 * (s.xx * ex + s.yy * ey + s.zz * ez + shear);
  EXPECT_NEAR(strain_energy_density(s, material), exact, 1e-14 * exact);
}

// The solver carries uniform stress exactly on any mesh; what is left is its tolerance, 1e-4.
TEST(ShownField, AStretchedBarHasTheSameEnergyEverywhere) {
  const RunResult run = run_scene(stretched("field = \"strain_energy\"\n"), 1);
  EXPECT_FALSE(run.frames.front().scale);  // before the first solve
  const Frame& last = run.frames.back();
  ASSERT_TRUE(last.scale);
  EXPECT_EQ(last.scale->unit, "J/m3");
  const FrameBody& bar = last.bodies.at(0);
  ASSERT_TRUE(bar.field);
  ASSERT_EQ(bar.field->value.size(), 3 * bar.mesh->triangle_count());
  const Real exact = kStress * kStress / (2 * kYoung);
  for (const float v : bar.field->value) EXPECT_NEAR(v, exact, 1e-3 * exact);
  EXPECT_EQ(bar.field->displacement.size(), 0u);
  EXPECT_NEAR(run.stats["field"]["high"].get<Real>(), exact, 1e-3 * exact);
}

TEST(ShownField, AStretchedBarMovesByItsStrain) {
  const RunResult run = run_scene(stretched("field = \"displacement\"\ndeformation = 1000\n"), 1);
  const FrameBody& bar = run.frames.back().bodies.at(0);
  ASSERT_TRUE(bar.field);
  const SurfaceMesh& mesh = *bar.mesh;
  const Real strain = kStress / kYoung, end = 0.2 * strain;
  ASSERT_EQ(bar.field->displacement.size(), mesh.vertex_count());
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3 x = mesh.vertices[v];
    const Vec3 exact = strain * Vec3{x.x, -kPoisson * x.y, -kPoisson * x.z};
    EXPECT_LT(distance(bar.field->displacement[v], 1000 * exact), 1000 * 1e-3 * end);
  }
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(bar.field->value[3 * t + k] * 1000, norm(bar.field->displacement[mesh.triangles[t][k]]), 1e-3 * end);
}

TEST(ShownField, TheRangeIsTheScenesOrLeavesOutTheHighestFiftieth) {
  SurfaceField field;
  for (int i = 0; i < 1000; ++i) field.value.push_back(static_cast<float>(i));
  FieldScale scale = field_scale({FieldKind::kStrainEnergy, {}, 0});
  widen(scale, {FieldKind::kStrainEnergy, {}, 0}, field);
  EXPECT_EQ(scale.low, 0);
  EXPECT_EQ(scale.high, 979);  // of 0 .. 999
  field.value.assign(10, -5);
  widen(scale, {FieldKind::kStrainEnergy, {}, 0}, field);
  EXPECT_EQ(scale.low, -5);
  EXPECT_EQ(scale.high, 979);
  const SceneField fixed{FieldKind::kMaxPrincipal, std::pair<Real, Real>{-1, 7}, 0};
  scale = field_scale(fixed);
  widen(scale, fixed, field);
  EXPECT_EQ(scale.low, -1);
  EXPECT_EQ(scale.high, 7);
}

// A plaster bar that lands on one end breaks at once: what is shown afterwards are pieces.
const std::string kDropped = R"(
time_step = 0.001
duration = 0.01
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

TEST(ShownField, PiecesCarryTheStressTheyBrokeUnder) {
  const RunResult run = run_scene(kDropped + "[output]\nfield = \"max_principal\"\n", 1);
  const Frame& last = run.frames.back();
  ASSERT_GE(last.bodies.size(), 2u);
  float largest = 0;
  for (const FrameBody& b : last.bodies) {
    ASSERT_TRUE(b.field) << b.name;
    ASSERT_EQ(b.field->value.size(), 3 * b.mesh->triangle_count()) << b.name;
    // Cracks went where the tension exceeded the propagation strength: their walls bear it.
    for (std::size_t t = 0; t < b.mesh->triangle_count(); ++t)
      if (b.mesh->faces.kind[t] == FaceKind::kCrack)
        for (std::size_t k = 0; k < 3; ++k) largest = std::max(largest, b.field->value[3 * t + k]);
  }
  EXPECT_GT(largest, 0.25e6);
}

TEST(ShownField, ChangesNothingElse) {
  RunResult plain = run_scene(kDropped, 1);
  RunResult shown = run_scene(kDropped + "[output]\nfield = \"displacement\"\n", 2);
  EXPECT_TRUE(shown.stats.contains("field"));
  shown.stats.erase("field");
  for (RunResult* r : {&plain, &shown}) r->stats.erase("scene_digest");  // of the text, which is another
  EXPECT_EQ(shown.stats, plain.stats);
}

}  // namespace
}  // namespace sherd
