#include <gtest/gtest.h>

#include "engine/material/scalar_field.h"
#include "engine/mesh/intersections.h"
#include "tests/fracture/crack_support.h"

namespace sherd {
namespace {

// n x n squares of side 1 in the plane z = 0, all border nodes in the given state.
CrackSheet grid(std::uint32_t n, NodeState border) {
  CrackSheet s;
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i) {
      s.position.push_back({static_cast<Real>(i), static_cast<Real>(j), 0});
      s.normal.push_back({0, 0, 1});
      s.state.push_back(i == 0 || j == 0 || i == n || j == n ? border : NodeState::kInterior);
    }
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
      s.triangles.push_back({a, b, c}), s.triangles.push_back({a, c, d});
    }
  return s;
}

// A second layer of 2 x 2 squares, displaced, and tilted by `slope` along x.
void add_layer(CrackSheet& sheet, const Vec3& by, Real slope) {
  const CrackSheet layer = grid(2, NodeState::kExited);
  const auto first = static_cast<std::uint32_t>(sheet.state.size());
  for (std::size_t v = 0; v < layer.state.size(); ++v) {
    const Vec3 p = layer.position[v];
    sheet.position.push_back(p + by + Vec3{0, 0, slope * (p.x - 1)});
    sheet.normal.push_back({0, 0, 1}), sheet.state.push_back(layer.state[v]);
  }
  for (const Triangle& t : layer.triangles) sheet.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

void expect_closed_embedded(const SurfaceMesh& slab) {
  for (const std::uint32_t t : build_twins(slab)) EXPECT_NE(t, kNone);
  EXPECT_EQ(count_self_intersections(slab), 0u);
  EXPECT_GT(signed_volume(slab), 0);
}

TEST(Thicken, ExitedBorderGivesAFullBox) {
  std::string reason;
  const auto slab = thicken(grid(4, NodeState::kExited), 0.1, 3, reason);
  ASSERT_TRUE(slab) << reason;
  expect_closed_embedded(*slab);
  EXPECT_NEAR(signed_volume(*slab), 16 * 0.1, 1e-12);
  for (std::size_t f = 0; f < slab->triangle_count(); ++f) {
    EXPECT_EQ(slab->faces.kind[f], FaceKind::kCrack);
    EXPECT_EQ(slab->faces.crack[f], 3);
  }
}

TEST(Thicken, ArrestedBorderGivesALens) {
  std::string reason;
  for (const std::uint32_t n : {1u, 2u, 5u}) {  // n = 1: every node is on the front
    const auto slab = thicken(grid(n, NodeState::kArrested), 0.1, 0, reason);
    ASSERT_TRUE(slab) << reason;
    expect_closed_embedded(*slab);
    EXPECT_LT(signed_volume(*slab), 0.1 * n * n);
    for (std::size_t v = 0; v < slab->vertices.size(); ++v) {
      const Vec3 p = slab->vertices[v];
      const bool border = p.x == 0 || p.y == 0 || p.x == n || p.y == n;
      EXPECT_EQ(p.z == 0, border);
    }
  }
}

TEST(Thicken, ALoneTriangleBecomesABipyramid) {
  CrackSheet s;
  for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}})
    s.position.push_back(p), s.normal.push_back({0, 0, 1}), s.state.push_back(NodeState::kArrested);
  s.triangles = {{0, 1, 2}};
  std::string reason;
  const auto slab = thicken(s, 0.3, 0, reason);
  ASSERT_TRUE(slab) << reason;
  expect_closed_embedded(*slab);
  EXPECT_NEAR(signed_volume(*slab), 0.5 * 0.3 / 3, 1e-15);  // two pyramids of height t / 2 over area 1/2
}

TEST(Thicken, MixedBorderTapersToTheFront) {
  CrackSheet s = grid(3, NodeState::kExited);
  for (std::uint32_t i = 0; i <= 3; ++i) s.state[12 + i] = NodeState::kArrested;  // the row y = 3
  std::string reason;
  const auto slab = thicken(s, 0.1, 0, reason);
  ASSERT_TRUE(slab) << reason;
  expect_closed_embedded(*slab);
  // Full thickness up to y = 2, then a wedge; the front's interior edges (none here) would add midpoints.
  EXPECT_NEAR(signed_volume(*slab), 0.1 * (6 + 1.5), 1e-12);
}

// Piecewise linear over the sheet's triangles: a field linear in x gives each triangle its mean over the corners.
TEST(Thicken, AFieldGivesEachNodeItsOwnThickness) {
  struct Ramp : ScalarField {
    Real at(const Vec3& x) const override { return 0.1 + 0.05 * x.x; }
    Real lower() const override { return 0.1; }
    Real upper() const override { return 0.3; }
  };
  const Ramp ramp;
  SlabOptions options;
  options.field = &ramp, options.crack = 3;
  std::string reason;
  const auto slab = thicken(grid(4, NodeState::kExited), options, reason);
  ASSERT_TRUE(slab) << reason;
  expect_closed_embedded(*slab);
  for (std::size_t v = 0; v < slab->vertex_count(); ++v)
    EXPECT_NEAR(2 * std::abs(slab->vertices[v].z), ramp.at(slab->vertices[v]), 1e-15);
  EXPECT_NEAR(signed_volume(*slab), 16 * 0.2, 1e-12);
}

TEST(Thicken, RefusesWithAReason) {
  std::string reason;
  EXPECT_FALSE(thicken(CrackSheet{}, 0.1, 0, reason));
  EXPECT_FALSE(reason.empty());
  EXPECT_FALSE(thicken(grid(2, NodeState::kExited), 0, 0, reason));
  EXPECT_FALSE(reason.empty());
  CrackSheet crossed = grid(2, NodeState::kExited);
  add_layer(crossed, {0.3, 0.2, 0.05}, 0.4);
  EXPECT_NE(check_sheet(crossed), "");
  EXPECT_FALSE(thicken(crossed, 0.1, 0, reason));
  EXPECT_FALSE(reason.empty());
}

// The second layer lies over one corner of the first; with its halved thickness there, the slab is embedded.
TEST(Thicken, ASheetThatComesCloserThanItsThicknessGetsThinnerThereAndOnlyThere) {
  CrackSheet sheet = grid(8, NodeState::kExited);
  add_layer(sheet, {-1.4, -1.3, 0.07}, 0);
  EXPECT_EQ(check_sheet(sheet), "");
  std::string reason;
  const auto slab = thicken(sheet, 0.1, 0, reason);
  ASSERT_TRUE(slab) << reason;
  expect_closed_embedded(*slab);
  std::size_t full = 0;
  for (std::size_t v = 0; v < slab->vertex_count(); ++v) {
    const Vec3 p = slab->vertices[v];
    if (p.x > 2 || p.y > 2) {
      EXPECT_NEAR(std::abs(p.z), 0.05, 1e-15);
      ++full;
    }
  }
  EXPECT_EQ(full, 2 * (81u - 9));
}

TEST(CheckSheet, NamesEachViolation) {
  const CrackSheet good = grid(3, NodeState::kExited);
  EXPECT_EQ(check_sheet(good), "");
  EXPECT_EQ(border_loops(good).size(), 1u);
  CrackSheet s = good;
  s.triangles[0] = {s.triangles[0][0], s.triangles[0][2], s.triangles[0][1]};
  EXPECT_NE(check_sheet(s).find("used"), std::string::npos);
  s = good;
  s.triangles = {{0, 1, 5}, {5, 6, 10}};  // two triangles that share one node
  EXPECT_NE(check_sheet(s).find("pinch"), std::string::npos);
  s = good;
  s.position.set(5, {2.5, 2.5, 0});
  EXPECT_NE(check_sheet(s).find("intersect"), std::string::npos);
  s = good;
  s.position.set(5, {std::nan(""), 0, 0});
  EXPECT_NE(check_sheet(s).find("finite"), std::string::npos);
}

}  // namespace
}  // namespace sherd
