#include "engine/mesh/repair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <ostream>

#include "engine/mesh/load.h"
#include "engine/mesh/repair_loop.h"
#include "engine/mesh/shapes.h"
#include "engine/mesh/validate.h"
#include "kernels/core/error.h"
#include "kernels/core/random.h"
#include "tests/mesh/mesh_edits.h"

namespace sherd {
namespace {

// Leaves out the triangles whose centroid satisfies `in`.
template <class F>
SurfaceMesh without(const SurfaceMesh& mesh, const F& in) {
  SurfaceMesh out;
  out.vertices = mesh.vertices;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    if (!in(mesh.centroid(t))) out.add_triangle(mesh.triangles[t][0], mesh.triangles[t][1], mesh.triangles[t][2]);
  return out;
}

std::vector<std::string> repair(SurfaceMesh& mesh, Real max_hole = 0) {
  std::vector<std::string> messages;
  repair_mesh(mesh, {.name = "test.ply", .max_hole_diameter = max_hole}, messages);
  const MeshReport r = report_mesh(mesh, {.count_self_intersections = true});
  EXPECT_TRUE(is_valid(r)) << to_text(r);
  EXPECT_EQ(mesh.faces.kind.size(), mesh.triangle_count());
  EXPECT_EQ(mesh.faces.source.size(), mesh.triangle_count());
  return messages;
}

void expect_refused(SurfaceMesh mesh, const std::string& part, Real max_hole = 0) {
  std::vector<std::string> messages;
  try {
    repair_mesh(mesh, {.name = "test.ply", .max_hole_diameter = max_hole}, messages);
    ADD_FAILURE() << "accepted; expected: " << part;
  } catch (const InputError& e) {
    EXPECT_EQ(std::string(e.what()).find("test.ply: "), 0u) << e.what();
    EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
  }
}

TEST(Repair, AValidMeshStaysTheSame) {
  for (const SurfaceMesh& mesh :
       {make_sphere(1, 0.3), make_hollow_sphere(1, 0.5, 0.3), make_goblet(0.2, 0.04, 0.0015, 0.01)}) {
    SurfaceMesh copy = mesh;
    EXPECT_TRUE(repair(copy).empty());
    EXPECT_EQ(copy, mesh);
  }
}

TEST(Repair, TurnedTrianglesComeBack) {
  const SurfaceMesh sphere = make_sphere(1, 0.3);
  SurfaceMesh mesh = sphere;
  Random random(7);
  std::size_t turned = 0;
  for (Triangle& t : mesh.triangles)
    if (random.uniform() < 0.3) std::swap(t[1], t[2]), ++turned;
  const auto messages = repair(mesh);
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0], "turned " + std::to_string(turned) + " triangles to agree with their neighbours");
  EXPECT_EQ(signed_volume(mesh), signed_volume(sphere));
}

// Sums of about a thousand terms of size 1 in two orders: 1e-13.
TEST(Repair, InsideOutShellsAreTurnedAndCavitiesKept) {
  SurfaceMesh mesh = flipped(make_sphere(1, 0.3));
  EXPECT_EQ(repair(mesh), (std::vector<std::string>{"turned 1 shell that was inside out"}));
  const SurfaceMesh hollow = make_hollow_sphere(1, 0.5, 0.3);
  mesh = flipped(hollow);
  EXPECT_EQ(repair(mesh), (std::vector<std::string>{"turned 2 shells that were inside out"}));
  EXPECT_NEAR(signed_volume(mesh), signed_volume(hollow), 1e-12);
  mesh = joined(make_sphere(1, 0.3), make_sphere(0.5, 0.3));
  repair(mesh);
  EXPECT_NEAR(signed_volume(mesh), signed_volume(make_sphere(1, 0.3)) - signed_volume(make_sphere(0.5, 0.3)), 1e-12);
}

// A spherical cap of half angle acos(0.9) is missing: closing it flat loses its volume pi h^2 (3 - h) / 3 of h = 0.1,
// about, and never more than twice that (the border is a zigzag one triangle deep).
TEST(Repair, HolesUpToTheLimitAreClosed) {
  const SurfaceMesh sphere = make_sphere(1, 0.1);
  SurfaceMesh mesh = without(sphere, [](const Vec3& c) { return c.y > 0.9; });
  expect_refused(mesh, "not closed: 1 hole with");
  expect_refused(mesh, "exceed the limit of 0.5 m", 0.5);
  const auto messages = repair(mesh, 1.0);
  const bool told =
      std::any_of(messages.begin(), messages.end(), [](const std::string& m) { return m.find("closed 1 hole") == 0; });
  EXPECT_TRUE(told);
  const Real cap = 3.14159 * 0.01 * 2.9 / 3;
  EXPECT_NEAR(signed_volume(mesh), signed_volume(sphere) - cap, cap);
  EXPECT_LT(signed_volume(mesh), signed_volume(sphere));
}

TEST(Repair, EveryMissingTriangleIsRestored) {
  const SurfaceMesh sphere = make_sphere(1, 0.1);
  SurfaceMesh mesh = sphere;
  for (const std::size_t t : {std::size_t{900}, std::size_t{500}, std::size_t{3}})
    mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(t));
  mesh.faces = {};
  repair(mesh);
  EXPECT_EQ(mesh.triangle_count(), sphere.triangle_count());
  EXPECT_NEAR(signed_volume(mesh), signed_volume(sphere), 1e-12);
}

TEST(Repair, TouchingConesGetTheirOwnTips) {
  // Two boxes that share one corner vertex.
  SurfaceMesh mesh = joined(make_box({1, 1, 1}, 0.5), make_box({1, 1, 1}, 0.5), {1, 1, 1});
  std::uint32_t first = kNone;
  for (std::uint32_t i = 0; i < mesh.vertex_count(); ++i)
    if (mesh.vertices[i] == Vec3{0.5, 0.5, 0.5}) {
      if (first == kNone) first = i;
      for (Triangle& t : mesh.triangles) std::replace(t.begin(), t.end(), i, first);
    }
  ASSERT_EQ(report_mesh(mesh).nonmanifold_vertices, 1u);
  const auto messages = repair(mesh);
  EXPECT_EQ(report_mesh(mesh).components, 2u);
  // One tip moves by a thousandth of half a cell's size: volume changes by less than that times the corner's area.
  EXPECT_NEAR(signed_volume(mesh), 2.0, 1e-3);
  EXPECT_NE(messages[1].find("split 1 vertex"), std::string::npos) << messages[1];
}

TEST(Repair, TrianglesWithoutAreaAreRemoved) {
  // A point in the middle of an edge of the box, on one side only: bridged by a triangle without area.
  SurfaceMesh mesh = make_box({1, 1, 1}, 1);
  const Triangle f = mesh.triangles[0];
  const auto m = static_cast<std::uint32_t>(mesh.vertex_count());
  mesh.vertices.push_back(0.5 * (mesh.vertices[f[0]] + mesh.vertices[f[1]]));
  mesh.triangles[0] = {f[0], m, f[2]};
  mesh.add_triangle(m, f[1], f[2]);
  mesh.add_triangle(f[0], f[1], m);
  ASSERT_EQ(report_mesh(mesh).degenerate_triangles, 1u);
  repair(mesh);
  EXPECT_NEAR(signed_volume(mesh), 1.0, 1e-12);

  // Two vertices at one place: a collapsed edge.
  mesh = make_sphere(1, 0.3);
  mesh.vertices.set(mesh.triangles[50][1], mesh.vertices[mesh.triangles[50][0]]);
  ASSERT_EQ(report_mesh(mesh).degenerate_triangles, 2u);
  const std::size_t before = mesh.triangle_count();
  repair(mesh);
  EXPECT_EQ(mesh.triangle_count(), before - 2);
}

TEST(Repair, UnusedVerticesGoAndSmallPiecesStay) {
  SurfaceMesh mesh = joined(make_sphere(1, 0.3), make_sphere(0.001, 0.001), {3, 0, 0});
  mesh.vertices.push_back({9, 9, 9});
  const auto messages = repair(mesh);
  ASSERT_EQ(messages.size(), 2u);
  EXPECT_EQ(messages[0], "dropped 1 vertex in no triangle");
  EXPECT_EQ(messages[1].find("kept 1 separate piece"), 0u) << messages[1];
  EXPECT_EQ(report_mesh(mesh).components, 2u);
}

TEST(Repair, WhatCannotBeRepairedIsRefusedWithCountsAndPlaces) {
  expect_refused(joined(make_sphere(1, 0.3), make_sphere(1, 0.3), {1, 0.1, 0.05}),
                 "pairs of triangles intersect, first near (");
  expect_refused(SurfaceMesh{}, "no triangles");
  SurfaceMesh mesh = make_sphere(1, 0.3);
  mesh.vertices.push_back({0, 0, 3});
  mesh.add_triangle(mesh.triangles[0][0], mesh.triangles[0][1], static_cast<std::uint32_t>(mesh.vertex_count() - 1));
  expect_refused(mesh, "1 edge is shared by more than two triangles, first near (");
  mesh = make_sphere(1, 0.3);
  mesh.vertices.z[4] = std::nan("");
  expect_refused(mesh, "not finite");
  mesh = make_sphere(1, 0.3);
  mesh.triangles[3][2] = 99999;
  expect_refused(mesh, "triangle 3 uses vertex 99999 of");
  // A Moebius strip of 12 quads.
  mesh = {};
  for (int i = 0; i < 12; ++i)
    for (const Real s : {-0.2, 0.2}) {
      const Real a = 2 * 3.14159265358979323846 * i / 12, r = 1 + s * std::cos(0.5 * a);
      mesh.vertices.push_back({r * std::cos(a), s * std::sin(0.5 * a), r * std::sin(a)});
    }
  for (std::uint32_t i = 0; i < 12; ++i) {
    const std::uint32_t a = 2 * i, b = a + 1, c = i == 11 ? 1 : a + 2, d = i == 11 ? 0 : a + 3;
    mesh.add_triangle(a, b, d), mesh.add_triangle(a, d, c);
  }
  expect_refused(mesh, "only one side");
}

TEST(RepairLoop, TriangulatesPlanarPolygonsExactly) {
  // A comb of 10 teeth, concave: its area is the sum of the triangles' signed areas and of their absolute ones.
  std::vector<Vec3> loop;
  for (int i = 0; i < 10; ++i) loop.push_back({i + 0.0, 0, 0}), loop.push_back({i + 0.5, -5, 0});
  loop.push_back({10, 0, 0}), loop.push_back({10, 1, 0}), loop.push_back({0, 1, 0});
  const auto area2 = [&](const Triangle& t) { return cross(loop[t[1]] - loop[t[0]], loop[t[2]] - loop[t[0]]).z; };
  const std::vector<Triangle> triangles = triangulate_loop(loop);
  EXPECT_EQ(triangles.size(), loop.size() - 2);
  Real total = 0, absolute = 0;
  for (const Triangle& t : triangles) total += 0.5 * area2(t), absolute += 0.5 * std::abs(area2(t));
  EXPECT_NEAR(total, 10 + 10 * 0.5 * 5, 1e-12);
  EXPECT_NEAR(absolute, total, 1e-12);
  EXPECT_TRUE(triangulate_loop({{0, 0, 0}, {1, 0, 0}}).empty());
}

// Longer than the exact method takes: the circle's polygon is still covered once.
TEST(RepairLoop, LongLoopsAreCovered) {
  std::vector<Vec3> loop;
  const int n = 1000;
  for (int i = 0; i < n; ++i) {
    const Real a = 2 * 3.14159265358979323846 * i / n;
    loop.push_back({std::cos(a), std::sin(a), 0});
  }
  const std::vector<Triangle> triangles = triangulate_loop(loop);
  EXPECT_EQ(triangles.size(), 998u);
  Real area = 0;
  for (const Triangle& t : triangles) area += 0.5 * norm(cross(loop[t[1]] - loop[t[0]], loop[t[2]] - loop[t[0]]));
  EXPECT_NEAR(area, 0.5 * n * std::sin(2 * 3.14159265358979323846 / n), 1e-9);
}

struct SharedCase {
  const char* file;
  Real max_hole;
  const char* refusal;  // part of the text, or null when the mesh must come out valid
};
// Names the case in test lists; the default prints the struct's bytes, which hold addresses.
void PrintTo(const SharedCase& c, std::ostream* out) {
  *out << c.file;
}
class RepairShared : public ::testing::TestWithParam<SharedCase> {};

TEST_P(RepairShared, ComesOutValidOrIsRefusedClearly) {
  const std::string file = std::string(SHERD_SHARED) + "/meshes/" + GetParam().file;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no shared meshes";
  LoadLog log;
  SurfaceMesh mesh = load_mesh(file, {}, log);
  if (GetParam().refusal != nullptr)
    expect_refused(mesh, GetParam().refusal, GetParam().max_hole);
  else
    repair(mesh, GetParam().max_hole);
}

INSTANTIATE_TEST_SUITE_P(
    Meshes, RepairShared,
    ::testing::Values(SharedCase{"broken/beast_nonmanifold.ply", 0, "2 edges are shared by more than two triangles"},
                      SharedCase{"broken/bunny_open.ply", 0, "not closed: 4 holes"},
                      SharedCase{"broken/bunny_open.ply", 0.2, nullptr},
                      SharedCase{"broken/cow_selfint.ply", 0, "pairs of triangles intersect"},
                      SharedCase{"broken/cubes_sharing_edge.ply", 0, "3 edges are shared"},
                      SharedCase{"broken/moebius.ply", 0, "only one side"},
                      SharedCase{"broken/shell_coincident.ply", 0, "at least 1000 pairs of triangles intersect"},
                      SharedCase{"broken/sphere_flipped.ply", 0, nullptr},
                      SharedCase{"broken/sphere_insideout.ply", 0, nullptr},
                      SharedCase{"broken/sphere_zero_area_cap.ply", 0, nullptr},
                      SharedCase{"broken/stl112932_degenerate.ply", 0, nullptr},
                      SharedCase{"broken/teapot_open_selfint.ply", 0, "not closed: 5 holes"},
                      SharedCase{"broken/two_spheres_overlap.ply", 0, "162 pairs of triangles intersect"},
                      SharedCase{"dev/bunny_5k.ply", 0, nullptr}, SharedCase{"dev/bunny_20k.ply", 0, nullptr},
                      SharedCase{"dev/rocker_5k.ply", 0, nullptr}, SharedCase{"dev/rocker_20k.ply", 0, nullptr},
                      SharedCase{"dev/nefertiti_20k.ply", 0, nullptr}, SharedCase{"dev/nefertiti_100k.ply", 0, nullptr},
                      SharedCase{"dev/cheburashka_13k.ply", 0, nullptr}, SharedCase{"dev/multi4_72k.ply", 0, nullptr},
                      SharedCase{"dev/teapot_wrap_20k.ply", 0, nullptr}),
    [](const auto& instance) {
      std::string name = std::string(instance.param.file) + (instance.param.max_hole > 0 ? "_closing_holes" : "");
      for (char& c : name)
        if (c == '/' || c == '.') c = '_';
      return name;
    });

}  // namespace
}  // namespace sherd
