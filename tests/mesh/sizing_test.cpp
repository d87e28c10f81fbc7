#include "engine/mesh/sizing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/mesh/shapes.h"
#include "engine/mesh/thickness_resolution.h"
#include "engine/mesh/validate.h"
#include "kernels/core/error.h"
#include "kernels/core/parallel.h"

namespace sherd {
namespace {

bool valid(const SurfaceMesh& mesh) {
  return is_valid(report_mesh(mesh, {.count_self_intersections = true}));
}

// A box 2 x 1 x 1 whose height falls to `thin` over the middle fifth of its length.
SurfaceMesh stepped_bar(Real thin, Real edge) {
  SurfaceMesh mesh = make_box({2, 1, 1}, edge);
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    Vec3 p = mesh.vertices[i];
    const Real s = std::clamp((p.x + 0.2) / 0.4, 0.0, 1.0);
    p.y *= 1 + s * (thin - 1);
    mesh.vertices.set(i, p);
  }
  return mesh;
}

TEST(Sizing, TargetsObeyTheThicknessTheBoundsAndTheGrowth) {
  const SurfaceMesh mesh = make_plate(1, 1, 0.02, 0.05);
  const SizingOptions options{.edge_length = 0.2, .edge_per_thickness = 2, .growth = 0.4, .finest = 0.1};
  Real unbounded = std::numeric_limits<Real>::infinity();
  std::vector<Real> thickness(mesh.vertex_count(), unbounded);
  const std::size_t thin = 0;
  thickness[thin] = 0.05;
  const std::vector<Real> size = sizing_field(mesh, thickness, options);
  EXPECT_DOUBLE_EQ(size[thin], 0.1);
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      EXPECT_LE(std::abs(size[a] - size[b]), 0.4 * distance(mesh.vertices[a], mesh.vertices[b]) * (1 + 1e-12));
    }
  for (std::size_t v = 0; v < size.size(); ++v) {
    // The way along edges is at least the straight distance.
    EXPECT_GE(size[v], std::min(0.2, 0.1 + 0.4 * distance(mesh.vertices[v], mesh.vertices[thin])) * (1 - 1e-12));
    EXPECT_LE(size[v], 0.2);
  }
  thickness[thin] = 1e-9;
  EXPECT_DOUBLE_EQ(sizing_field(mesh, thickness, options)[thin], 0.02);  // finest * edge_length
}

// Edges come out between 0.8 and 1.33 of the target, so the number of triangles between 1 / 1.33^2 and 1 / 0.8^2 of the
// expected one.
TEST(Sizing, RemeshingMakesAboutAsManyTrianglesAsExpected) {
  const SurfaceMesh in = make_sphere(0.5, 0.05);
  for (const Real edge : {0.15, 0.1, 0.04}) {
    const std::vector<Real> size(in.vertex_count(), edge);
    SurfaceMesh out;
    ASSERT_EQ(remesh(in, {.edge_length = edge}, out).status, RemeshStatus::kOk);
    const Real share = static_cast<Real>(out.triangle_count()) / expected_triangles(in, size);
    EXPECT_GT(share, 1 / (1.34 * 1.34));
    EXPECT_LT(share, 1 / (0.8 * 0.8));
    const std::vector<std::uint8_t> locked(in.vertex_count(), 1);
    EXPECT_EQ(expected_triangles(in, size, locked), static_cast<Real>(in.triangle_count()));
  }
}

TEST(Sizing, HalvedEdgesAreShortAndThePolyhedronIsTheSame) {
  const SurfaceMesh in = make_box({1, 0.1, 0.3}, 1);
  const SurfaceMesh out = with_edges_halved(in, 0.07);
  EXPECT_TRUE(valid(out));
  for (std::size_t t = 0; t < out.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) EXPECT_LE(distance(out.corner(t, k), out.corner(t, (k + 1) % 3)), 0.07);
  // Midpoints are rounded: some 1e-16 each.
  EXPECT_NEAR(signed_volume(out), signed_volume(in), 1e-14);
  EXPECT_NEAR(surface_area(out), surface_area(in), 1e-13);
  EXPECT_EQ(with_edges_halved(in, 5), in);
}

TEST(Sizing, ThinPartsGetFineElementsAndThickOnesDoNot) {
  const SurfaceMesh in = stepped_bar(0.05, 0.1);
  SurfaceMesh out;
  const RemeshReport report = remesh_graded(in, {.edge_length = 0.3, .edge_per_thickness = 1.5, .merge = 0.4}, out);
  ASSERT_EQ(report.status, RemeshStatus::kOk) << report.reason;
  EXPECT_TRUE(valid(out));
  EXPECT_NEAR(report.volume_change, 0, 1e-12);  // flat faces and straight edges; nothing to merge across
  EXPECT_GT(report.min_angle, 15);
  const std::vector<Real> edge = local_edge_length(out);
  Real thin = 0, thick = 0;
  int thin_count = 0, thick_count = 0;
  for (std::size_t t = 0; t < out.triangle_count(); ++t) {
    const Real x = out.centroid(t).x;
    if (std::abs(normalized(out.area_normal2(t)).y) < 0.5) continue;
    if (x > 0.4) thin += edge[t], ++thin_count;
    if (x < -0.6) thick += edge[t], ++thick_count;
  }
  // Edges come out between 0.8 and 4/3 of the target, and equilateral triangles of them have about the target's area.
  EXPECT_NEAR(thin / thin_count, 1.5 * 0.05, 0.2 * 1.5 * 0.05);
  EXPECT_GT(thick / thick_count, 2 * thin / thin_count);
  EXPECT_LT(resolution_report(out).worst, 1.5 * 4.0 / 3);
}

TEST(Sizing, TheRemedyOfTheWarningRemovesTheWarning) {
  const SurfaceMesh in = make_dinner_plate(0.12, 0.004, 0.004);
  SurfaceMesh coarse, graded;
  ASSERT_EQ(remesh_graded(in, {.edge_length = 0.025}, coarse).status, RemeshStatus::kOk);
  ASSERT_FALSE(resolution_warnings(resolution_report(coarse)).empty());
  ASSERT_EQ(remesh_graded(in, {.edge_length = 0.025, .edge_per_thickness = 2}, graded).status, RemeshStatus::kOk);
  EXPECT_TRUE(resolution_warnings(resolution_report(graded)).empty());
}

TEST(Sizing, AFewTrianglesAreEnoughToMeasureAndGrade) {
  const SurfaceMesh in = make_box({1, 0.04, 1}, 1);  // twelve triangles, whose vertices are all corners
  SurfaceMesh out;
  const RemeshReport report = remesh_graded(in, {.edge_length = 0.25, .edge_per_thickness = 3}, out);
  ASSERT_EQ(report.status, RemeshStatus::kOk) << report.reason;
  EXPECT_TRUE(valid(out));
  EXPECT_NEAR(signed_volume(out), 0.04, 1e-14);
  EXPECT_LT(resolution_report(out).worst, 3 * 4.0 / 3);
}

TEST(Sizing, OffOrWithoutThinWallsItIsRemeshingToOneLength) {
  const SurfaceMesh sphere = make_sphere(1, 0.15);
  SurfaceMesh plain, off, solid;
  remesh(sphere, {.edge_length = 0.2}, plain);
  remesh_graded(sphere, {.edge_length = 0.2}, off);
  EXPECT_EQ(off, plain);
  remesh_graded(sphere, {.edge_length = 0.2, .edge_per_thickness = 2}, solid);
  EXPECT_EQ(solid, plain);
}

TEST(Sizing, IsTheSameEveryTimeAndForAnyThreadCount) {
  const SurfaceMesh in = make_goblet(0.18, 0.04, 0.003, 0.006);
  const SizingOptions options{.edge_length = 0.02, .edge_per_thickness = 3};
  SurfaceMesh once, again;
  ASSERT_EQ(remesh_graded(in, options, once).status, RemeshStatus::kOk);
  const ThreadLimit one(1);
  remesh_graded(in, options, again);
  EXPECT_EQ(once, again);
}

TEST(Sizing, GradedRegionsThatAreGoodAreLocked) {
  const SurfaceMesh in = stepped_bar(0.05, 0.1);
  const SizingOptions options{.edge_length = 0.3, .edge_per_thickness = 1.5};
  SurfaceMesh out;
  ASSERT_EQ(remesh_graded(in, options, out).status, RemeshStatus::kOk);
  const std::vector<Real> size = sizing_field(out, wall_thickness(out).vertex, options);
  const auto count = [](const std::vector<std::uint8_t>& flags) {
    return static_cast<Real>(std::count(flags.begin(), flags.end(), 1)) / static_cast<Real>(flags.size());
  };
  // A few edges near the steps are off their target by more than 1.6; to one length nearly all are.
  EXPECT_GT(count(lock_good_regions(out, size, 0)), 0.6);
  EXPECT_LT(count(lock_good_regions(out, 0.3, 0)), 0.2);
}

TEST(Sizing, BadOptionsThrow) {
  const SurfaceMesh mesh = make_box({1, 1, 1}, 0.5);
  SurfaceMesh out;
  EXPECT_THROW(remesh_graded(mesh, {.edge_length = 0}, out), InputError);
  EXPECT_THROW(remesh_graded(mesh, {.edge_length = 1, .edge_per_thickness = -1}, out), InputError);
  EXPECT_THROW(remesh_graded(mesh, {.edge_length = 1, .edge_per_thickness = 1, .growth = 0}, out), InputError);
  EXPECT_THROW(remesh_graded(mesh, {.edge_length = 1, .edge_per_thickness = 1, .finest = 2}, out), InputError);
  EXPECT_THROW(remesh(mesh, {.edge_length = 1, .size = {1, 2}}, out), InputError);
  EXPECT_THROW(remesh(mesh, {.edge_length = 1, .size = std::vector<Real>(mesh.vertex_count(), 0)}, out), InputError);
}

}  // namespace
}  // namespace sherd
