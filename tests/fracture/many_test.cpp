#include "engine/fracture/grow_many.h"

#include <gtest/gtest.h>

#include "tests/fracture/crack_support.h"

namespace sherd {
namespace {

const Specimen& cube() {
  static const Specimen body(make_box({1, 1, 1}, 0.1));
  return body;
}
const Specimen& sphere() {
  static const Specimen body(make_sphere(1, 0.15));
  return body;
}

CrackSeed seed_of(const Specimen& body, const Vec3& near, const CrackField& field, Real stress) {
  CrackSeed seed = body.seed_at(body.nearest_vertex(near), field);
  seed.stress.value = stress;
  return seed;
}

bool same(const GrowthResult& a, const GrowthResult& b) {
  return a.outcome == b.outcome && a.steps == b.steps && a.area == b.area && a.sheet.position == b.sheet.position &&
         a.sheet.state == b.sheet.state && a.sheet.triangles == b.sheet.triangles;
}

TEST(GrowCracks, OneSeedGrowsAsItDoesAlone) {
  const FunctionField field(noisy_direction({1, 0.2, 0}, 0.3, 8 * sphere().h, 3));
  const CrackSeed seed = seed_of(sphere(), {0, 1, 0}, field, 1);
  const auto many = grow_cracks(sphere().bvh, field, std::span(&seed, 1), sphere().options());
  ASSERT_EQ(many.size(), 1u);
  EXPECT_TRUE(same(many[0], grow_crack(sphere().bvh, field, seed, sphere().options())));
}

TEST(GrowCracks, HeadOnTheStrongerTakesThePlane) {
  const FunctionField field(constant_direction({1, 0, 0}));
  const CrackSeed seeds[2] = {seed_of(sphere(), {0, 1, 0}, field, 0.9), seed_of(sphere(), {0, -1, 0}, field, 1)};
  const auto r = grow_cracks(sphere().bvh, field, seeds, sphere().options());
  ASSERT_EQ(r[1].outcome, GrowthOutcome::kComplete) << r[1].reason;
  ASSERT_EQ(r[0].outcome, GrowthOutcome::kArrested) << r[0].reason;
  EXPECT_EQ(r[0].met, std::vector<std::int32_t>{1});
  for (const GrowthResult& g : r) EXPECT_EQ(check_grown(g, sphere(), sphere().options().thickness), "");
  // They start at the same time, so the weaker one gets about half-way.
  Real lowest = 1;
  for (std::size_t v = 0; v < r[0].sheet.position.size(); ++v) lowest = std::min(lowest, r[0].sheet.position[v].y);
  EXPECT_NEAR(lowest, 0, 2 * sphere().h);
}

TEST(GrowCracks, FromTheSideTheLaterOneStops) {
  // Planes x = const from the top and y = const from the left: the former is nearer to where they meet.
  const FunctionField field([](const Vec3& p) {
    return PrincipalStress{1, p.x < -0.1 ? Vec3{0, 1, 0} : Vec3{1, 0, 0}};
  });
  const CrackSeed seeds[2] = {seed_of(cube(), {-0.5, 0.3, 0}, field, 1), seed_of(cube(), {0.0, 0.5, 0}, field, 0.9)};
  const FunctionField across(constant_direction({0, 1, 0}));
  const auto r = grow_cracks(cube().bvh, field, seeds, cube().options());
  for (const GrowthResult& g : r) EXPECT_EQ(check_grown(g, cube(), cube().options().thickness), "") << g.reason;
}

TEST(GrowCracks, TheOrderOfTheSeedsMeansNothing) {
  // Eight seeds around a sphere in a field that no surface follows: head-on and sideways meetings of all kinds.
  const FunctionField field(rotating_direction({1, 0, 0}, {0, 0, 1}, {0, 0.6, 0.8}, 1.2));
  std::vector<CrackSeed> seeds;
  for (int k = 0; k < 8; ++k) {
    const Real a = k * M_PI / 4;
    seeds.push_back(
        seed_of(sphere(), {std::cos(a), 0.3 * std::cos(3 * a), std::sin(a)}, field, 1 + 0.05 * ((5 * k) % 8)));
  }
  const auto forward = grow_cracks(sphere().bvh, field, seeds, sphere().options());
  std::vector<CrackSeed> reversed(seeds.rbegin(), seeds.rend());
  const auto backward = grow_cracks(sphere().bvh, field, reversed, sphere().options());
  int grown = 0, junctions = 0;
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    const GrowthResult& a = forward[i];
    EXPECT_TRUE(same(a, backward[seeds.size() - 1 - i])) << i;
    if (a.outcome == GrowthOutcome::kRejectedSeed) continue;
    EXPECT_NE(a.outcome, GrowthOutcome::kFailed) << a.reason;
    EXPECT_EQ(check_grown(a, sphere(), sphere().options().thickness), "") << i;
    ++grown, junctions += !a.met.empty();
  }
  EXPECT_GE(grown, 4);
  EXPECT_GE(junctions, 2);
}

}  // namespace
}  // namespace sherd
