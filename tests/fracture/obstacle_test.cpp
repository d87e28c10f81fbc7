#include <gtest/gtest.h>

#include "engine/fracture/obstacles.h"
#include "tests/fracture/crack_support.h"

namespace sherd {
namespace {

const Specimen& cube() {
  static const Specimen body(make_box({1, 1, 1}, 0.1));
  return body;
}

// A crack in the plane x = const near 0.03 from the top of the cube to its middle.
const CrackSheet& notch() {
  static const CrackSheet sheet = [] {
    const FunctionField field([](const Vec3& p) { return PrincipalStress{p.y > 0 ? 1.0 : 0.1, {1, 0, 0}}; });
    const CrackSeed seed = cube().seed_at(cube().nearest_vertex({0.03, 0.5, 0}), field);
    const GrowthResult r = grow_crack(cube().bvh, field, seed, cube().options());
    EXPECT_EQ(r.outcome, GrowthOutcome::kArrested) << r.reason;
    return r.sheet;
  }();
  return sheet;
}

GrowthResult grow_at(const Specimen& body, const Vec3& near, const Vec3& e, const Obstacles* obstacles) {
  const FunctionField field(constant_direction(e));
  GrowthOptions o = body.options();
  o.obstacles = obstacles;
  return grow_crack(body.bvh, field, body.seed_at(body.nearest_vertex(near), field), o);
}

TEST(Obstacles, ACrackThatRunsIntoAStoppedOneStopsAtIt) {
  Obstacles obstacles;
  obstacles.add_sheet(7, notch());
  const Real x = notch().position[0].x;
  const GrowthResult r = grow_at(cube(), {-0.5, 0.25, 0}, {0, 1, 0}, &obstacles);
  ASSERT_EQ(r.outcome, GrowthOutcome::kArrested) << r.reason;
  EXPECT_EQ(r.ladder_level, 0);
  EXPECT_EQ(r.met, std::vector<std::int32_t>{7});
  EXPECT_EQ(check_grown(r, cube(), cube().options().thickness), "");
  std::size_t blocked = 0;
  for (std::size_t v = 0; v < r.sheet.state.size(); ++v)
    if (r.sheet.state[v] == NodeState::kBlocked) {
      ++blocked;
      EXPECT_NEAR(r.sheet.position[v].x, x, 1e-9);
    }
  EXPECT_GE(blocked, 8u);  // the width of the cube is 10 edges
  // The part of the cube on this side of the notch, but for the ends at the sides, which go on until they are through.
  EXPECT_NEAR(r.area, 0.5 + x, 0.5 * cube().h);
}

TEST(Obstacles, TheJunctionIsThroughOnceTheOtherCrackIs) {
  Obstacles obstacles;
  obstacles.add_sheet(7, notch());
  const GrowthResult r = grow_at(cube(), {-0.5, 0.25, 0}, {0, 1, 0}, &obstacles);
  ASSERT_EQ(r.outcome, GrowthOutcome::kArrested) << r.reason;
  // What is left of the cube on this side of the other crack: that crack's slab takes away half its thickness.
  const Real x = notch().position[0].x - 0.5e-3;
  SurfaceMesh mesh = make_box({0.5 + x, 1, 1}, 0.1);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    mesh.vertices.set(v, mesh.vertices[v] + Vec3{0.5 * (x - 0.5), 0, 0});
  const Specimen part(mesh);
  const FunctionField field(constant_direction({0, 1, 0}));
  const GrowthResult rest = resume_crack(part.bvh, field, r.sheet, cube().options());
  ASSERT_EQ(rest.outcome, GrowthOutcome::kComplete) << rest.reason;
  EXPECT_EQ(check_grown(rest, part, cube().options().thickness), "");
  EXPECT_NEAR(rest.area, 0.5 + x, 1e-3);
}

TEST(Obstacles, AStoppedCrackInTheSamePlaneIsNotInTheWay) {
  Obstacles obstacles;
  obstacles.add_sheet(7, notch());
  const GrowthResult with = grow_at(cube(), {0.03, -0.5, 0}, {1, 0.1, 0}, &obstacles);
  const GrowthResult without = grow_at(cube(), {0.03, -0.5, 0}, {1, 0.1, 0}, nullptr);
  ASSERT_EQ(with.outcome, GrowthOutcome::kComplete) << with.reason;
  EXPECT_TRUE(with.met.empty());
  EXPECT_EQ(with.sheet.position, without.sheet.position);
  EXPECT_EQ(with.sheet.triangles, without.sheet.triangles);
}

TEST(Obstacles, ACrackMeetsTheWallOfAnOlderOneAtARightAngle) {
  SurfaceMesh mesh = make_box({1, 1, 1}, 0.1);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    if (mesh.centroid(t).x > 0.5 - 1e-6) mesh.faces.kind[t] = FaceKind::kCrack;
  Obstacles obstacles;
  obstacles.set_walls(mesh);
  // The field's plane is tilted by atan(1 / 2) from a right angle with the wall.
  const auto slope = [&](const Obstacles* o) {
    const GrowthResult r = grow_at(cube(), {-0.5, -0.3, 0}, {-1, 2, 0}, o);
    EXPECT_EQ(r.outcome, GrowthOutcome::kComplete) << r.reason;
    Real sum = 0, area = 0;
    for (const Triangle& t : r.sheet.triangles) {
      const Vec3 a = r.sheet.position[t[0]], b = r.sheet.position[t[1]], c = r.sheet.position[t[2]];
      if ((a + b + c).x < 3 * (0.5 - cube().h)) continue;
      const Vec3 n = cross(b - a, c - a);
      sum += std::abs(n.x), area += norm(n);
    }
    EXPECT_GT(area, 0);
    return sum / area;  // of the crack's normal towards the wall's: 0 at a right angle
  };
  EXPECT_NEAR(slope(nullptr), std::sqrt(0.2), 0.01);
  EXPECT_LT(slope(&obstacles), 0.5 * std::sqrt(0.2));
}

}  // namespace
}  // namespace sherd
