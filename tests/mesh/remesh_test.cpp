#include "engine/mesh/remesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "engine/mesh/intersections.h"
#include "engine/mesh/remesh_mesh.h"
#include "engine/mesh/shapes.h"
#include "engine/mesh/validate.h"
#include "kernels/core/error.h"
#include "kernels/core/parallel.h"
#include "kernels/core/random.h"
#include "remesh_shared.h"

namespace sherd {
namespace {

bool valid(const SurfaceMesh& mesh) {
  return is_valid(report_mesh(mesh, {.count_self_intersections = true}));
}

// The result after checking what every remeshing must give.
SurfaceMesh remeshed(const SurfaceMesh& in, const RemeshOptions& options, RemeshReport* report_out = nullptr) {
  SurfaceMesh out;
  const RemeshReport report = remesh(in, options, out);
  EXPECT_EQ(report.status, RemeshStatus::kOk) << report.reason;
  EXPECT_TRUE(valid(out));
  EXPECT_NEAR(report.volume_change, signed_volume(out) / signed_volume(in) - 1, 1e-12);
  EXPECT_NEAR(report.min_angle, report_mesh(out).min_angle, 1e-6);
  EXPECT_NEAR(report.input_min_angle, report_mesh(in).min_angle, 1e-6);
  if (report_out) *report_out = report;
  return out;
}

// Total length of edges whose normals differ by more than 40 degrees.
Real crease_length(const SurfaceMesh& mesh) {
  const std::vector<std::uint32_t> twin = build_twins(mesh);
  Real sum = 0;
  for (std::uint32_t h = 0; h < twin.size(); ++h) {
    const Vec3 a = normalized(mesh.area_normal2(h / 3)), b = normalized(mesh.area_normal2(twin[h] / 3));
    if (h < twin[h] && dot(a, b) < std::cos(40 * std::numbers::pi / 180))
      sum += distance(mesh.corner(h / 3, static_cast<int>(h % 3)), mesh.corner(h / 3, static_cast<int>((h + 1) % 3)));
  }
  return sum;
}

// Splits random edges very near one end: the slivers of an exact cut.
SurfaceMesh with_slivers(const SurfaceMesh& mesh, int count, Real fraction) {
  EditMesh edit;
  const char* reason = nullptr;
  EXPECT_TRUE(edit.assign(mesh, reason));
  Random random(9);
  for (int i = 0; i < count; ++i) {
    const auto h = static_cast<std::uint32_t>(random.uniform() * static_cast<Real>(edit.twin.size()));
    const Vec3 a = edit.position[edit.from(h)], b = edit.position[edit.to(h)];
    if (distance(a, b) < 0.01) continue;
    edit.split(h, a + (b - a) * fraction);
  }
  return edit.extract();
}

TEST(Remesh, CubeKeepsItsEdgesAndItsVolumeExactly) {
  const SurfaceMesh in = make_box({1, 1, 1}, 0.2);
  for (const Real h : {0.07, 0.2, 0.35}) {
    RemeshReport report;
    const SurfaceMesh out = remeshed(in, {.edge_length = h}, &report);
    // Vertices move in flat faces and along straight edges: only rounding, some 1e-16 a vertex.
    EXPECT_NEAR(signed_volume(out), 1, 1e-12);
    EXPECT_NEAR(surface_area(out), 6, 1e-12);
    EXPECT_NEAR(crease_length(out), 12, 1e-12);
    EXPECT_LT(report.max_deviation, 1e-12);
    EXPECT_GT(report.min_angle, 15);
    EXPECT_NEAR(mean_edge_length(out) / h, 1, 0.25);
  }
}

TEST(Remesh, SphereStaysRoundAndIsotropicFinerAndCoarser) {
  const SurfaceMesh in = make_sphere(1, 0.1);
  for (const Real h : {0.06, 0.1, 0.25}) {
    RemeshReport report;
    const SurfaceMesh out = remeshed(in, {.edge_length = h}, &report);
    EXPECT_GT(report.min_angle, 20);
    EXPECT_EQ(report.below_15, 0u);
    EXPECT_LT(report.max_deviation, 1e-9);  // vertices lie on the input
    // Edges are 4/3 h at most. Such a facet lies at most (4/3 h)^2 / 6 below the unit sphere (circumradius^2 / 2), and
    // a sphere loses three times its mean depth in volume, which is no more than half the largest.
    EXPECT_LT(std::abs(report.volume_change), 1.5 * std::pow(4.0 / 3 * h, 2) / 6);
    EXPECT_NEAR(mean_edge_length(out) / h, 1, 0.2);
  }
}

TEST(Remesh, ThinPlateNeverLosesItsThickness) {
  // Thickness a 20th of h: the sheets are far closer to each other than vertices to their neighbours.
  const SurfaceMesh in = make_plate(1, 1, 0.01, 0.1);
  RemeshReport report;
  const SurfaceMesh out = remeshed(in, {.edge_length = 0.2}, &report);
  EXPECT_LT(out.triangle_count(), in.triangle_count());
  EXPECT_NEAR(signed_volume(out), 0.01, 1e-14);
  EXPECT_NEAR(crease_length(out), 8 + 4 * 0.01, 1e-12);
}

TEST(Remesh, CurvedThinShellKeepsBothSheets) {
  const SurfaceMesh in = make_hollow_sphere(1, 0.97, 0.08);
  RemeshReport report;
  const SurfaceMesh out = remeshed(in, {.edge_length = 0.16}, &report);
  std::vector<std::uint32_t> label;
  EXPECT_EQ(label_components(out, label), 2u);
  EXPECT_LT(std::abs(report.volume_change),
            0.1);  // each sheet may sink by (4/3 h)^2 / 6 = 0.0076 of a 0.03 wall at most
}

TEST(Remesh, DinnerPlateKeepsItsRim) {
  const SurfaceMesh in = make_dinner_plate(1, 0.04, 0.05);
  RemeshReport report;
  const SurfaceMesh out = remeshed(in, {.edge_length = 0.08}, &report);
  const Box a = bounding_box(in), b = bounding_box(out);
  // A rim vertex can be missed by the sagitta of an edge of 4/3 h on the unit circle at most.
  const Real sagitta = std::pow(4.0 / 3 * 0.08, 2) / 8;
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(a.low[k], b.low[k], k == 1 ? 0.2 * 0.04 : 2 * sagitta);
    EXPECT_NEAR(a.high[k], b.high[k], k == 1 ? 0.2 * 0.04 : 2 * sagitta);
  }
  EXPECT_LT(std::abs(report.volume_change), 5e-3);
  EXPECT_GT(report.min_angle, 10);
}

TEST(Remesh, SliversOfACutDisappear) {
  const SurfaceMesh in = with_slivers(make_box({1, 1, 1}, 0.25), 200, 0x1p-12);
  // Powers of two keep the split points exactly on their edges, so the input does not intersect itself.
  ASSERT_LT(report_mesh(in).min_angle, 0.02);
  ASSERT_TRUE(valid(in));
  RemeshReport report;
  const SurfaceMesh out = remeshed(in, {.edge_length = 0.2}, &report);
  EXPECT_EQ(report.below_15, 0u);
  // Slivers at the cube's edges may be merged off them by their own width w = 0.25 * 2^-12: w h^2 / 3 each at most.
  EXPECT_NEAR(signed_volume(out), 1, 200 * 0x1p-14 * 0.25 * 0.25 / 3);
}

TEST(Remesh, DoingItAgainChangesLittle) {
  const SurfaceMesh in = make_torus(1, 0.4, 0.06);
  const SurfaceMesh once = remeshed(in, {.edge_length = 0.12});
  RemeshReport report;
  const SurfaceMesh twice = remeshed(once, {.edge_length = 0.12}, &report);
  const auto n = static_cast<Real>(once.triangle_count());
  EXPECT_NEAR(static_cast<Real>(twice.triangle_count()), n, 0.05 * n);
  EXPECT_LT(static_cast<Real>(report.splits + report.collapses), 0.05 * n);
  EXPECT_GT(report.min_angle, 20);
}

TEST(Remesh, IsTheSameEveryTimeAndForAnyThreadCount) {
  const SurfaceMesh in = with_slivers(make_dinner_plate(1, 0.05, 0.1), 50, 1e-4);
  const SurfaceMesh once = remeshed(in, {.edge_length = 0.12});
  EXPECT_EQ(remeshed(in, {.edge_length = 0.12}), once);
  const ThreadLimit one(1);
  EXPECT_EQ(remeshed(in, {.edge_length = 0.12}), once);
}

TEST(Remesh, KindsCracksAndSourcesStayInTheirRegions) {
  SurfaceMesh in = make_sphere(1, 0.1);
  for (std::size_t t = 0; t < in.triangle_count(); ++t) {
    const bool crack = in.centroid(t).y > 0.3;
    in.faces.kind[t] = crack ? FaceKind::kCrack : FaceKind::kOriginal;
    in.faces.crack[t] = crack ? (in.centroid(t).x > 0 ? 7 : 4) : -1;
    in.faces.source[t] = crack ? -1 : static_cast<std::int32_t>(t);
  }
  const SurfaceMesh out = remeshed(in, {.edge_length = 0.14});
  std::array<Real, 3> before{}, after{};
  const auto region = [](const SurfaceMesh& m, std::size_t t) {
    return m.faces.kind[t] == FaceKind::kOriginal ? 0u : (m.faces.crack[t] == 7 ? 1u : 2u);
  };
  for (std::size_t t = 0; t < in.triangle_count(); ++t) before[region(in, t)] += norm(in.area_normal2(t));
  for (std::size_t t = 0; t < out.triangle_count(); ++t) {
    const std::size_t r = region(out, t);
    after[r] += norm(out.area_normal2(t));
    EXPECT_EQ(out.faces.crack[t], r == 0 ? -1 : (r == 1 ? 7 : 4));
    if (r != 0) {
      EXPECT_EQ(out.faces.source[t], -1);
      continue;
    }
    ASSERT_GE(out.faces.source[t], 0);
    const auto s = static_cast<std::size_t>(out.faces.source[t]);
    EXPECT_EQ(in.faces.kind[s], FaceKind::kOriginal);
    EXPECT_LT(distance(out.centroid(t), in.centroid(s)), 0.14);
  }
  // The borders are jagged lines of the input that the output follows within half an edge on either side, at random.
  for (std::size_t r = 0; r < 3; ++r) EXPECT_NEAR(after[r] / before[r], 1, 0.03);
}

TEST(Remesh, LockedVerticesAndTheFacesBetweenThemStay) {
  const SurfaceMesh in = make_sphere(1, 0.1);
  RemeshOptions options{.edge_length = 0.2};
  options.locked.resize(in.vertex_count());
  std::set<std::array<Real, 9>> kept;
  for (std::size_t v = 0; v < in.vertex_count(); ++v) options.locked[v] = in.vertices[v].x > 0;
  const auto key = [](const SurfaceMesh& m, std::size_t t) {
    std::array<std::array<Real, 3>, 3> c;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = m.corner(t, static_cast<int>(k));
      c[k] = {p.x, p.y, p.z};
    }
    std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
    return std::array<Real, 9>{c[0][0], c[0][1], c[0][2], c[1][0], c[1][1], c[1][2], c[2][0], c[2][1], c[2][2]};
  };
  const SurfaceMesh out = remeshed(in, options);
  EXPECT_LT(out.triangle_count(), in.triangle_count());
  for (std::size_t t = 0; t < out.triangle_count(); ++t) kept.insert(key(out, t));
  for (std::size_t t = 0; t < in.triangle_count(); ++t) {
    const Triangle& v = in.triangles[t];
    if (options.locked[v[0]] && options.locked[v[1]] && options.locked[v[2]]) {
      EXPECT_TRUE(kept.contains(key(in, t))) << t;
    }
  }
}

TEST(Remesh, GoodRegionsAreLockedAndPoorOnesAreNot) {
  const SurfaceMesh good = make_sphere(1, 0.2), in = with_slivers(good, 1, 1e-3);
  const std::vector<std::uint8_t> locked = lock_good_regions(in, 0.2, 0.5);
  const auto free_count = std::count(locked.begin(), locked.end(), 0);
  EXPECT_GT(free_count, 5);
  EXPECT_LT(free_count, 80);  // a disc of 0.5 + one edge around two faces: about pi 0.7^2 / (0.87 0.2^2) vertices
  const std::vector<std::uint8_t> all = lock_good_regions(good, 0.2, 0.5);
  EXPECT_EQ(std::count(all.begin(), all.end(), 0), 0);
  RemeshReport report;
  remeshed(in, {.edge_length = 0.2, .locked = locked}, &report);
  EXPECT_GT(report.min_angle, 15);
}

// A cube whose edges along z at x = 0.5 are cut off by chamfers of `width`.
SurfaceMesh chamfered_bar(Real width) {
  SurfaceMesh mesh = make_box({1, 1, 1}, 0.25);
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    Vec3 p = mesh.vertices[i];
    if (std::abs(p.y) > 0.49 && p.x > 0.49) p.x -= width;
    if (std::abs(p.y) < 0.49 && std::abs(p.y) > 0.2 && p.x > 0.49) p.y = std::copysign(0.5 - width, p.y);
    mesh.vertices.set(i, p);
  }
  return mesh;
}

TEST(Remesh, MergingFeaturesCloserThanTheTargetRemovesTheirSliversAndLittleElse) {
  const Real width = 0.03, h = 0.25;
  const SurfaceMesh in = chamfered_bar(width);
  ASSERT_TRUE(valid(in));
  RemeshReport kept, merged;
  remeshed(in, {.edge_length = h}, &kept);
  remeshed(in, {.edge_length = h, .merge = 0.4}, &merged);
  EXPECT_GT(kept.below_15, 10u);  // bands 0.17 h wide: angles of some ten degrees
  EXPECT_LT(merged.below_15, kept.below_15 / 2);
  EXPECT_GT(merged.min_angle, kept.min_angle);
  // Where a line moves onto the other one, `width` away, the row of faces behind it tilts: a wedge as wide as an edge
  // of up to 4/3 h and `width` high, at each of two chamfers of length 1.
  EXPECT_LT(std::abs(merged.volume_change), 2 * 0.5 * width * 4.0 / 3 * h);
}

TEST(Remesh, MergingNeverPinchesASheet) {
  const Real h = 0.2;
  for (const Real thickness : {0.3 * h, 0.05 * h}) {
    const SurfaceMesh in = make_plate(1, 1, thickness, 0.1);
    const SurfaceMesh out = remeshed(in, {.edge_length = h, .merge = 0.5});
    EXPECT_NEAR(signed_volume(out), thickness, 1e-13);
    EXPECT_NEAR(crease_length(out), 8 + 4 * thickness, 1e-12);
  }
}

TEST(Remesh, MergingChangesNothingWhereTheMeshIsGood) {
  const SurfaceMesh in = make_box({1, 1, 1}, 0.2);
  EXPECT_EQ(remeshed(in, {.edge_length = 0.2, .merge = 0.4}), remeshed(in, {.edge_length = 0.2}));
}

TEST(Remesh, OpenMeshIsRefusedAndBadOptionsThrow) {
  SurfaceMesh in = make_box({1, 1, 1}, 0.5), out;
  EXPECT_THROW(remesh(in, {.edge_length = 0}, out), InputError);
  EXPECT_THROW(remesh(in, {.edge_length = std::nan("")}, out), InputError);
  EXPECT_THROW(remesh(in, {.edge_length = 1, .feature_angle = -1}, out), InputError);
  EXPECT_THROW(remesh(in, {.edge_length = 1, .iterations = -1}, out), InputError);
  EXPECT_THROW(remesh(in, {.edge_length = 1, .merge = 0.6}, out), InputError);
  EXPECT_THROW(remesh(in, {.edge_length = 1, .pinch_below = -1}, out), InputError);
  EXPECT_THROW(remesh(in, {.edge_length = 1, .locked = {1, 0}}, out), InputError);
  in.triangles.pop_back();
  in.faces = {};
  in.faces.resize(in.triangle_count());
  const RemeshReport report = remesh(in, {.edge_length = 0.2}, out);
  EXPECT_EQ(report.status, RemeshStatus::kRefused);
  EXPECT_FALSE(report.reason.empty());
  EXPECT_EQ(out, in);
}

TEST(Remesh, ScannedModelBecomesIsotropic) {
  SurfaceMesh in;
  if (!test::read_shared_ply("dev/bunny_20k.ply", in)) GTEST_SKIP() << "dev/bunny_20k.ply is not here";
  RemeshReport report;
  const SurfaceMesh out = remeshed(in, {.edge_length = 0.022}, &report);
  EXPECT_GT(out.triangle_count(), 4000u);
  EXPECT_LT(out.triangle_count(), 7000u);
  EXPECT_GT(report.min_angle, 15);
  EXPECT_LT(std::abs(report.volume_change), 1e-2);
}

TEST(Remesh, MergingLeavesScansWithFewSlivers) {
  SurfaceMesh in;
  if (!test::read_shared_ply("dev/cheburashka_13k.ply", in)) GTEST_SKIP() << "dev/cheburashka_13k.ply is not here";
  RemeshReport kept, merged;
  remeshed(in, {.edge_length = 0.025}, &kept);
  remeshed(in, {.edge_length = 0.025, .merge = 0.4}, &merged);
  EXPECT_GT(merged.min_angle, 2 * kept.min_angle);
  EXPECT_LT(merged.below_15, kept.below_15);
  EXPECT_LT(merged.max_face_deviation, 0.4);
}

// New facets between points of a sphere's facets cut 5e-3 of its volume off at this edge; kept, what remains is what
// the last step of the correction leaves: its square, with a first step near 1e-3 of the radius.
TEST(Remesh, TheVolumeOfCurvedBodiesIsKeptWhenAskedFor) {
  for (const SurfaceMesh& in : {make_sphere(0.5, 0.07), make_torus(0.5, 0.2, 0.06)}) {
    RemeshOptions options;
    options.edge_length = 0.09;
    SurfaceMesh out;
    const RemeshReport plain = remesh(in, options, out);
    ASSERT_EQ(plain.status, RemeshStatus::kOk) << plain.reason;
    EXPECT_GT(std::abs(plain.volume_change), 1e-3);
    options.keep_volume = true;
    const RemeshReport kept = remesh(in, options, out);
    ASSERT_EQ(kept.status, RemeshStatus::kOk) << kept.reason;
    EXPECT_LT(std::abs(kept.volume_change), 1e-6);
    // The facets' own error: h^2 / (8 r) over h with the smaller radius, doubled for edges up to 4/3 h.
    EXPECT_LT(kept.max_deviation, 2 * 0.09 / (8 * 0.2));
  }
}

TEST(Remesh, KeepingTheVolumeLeavesFlatFacesFlat) {
  const SurfaceMesh in = make_box({1, 2, 3}, 0.3);
  RemeshOptions options;
  options.edge_length = 0.2, options.keep_volume = true;
  SurfaceMesh out;
  const RemeshReport report = remesh(in, options, out);
  ASSERT_EQ(report.status, RemeshStatus::kOk) << report.reason;
  EXPECT_LT(report.max_deviation, 1e-9);
}

}  // namespace
}  // namespace sherd
