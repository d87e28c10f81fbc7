#include "engine/mesh/thickness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "engine/mesh/shapes.h"
#include "engine/mesh/thickness_resolution.h"
#include "kernels/core/error.h"
#include "kernels/core/parallel.h"

namespace sherd {
namespace {

constexpr Real kInfinity = std::numeric_limits<Real>::infinity();

// Maps every vertex.
template <class F>
SurfaceMesh mapped(SurfaceMesh mesh, const F& to) {
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) mesh.vertices.set(i, to(mesh.vertices[i]));
  return mesh;
}

// A prism along z: opening angle `angle` (radians) at its edge x = y = 0, cut off flat at x = 1.
SurfaceMesh wedge(Real angle, Real edge) {
  const Real tip = 1e-6;  // half width of the flat at the edge that the box's combinatorics leave
  return mapped(make_box({1, 1, 1}, edge), [=](const Vec3& p) {
    const Real x = p.x + 0.5;
    return Vec3{x, p.y * 2 * (x * std::tan(angle / 2) + tip), p.z};
  });
}

TEST(Thickness, PlatesSlabsAndCubesReadExactly) {
  for (const Vec3 size : {Vec3{1, 0.01, 1}, Vec3{1, 0.3, 0.5}, Vec3{1, 1, 1}}) {
    const SurfaceMesh mesh = make_box(size, 0.1);
    const WallThickness t = wall_thickness(mesh);
    for (std::size_t f = 0; f < mesh.triangle_count(); ++f) {
      const Vec3 n = normalized(mesh.area_normal2(f));
      const Real across = std::abs(dot(n, size));  // axis-aligned faces
      EXPECT_NEAR(t.face[f], across, 1e-12) << f;
    }
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      Real least = kInfinity;  // of the faces the vertex lies on
      for (int k = 0; k < 3; ++k)
        if (std::abs(std::abs(mesh.vertices[v][k]) - 0.5 * size[k]) < 1e-12) least = std::min(least, size[k]);
      EXPECT_NEAR(t.vertex[v], least, 1e-12);
    }
  }
}

TEST(Thickness, AnywhereAndAtAnyScaleTheSame) {
  const Vec3 x = normalized(Vec3{1, 2, -1}), y = normalized(cross(x, Vec3{0, 0, 1})), z = cross(x, y);
  const SurfaceMesh plate = make_plate(1, 1, 0.02, 0.1);
  for (const Real scale : {1e-3, 1.0, 1e3}) {
    const SurfaceMesh mesh = mapped(plate, [&](const Vec3& p) {
      return (x * p.x + y * p.y + z * p.z + Vec3{3, -2, 5}) * scale;
    });
    const WallThickness t = wall_thickness(mesh);
    // Coordinates of size 6 are rounded to 4e-16 each.
    for (std::size_t f = 0; f < mesh.triangle_count(); ++f)
      if (std::abs(dot(normalized(mesh.area_normal2(f)), y)) > 0.5) {
        EXPECT_NEAR(t.face[f] / scale, 0.02, 1e-13);
      }
  }
}

TEST(Thickness, ShellsReadTheirRadialThickness) {
  const Real outer = 1, inner = 0.9, edge = 0.05;
  const SurfaceMesh mesh = make_hollow_sphere(outer, inner, edge);
  const WallThickness t = wall_thickness(mesh);
  // Facets are inscribed: with circumradius c <= 1.3 edge / sqrt(3) each of the two lies at most c^2 / (2 radius) below
  // its sphere.
  const Real sag = std::pow(1.3 * edge, 2) / 3 / (2 * inner);
  for (const Real value : t.face) EXPECT_NEAR(value, outer - inner, sag);
  for (const Real value : t.vertex) EXPECT_NEAR(value, outer - inner, sag);
}

TEST(Thickness, SolidsOfRevolutionReadTheirWalls) {
  const Real wall = 0.003;
  const SurfaceMesh goblet = make_goblet(0.18, 0.04, wall, 0.003);
  const WallThickness t = wall_thickness(goblet);
  std::size_t bowl = 0;
  // The bowl's upper half, below the rounded lip: wall exact but for the facets of both sides, whose sagitta is
  // chord^2 / (8 radius) with chords up to sqrt(2) edges.
  const Real sag = 2 * 0.003 * 0.003 / 8 / (0.04 - wall);
  for (std::size_t f = 0; f < goblet.triangle_count(); ++f) {
    const Real y = goblet.centroid(f).y;
    if (y < 0.13 || y > 0.18 - 2 * wall) continue;
    EXPECT_NEAR(t.face[f], wall, 2 * sag + 0.02 * wall);  // and neighbouring rings are stitched at other angles
    ++bowl;
  }
  EXPECT_GT(bowl, 1000u);
}

TEST(Thickness, OfAWedgeGrowsWithTheDistanceAndItsTipIsNoWall) {
  const Real angle = 25 * std::numbers::pi / 180, edge = 0.05;
  const SurfaceMesh mesh = wedge(angle, edge);
  const WallThickness t = wall_thickness(mesh);
  std::size_t checked = 0;
  for (std::size_t f = 0; f < mesh.triangle_count(); ++f) {
    const Vec3 c = mesh.centroid(f), n = normalized(mesh.area_normal2(f));
    if (std::abs(n.y) < 0.5) continue;
    const Real d = std::hypot(c.x, c.y);
    if (c.x < edge) {
      EXPECT_EQ(t.face[f], kInfinity);  // the first row: whatever the mesh, T goes to zero there
    } else if (d < 0.8) {               // beyond, the ray along the normal leaves through the flat back
      EXPECT_NEAR(t.face[f], d * std::tan(angle), 1e-5);  // the flat at the tip is 2e-6 wide
      ++checked;
    }
  }
  EXPECT_GT(checked, 500u);
}

TEST(Thickness, BluntEdgesAreNoWalls) {
  const SurfaceMesh mesh = wedge(60 * std::numbers::pi / 180, 0.1);
  const WallThickness t = wall_thickness(mesh);
  for (std::size_t f = 0; f < mesh.triangle_count(); ++f)
    if (std::abs(normalized(mesh.area_normal2(f)).y) > 0.5) {
      EXPECT_EQ(t.face[f], kInfinity);
    }
}

TEST(Thickness, IsTheSameForAnyThreadCountAndBadOptionsThrow) {
  const SurfaceMesh mesh = make_dinner_plate(1, 0.05, 0.05);
  const WallThickness once = wall_thickness(mesh);
  const ThreadLimit one(1);
  EXPECT_EQ(wall_thickness(mesh).face, once.face);
  EXPECT_THROW(wall_thickness(mesh, {.parallel_angle = 90}), InputError);
  EXPECT_THROW(wall_thickness(mesh, {.cone_angle = std::nan("")}), InputError);
  EXPECT_THROW(wall_thickness(mesh, {.cone_rays = -1}), InputError);
  EXPECT_THROW(wall_thickness(mesh, {.tip_ratio = 1}), InputError);
}

TEST(Thickness, OpenAndEmptyMeshesHaveNoWallsAndDoNotFail) {
  SurfaceMesh sheet = make_plate(1, 1, 0.1, 0.5);
  SurfaceMesh top;
  top.vertices = sheet.vertices;
  for (std::size_t f = 0; f < sheet.triangle_count(); ++f)
    if (normalized(sheet.area_normal2(f)).y > 0.5)
      top.add_triangle(sheet.triangles[f][0], sheet.triangles[f][1], sheet.triangles[f][2]);
  for (const Real value : wall_thickness(top).face) EXPECT_EQ(value, kInfinity);
  const ResolutionReport report = resolution_report(top);
  EXPECT_EQ(report.worst, 0);
  EXPECT_EQ(report.wall_share, 0);
  EXPECT_TRUE(resolution_warnings(report).empty());
  EXPECT_TRUE(wall_thickness({}).face.empty());
  EXPECT_EQ(resolution_report({}).area, 0);
}

TEST(Resolution, SharesAndWorstOfAPlateAreThoseOfItsEdges) {
  const Real h = 0.1, thickness = 0.02;
  const SurfaceMesh mesh = make_plate(1, 1, thickness, h);
  const ResolutionReport r = resolution_report(mesh);
  const Real faces = 2 / (2 + 4 * thickness);  // the two large sides, of the whole surface
  // Right triangles of legs h: as an equilateral triangle, edge h sqrt(2 / sqrt(3)) = 1.0746 h, h / T = 5.37; at the
  // rim the mean area is smaller. The narrow sides have T = 1.
  EXPECT_NEAR(r.worst, std::sqrt(2 / std::sqrt(3.0)) * h / thickness, 1e-9);
  EXPECT_NEAR(r.share_above[0], faces, 1e-12);
  EXPECT_NEAR(r.share_above[3], faces, 1e-12);
  EXPECT_EQ(r.share_above[5], 0);
  EXPECT_NEAR(r.thinnest, thickness, 1e-12);
  EXPECT_NEAR(r.governing, thickness, 1e-12);
  EXPECT_NEAR(r.edge_for_5_percent, 3 * thickness, 1e-12);
  EXPECT_NEAR(r.edge_for_1_percent, 1.3 * thickness, 1e-12);
  EXPECT_NEAR(std::abs(r.worst_place.y), thickness / 2, 1e-12);
}

TEST(Resolution, WarnsAboveTheLimitWithTheRemedyAndTheRemedyHelps) {
  const Real thickness = 0.02;
  const ResolutionReport coarse = resolution_report(make_plate(1, 1, thickness, 0.1));
  const std::vector<std::string> warnings = resolution_warnings(coarse);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("edge_length = 0.06 for 5 %"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("0.026 for 1 %"), std::string::npos) << warnings[0];
  // The shapes' edges are legs of right triangles, 7 % shorter than the equilateral ones of the same area.
  EXPECT_TRUE(
      resolution_warnings(resolution_report(make_plate(1, 1, thickness, coarse.edge_for_5_percent / 1.08))).empty());
  // A poorer method needs more on the same mesh.
  const SurfaceMesh fine = make_plate(1, 1, thickness, 0.04);
  EXPECT_TRUE(resolution_warnings(resolution_report(fine)).empty());
  const ResolutionReport linear = resolution_report(fine, kLinearCollocationRule);
  EXPECT_EQ(resolution_warnings(linear, kLinearCollocationRule).size(), 1u);
  EXPECT_EQ(linear.edge_for_1_percent, 0);
}

TEST(Resolution, SolidsNeverWarn) {
  EXPECT_TRUE(resolution_warnings(resolution_report(make_box({1, 1, 1}, 0.3))).empty());
  EXPECT_TRUE(resolution_warnings(resolution_report(make_sphere(1, 0.5))).empty());
}

TEST(Resolution, JsonHasTheNumbersAndNullsWhereThereAreNone) {
  const ResolutionReport r = resolution_report(make_plate(1, 1, 0.02, 0.1));
  const auto json = nlohmann::json::parse(to_json(r));
  EXPECT_EQ(json["worst"].get<Real>(), r.worst);
  EXPECT_EQ(json["share_above"]["1.5"].get<Real>(), r.share_above[2]);
  EXPECT_EQ(json["edge_for_1_percent"].get<Real>(), r.edge_for_1_percent);
  EXPECT_TRUE(nlohmann::json::parse(to_json(resolution_report({})))["worst"].is_null());
  EXPECT_NE(to_text(r).find("above 6: 0 %"), std::string::npos) << to_text(r);
}

}  // namespace
}  // namespace sherd
