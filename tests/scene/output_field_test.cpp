// The keys of a field shown as colours.
#include "tests/scene/scene_file.h"

namespace sherd {
namespace {

using OutputField = SceneFile;

TEST_F(OutputField, IsNoneUnlessAskedFor) {
  EXPECT_FALSE(load(kBall).output.field);
}

TEST_F(OutputField, TakesAKindARangeAndADeformation) {
  const Scene scene = load(kBall + "[output]\nfield = \"strain_energy\"\nfield_range = [0, 5e3]\ndeformation = 200\n");
  ASSERT_TRUE(scene.output.field);
  EXPECT_EQ(scene.output.field->kind, FieldKind::kStrainEnergy);
  ASSERT_TRUE(scene.output.field->range);
  EXPECT_EQ(*scene.output.field->range, (std::pair<Real, Real>{0, 5e3}));
  EXPECT_EQ(scene.output.field->deformation, 200);
  EXPECT_FALSE(load(kBall + "[output]\nfield = \"max_principal\"\n").output.field->range);
}

TEST_F(OutputField, RefusesWhatMeansNothing) {
  EXPECT_EQ(problem(kBall + "[output]\nfield = \"stress\"\n"),
            "scene.toml:5:9: output.field: value \"stress\" not allowed; allowed values: displacement, strain_energy, "
            "max_principal");
  EXPECT_EQ(problem(kBall + "[output]\nfield = \"displacement\"\nfield_range = [2, 1]\n"),
            "scene.toml:6:15: output.field_range: value [2, 1] not allowed; allowed form: [low, high], low below high");
  EXPECT_EQ(problem(kBall + "[output]\ndeformation = 10\n"),
            "scene.toml:5:15: output.deformation: value 10 not allowed; allowed use: together with output.field");
}

}  // namespace
}  // namespace sherd
