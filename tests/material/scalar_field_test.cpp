// Fields of material space: bounds hold at every point, and what is given is what is found.
#include "engine/material/scalar_field.h"

#include <gtest/gtest.h>

#include "engine/material/material.h"

namespace sherd {
namespace {

TEST(ScalarField, AConstantIsTheSameEverywhereAndItsOwnBound) {
  const ScalarFieldPtr field = constant_field(3.5);
  EXPECT_EQ(field->at({1, -2, 1e9}), 3.5);
  EXPECT_EQ(field->lower(), 3.5);
  EXPECT_EQ(field->upper(), 3.5);
}

TEST(ScalarField, AMaterialsNumbersBecomeConstantsAndZeroThicknessTheDefault) {
  Material m;
  m.strength = 5e6, m.propagation_strength = 2e6, m.crack_thickness = 0;
  const MaterialFields fields = constant_fields(m, 0.3);
  EXPECT_EQ(fields.strength->at({}), 5e6);
  EXPECT_EQ(fields.propagation_strength->at({}), 2e6);
  EXPECT_EQ(fields.crack_thickness->at({}), kDefaultThickness * 0.3);
  m.crack_thickness = 1e-4;
  EXPECT_EQ(constant_fields(m, 0.3).crack_thickness->at({}), 1e-4);
}

}  // namespace
}  // namespace sherd
