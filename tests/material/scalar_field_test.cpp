// Fields of material space: bounds hold at every point, and what is given is what is found.
#include "engine/material/scalar_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "engine/material/field_spec.h"
#include "engine/material/grain_field.h"
#include "engine/material/material.h"
#include "engine/mesh/shapes.h"
#include "kernels/core/error.h"
#include "kernels/core/random.h"

namespace sherd {
namespace {

Vec3 random_point(Random& random, Real size) {
  Vec3 p;
  for (int i = 0; i < 3; ++i) p[i] = random.uniform(-size, size);
  return p;
}

const NoiseSpec kNoise{.mean = 10, .amplitude = 0.4, .wavelength = 0.5, .seed = 3};
const NoiseSpec kLognormal{.mean = 10, .amplitude = 0.7, .wavelength = 0.3, .lognormal = true, .seed = 4};
const LayerSpec kLayers{.axis = {0, 1, 0}, .offsets = {-0.5, 0.25}, .values = {3, 5, 2}, .blend = 0.1};
const GrainSpec kGrains{.mean = 10, .size = 0.4, .spread = 0.3, .boundary = 0.5, .width = 0.1, .seed = 5};

class EveryField : public testing::TestWithParam<FieldSpec> {
 protected:
  ScalarFieldPtr field = make_field(GetParam(), {}, constant_field(7));
};
INSTANTIATE_TEST_SUITE_P(ScalarField, EveryField,
                         testing::Values(FieldSpec{ConstantSpec{4}}, FieldSpec{kNoise}, FieldSpec{kLognormal},
                                         FieldSpec{kLayers}, FieldSpec{kGrains}, FieldSpec{ShareSpec{0.5}}));

TEST_P(EveryField, StaysWithinItsBoundsAndTheSpecsOwn) {
  const FieldBounds bounds = bounds_of(GetParam(), {7, 7});
  EXPECT_EQ(field->lower(), bounds.lower);
  EXPECT_EQ(field->upper(), bounds.upper);
  Random random(1);
  for (int i = 0; i < 3000; ++i) {
    const Real value = field->at(random_point(random, i % 2 ? 1 : 1e6));
    EXPECT_GE(value, bounds.lower);
    EXPECT_LE(value, bounds.upper);
  }
}

TEST_P(EveryField, IsFiniteFarAwayAndTheSameWhenMadeAgain) {
  const ScalarFieldPtr again = make_field(GetParam(), {}, constant_field(7));
  Random random(2);
  for (const Real size : {1e-9, 1.0, 1e9, 1e300})
    for (int i = 0; i < 50; ++i) {
      const Vec3 x = random_point(random, size);
      EXPECT_TRUE(std::isfinite(field->at(x)));
      EXPECT_EQ(field->at(x), again->at(x));
    }
}

TEST(NoiseField, VariesOverAWavelengthAndIsSmoothBelow) {
  const ScalarFieldPtr noise = make_field(kNoise, {}, {});
  Random random(6);
  Real sum = 0, square = 0, step = 0;
  constexpr int kPoints = 4000;
  for (int i = 0; i < kPoints; ++i) {
    const Vec3 x = random_point(random, 20);
    const Real g = (noise->at(x) / kNoise.mean - 1) / kNoise.amplitude;
    const Real near = (noise->at(x + Vec3{0.01 * kNoise.wavelength, 0, 0}) / kNoise.mean - 1) / kNoise.amplitude;
    sum += g, square += g * g, step = std::max(step, std::abs(near - g));
  }
  // 4000 independent values of deviation s have a mean within 3 s / 63; s of gradient noise lies about 0.3 (Perlin's
  // with this scale), far from both 0 (a constant) and 1 (two values).
  const Real deviation = std::sqrt(square / kPoints);
  EXPECT_LT(std::abs(sum / kPoints), 0.05 * deviation);
  EXPECT_GT(deviation, 0.2);
  EXPECT_LT(deviation, 0.5);
  // Slope: fade' <= 15/8 on differences of up to 2 x 0.87 plus the gradient itself, times 2/sqrt(3), over half a
  // wavelength: below 5 a half wavelength, so below 0.1 for a hundredth of a wavelength (0.02 of a half).
  EXPECT_LT(step, 0.1);
}

TEST(NoiseField, AnotherSeedIsAnotherField) {
  NoiseSpec other = kNoise;
  other.seed = 99;
  const ScalarFieldPtr a = make_field(kNoise, {}, {}), b = make_field(other, {}, {});
  Random random(7);
  Real product = 0, square = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 x = random_point(random, 20);
    product += (a->at(x) - 10) * (b->at(x) - 10), square += (a->at(x) - 10) * (a->at(x) - 10);
  }
  EXPECT_LT(std::abs(product / square), 0.1);  // correlation of 2000 independent pairs: deviation 0.022
}

TEST(LayerField, EachLayerHasItsValueAndTheBlendIsLinear) {
  const ScalarFieldPtr layers = make_field(kLayers, {}, {});
  EXPECT_EQ(layers->at({9, -3, 1}), 3);
  EXPECT_EQ(layers->at({9, 0, 1}), 5);
  EXPECT_EQ(layers->at({9, 3, 1}), 2);
  EXPECT_NEAR(layers->at({0, -0.5, 0}), 4, 1e-12);
  EXPECT_NEAR(layers->at({0, -0.525, 0}), 3.5, 1e-12);
  EXPECT_NEAR(layers->at({0, 0.275, 0}), 2.75, 1e-12);
  LayerSpec sharp = kLayers;
  sharp.blend = 0;
  EXPECT_EQ(make_field(sharp, {}, {})->at({0, std::nextafter(0.25, 0), 0}), 5);
  EXPECT_EQ(make_field(sharp, {}, {})->at({0, 0.25, 0}), 2);
}

TEST(GrainField, AGrainHasOneStrengthAndItsBoundaryIsWeaker) {
  const GrainField grains(kGrains);
  Random random(8);
  std::map<std::array<std::int64_t, 3>, Real> strength;
  Real least = 1e9, most = 0, weakest = 1;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 x = random_point(random, 1);
    const GrainField::Place place = grains.place(x);
    if (place.to_boundary < kGrains.width * kGrains.size) continue;
    const auto [known, fresh] = strength.emplace(place.grain, grains.at(x));
    EXPECT_EQ(known->second, grains.at(x));
    least = std::min(least, grains.at(x)), most = std::max(most, grains.at(x));
  }
  EXPECT_GT(strength.size(), 100u);  // (2 / 0.4)^3 = 125 grains and those cut by the sides
  EXPECT_LT(strength.size(), 350u);
  EXPECT_LT(least, 0.75 * kGrains.mean);
  EXPECT_GT(most, 1.25 * kGrains.mean);
  // Along a line the grain changes where the distance to the boundary vanishes, and there the factor is reached.
  Vec3 at{-1, 0.03, 0.07};
  constexpr Real kStep = 1e-4;
  for (GrainField::Place before = grains.place(at); at.x < 1; at.x += kStep) {
    const GrainField::Place here = grains.place(at);
    EXPECT_LE(std::abs(here.to_boundary - before.to_boundary), 1.0001 * kStep) << "a distance";
    if (here.grain != before.grain) {
      EXPECT_LE(here.to_boundary, kStep);
      const auto own = strength.find(here.grain);
      if (own != strength.end()) weakest = std::min(weakest, grains.at(at) / own->second);
    }
    before = here;
  }
  EXPECT_NEAR(weakest, kGrains.boundary, 0.01);
}

// Brute force over all points of a block of cells against the search among neighbours.
TEST(GrainField, TheBoundaryIsThatOfTheVoronoiCells) {
  GrainSpec spec = kGrains;
  spec.spread = 0, spec.boundary = 0, spec.width = kWidestBoundary;
  const GrainField grains(spec);
  Random random(9);
  int near = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 x = random_point(random, 1);
    const GrainField::Place place = grains.place(x);
    if (place.to_boundary > kWidestBoundary * spec.size) continue;
    ++near;
    // No other grain within the distance, and another just beyond it in some direction.
    bool inside = true, beyond = false;
    for (int k = 0; k < 400; ++k) {
      const Vec3 direction = normalized(random_point(random, 1));
      inside = inside && grains.place(x + 0.999 * place.to_boundary * direction).grain == place.grain;
      beyond = beyond || grains.place(x + (1.1 * place.to_boundary + 1e-3) * direction).grain != place.grain;
    }
    EXPECT_TRUE(inside) << x.x << " " << x.y << " " << x.z;
    EXPECT_TRUE(beyond) << x.x << " " << x.y << " " << x.z;
  }
  EXPECT_GT(near, 100);
}

TEST(AttributeField, InterpolatesThePaintOnTheNearestSurface) {
  SurfaceMesh box = make_box({2, 2, 2}, 0.5);
  CornerChannel paint{.name = "strength", .components = 1, .value = {}};
  for (const Triangle& t : box.triangles)
    for (const std::uint32_t v : t) paint.value.push_back(static_cast<float>(0.5 + 0.5 * box.vertices[v].x));
  box.channels = {
      CornerChannel{.name = "other", .components = 2, .value = std::vector<float>(6 * box.triangle_count())}, paint};
  const ScalarFieldPtr field = make_field(AttributeSpec{"strength", 10, 30}, box, {});
  // The paint is linear in x on the sides, so interpolation is exact but for its single precision.
  for (const Real x : {-0.9, -0.2, 0.0, 0.37, 0.8}) EXPECT_NEAR(field->at({x, 0.97, 0.1}), 20 + 10 * x, 1e-5);
  EXPECT_NEAR(field->at({0.9, 0, 0}), 30, 1e-5);
  EXPECT_NEAR(field->at({5, 0, 0}), 30, 1e-5);
  EXPECT_EQ(field->lower(), 10);
  EXPECT_EQ(field->upper(), 30);
}

TEST(AttributeField, AMissingChannelIsNamedWithThoseThereAre) {
  SurfaceMesh box = make_box({1, 1, 1}, 1);
  const auto message = [&] {
    try {
      make_field(AttributeSpec{"paint", 1, 2}, box, {});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(
      message(),
      "the mesh has no vertex attribute \"paint\"; it has none: save it as PLY with a float property of that name "
      "at each vertex");
  box.channels.push_back({.name = "uv", .components = 2, .value = std::vector<float>(6 * box.triangle_count())});
  EXPECT_EQ(message(), "the mesh has no vertex attribute \"paint\"; it has \"uv\"");
}

TEST(LesserField, IsThePointwiseMinimum) {
  const ScalarFieldPtr a = make_field(kNoise, {}, {}), b = make_field(kGrains, {}, {});
  const ScalarFieldPtr lesser = lesser_field(a, b);
  Random random(10);
  for (int i = 0; i < 500; ++i) {
    const Vec3 x = random_point(random, 1);
    EXPECT_EQ(lesser->at(x), std::min(a->at(x), b->at(x)));
    EXPECT_GE(lesser->at(x), lesser->lower());
    EXPECT_LE(lesser->at(x), lesser->upper());
  }
}

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
