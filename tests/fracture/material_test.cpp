// What a material that varies does to growing cracks.
#include <gtest/gtest.h>

#include "engine/material/field_spec.h"
#include "tests/fracture/crack_support.h"

namespace sherd {
namespace {

const Specimen& ball() {
  static const Specimen specimen(make_sphere(1, 0.1));
  return specimen;
}

GrowthResult grow_from_below(const ScalarField* propagation) {
  const FunctionField field(constant_direction({1, 0, 0}));  // 1 Pa
  GrowthOptions options = ball().options();
  options.propagation_field = propagation;
  return grow_crack(ball().bvh, field, ball().seed_at(ball().nearest_vertex({0, -1, 0}), field), options);
}

TEST(VaryingMaterial, AConstantFieldIsTheNumber) {
  const ScalarFieldPtr constant = constant_field(ball().options().propagation_strength);
  const GrowthResult number = grow_from_below(nullptr), field = grow_from_below(constant.get());
  EXPECT_EQ(number.outcome, GrowthOutcome::kComplete);
  EXPECT_EQ(number.sheet.position, field.sheet.position);
  EXPECT_EQ(number.sheet.triangles, field.sheet.triangles);
}

TEST(VaryingMaterial, ACrackStopsAtAToughLayer) {
  const Real border = 0.2, h = ball().h;
  const ScalarFieldPtr layers = make_field(LayerSpec{.offsets = {border}, .values = {0.5, 2}}, {}, {});
  const GrowthResult r = grow_from_below(layers.get());
  ASSERT_EQ(r.outcome, GrowthOutcome::kArrested) << r.reason;
  Real highest = -1;
  for (std::size_t v = 0; v < r.sheet.position.size(); ++v) highest = std::max(highest, r.sheet.position[v].y);
  EXPECT_GT(highest, border);
  EXPECT_LT(highest, border + 0.8 * h);  // the longest step
  // And it took all of the weak side: the disc below the border, less a step along it.
  const Real below = std::acos(-border) - (-border) * std::sqrt(1 - border * border);
  EXPECT_NEAR(r.area, below, 2 * 0.8 * h);
}

TEST(VaryingMaterial, EveryStoppedNodeStandsInAToughPlace) {
  const ScalarFieldPtr grains =
      make_field(GrainSpec{.mean = 0.9, .size = 0.35, .spread = 0.5, .boundary = 0.6, .seed = 4}, {}, {});
  const GrowthResult r = grow_from_below(grains.get());
  ASSERT_EQ(r.outcome, GrowthOutcome::kArrested) << r.reason;
  EXPECT_EQ(r.ladder_level, 0);
  std::size_t stopped = 0;
  for (std::size_t v = 0; v < r.sheet.position.size(); ++v) {
    if (r.sheet.state[v] != NodeState::kArrested) continue;
    ++stopped;
    EXPECT_GT(grains->at(r.sheet.position[v]), 1);
  }
  EXPECT_GT(stopped, 5u);
  EXPECT_EQ(check_grown(r, ball(), ball().options().thickness), "");
}

}  // namespace
}  // namespace sherd
