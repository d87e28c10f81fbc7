// What a load that was solved tells of the next one.
#include "engine/load/earlier_loads.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/mesh/bvh.h"
#include "engine/mesh/shapes.h"

namespace sherd {
namespace {

constexpr Real kTension = 7;  // Pa, of the earlier load: made up, far below what its bound alone would say

struct Cube {
  SurfaceMesh mesh = make_box({1, 1, 1}, 0.1);
  TriangleBvh bvh{mesh};
  std::vector<std::uint32_t> twins = build_twins(mesh);
  BoundedBody bounded{1.0 / 3, std::sqrt(3.0), false};

  std::vector<SpreadContact> spread_on(std::vector<BodyContact> contacts) const {
    return spread(mesh, contacts, twins, bvh);
  }
  Real bound(const std::vector<BodyContact>& contacts, const std::vector<SolvedLoad>& earlier, Real spin = 0) const {
    return tension_bound(bounded, spread_on(contacts), earlier, {0, 0, 1000, spin});
  }
  std::vector<SolvedLoad> solved(const std::vector<BodyContact>& contacts, Real spin = 0) const {
    return {{spread_on(contacts), spin, kTension}};
  }
};

BodyContact on_top(Real x, Real force) {
  return {{x, 0.5, 0.02}, {0, -force, 0}, 1e-3, 0.1};
}

TEST(EarlierLoads, SharesOfTheFacesAddUpToTheContact) {
  const Cube cube;
  const std::vector<SpreadContact> s = cube.spread_on({on_top(0.2, 3), on_top(0.5, 3)});
  ASSERT_EQ(s.size(), 2u);
  for (const SpreadContact& c : s) {
    Real sum = 0;
    std::uint32_t last = 0;
    for (const auto& [face, share] : c.shares) {
      EXPECT_TRUE(sum == 0 || face > last);
      EXPECT_GT(share, 0);
      sum += share, last = face;
    }
    EXPECT_NEAR(sum, 1, 1e-12);
  }
}

TEST(EarlierLoads, ALoadIsBoundedByItsMultipleOfTheSameLoad) {
  const Cube cube;
  const std::vector<SolvedLoad> earlier = cube.solved({on_top(0.2, 3), on_top(-0.2, 2)});
  ASSERT_GT(cube.bound({on_top(0.2, 3), on_top(-0.2, 2)}, {}), 10 * kTension);
  // Sums of a few terms of some 10 Pa, here and below: 1e-9 is far above their rounding, far below what is told apart.
  EXPECT_NEAR(cube.bound({on_top(0.2, 3), on_top(-0.2, 2)}, earlier), kTension, 1e-9);
  EXPECT_NEAR(cube.bound({on_top(0.2, 6), on_top(-0.2, 4)}, earlier), 2 * kTension, 1e-9);
}

TEST(EarlierLoads, WhatIsNewOrGoneIsBoundedAsALoadOfItsOwn) {
  const Cube cube;
  const std::vector<SolvedLoad> earlier = cube.solved({on_top(0.2, 3)});
  const Real extra = cube.bound({on_top(-0.2, 0.01)}, {});
  EXPECT_NEAR(cube.bound({on_top(0.2, 3), on_top(-0.2, 0.01)}, earlier), kTension + extra, 1e-9);
  const std::vector<SolvedLoad> both = cube.solved({on_top(0.2, 3), on_top(-0.2, 0.01)});
  EXPECT_NEAR(cube.bound({on_top(0.2, 3)}, both), kTension + extra, 1e-9);
  const Real spun = cube.bound({}, {}, 0.1);
  EXPECT_NEAR(cube.bound({on_top(0.2, 3)}, earlier, 0.1), kTension + spun, 1e-9);
  EXPECT_NEAR(cube.bound({on_top(0.2, 3)}, cube.solved({on_top(0.2, 3)}, 0.1)), kTension + spun, 1e-9);
}

// Close as it is, its pressure acts on another side of the cube.
TEST(EarlierLoads, AContactThatSlidOverAnEdgeIsANewOne) {
  const Cube cube;
  const BodyContact before{{0.5, 0.499, 0}, {-3, 0, 0}, 1e-3, 0.1}, now{{0.499, 0.5, 0}, {-3, 0, 0}, 1e-3, 0.1};
  EXPECT_EQ(cube.bound({now}, cube.solved({before})), cube.bound({now}, {}));
}

TEST(EarlierLoads, NoEarlierLoadRaisesABound) {
  const Cube cube;
  std::vector<SolvedLoad> earlier = cube.solved({on_top(0.2, 3)});
  earlier[0].tension = 1e9;
  EXPECT_EQ(cube.bound({on_top(0.2, 3)}, earlier), cube.bound({on_top(0.2, 3)}, {}));
}

}  // namespace
}  // namespace sherd
