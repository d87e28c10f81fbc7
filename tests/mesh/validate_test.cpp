#include "engine/mesh/validate.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/mesh/load.h"
#include "engine/mesh/shapes.h"
#include "tests/mesh/mesh_edits.h"

namespace sherd {
namespace {

void drop_triangle(SurfaceMesh& mesh, std::size_t t) {
  mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(t));
  mesh.faces = {};
  mesh.faces.resize(mesh.triangles.size());
}

TEST(Validate, AMissingTriangleIsOneBorderLoopOfThreeEdges) {
  SurfaceMesh mesh = make_sphere(1, 0.5);
  drop_triangle(mesh, 5);
  const MeshReport r = report_mesh(mesh);
  EXPECT_EQ(r.border_edges, 3u);
  EXPECT_EQ(r.border_loops, 1u);
  EXPECT_EQ(r.border_places.size(), 3u);
  EXPECT_EQ(r.nonmanifold_vertices, 0u);
  EXPECT_EQ(r.genus, -1);
  EXPECT_FALSE(is_valid(r));
}

TEST(Validate, AFlippedTriangleMisorientsItsThreeEdges) {
  SurfaceMesh mesh = make_sphere(1, 0.5);
  std::swap(mesh.triangles[7][0], mesh.triangles[7][1]);
  const MeshReport r = report_mesh(mesh);
  EXPECT_EQ(r.misoriented_edges, 3u);
  EXPECT_EQ(r.components, 1u);
  EXPECT_FALSE(is_valid(r));
}

TEST(Validate, AVertexOfTwoFansIsNotManifold) {
  SurfaceMesh mesh = joined(make_box({1, 1, 1}, 1), make_box({1, 1, 1}, 1), {1, 1, 1});
  const std::uint32_t first = [&] {
    for (std::uint32_t i = 0; i < 8; ++i)
      if (mesh.vertices[i] == Vec3{0.5, 0.5, 0.5}) return i;
    return kNone;
  }();
  ASSERT_NE(first, kNone);
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t)
      if (v >= 8 && mesh.vertices[v] == Vec3{0.5, 0.5, 0.5}) v = first;
  const MeshReport r = report_mesh(mesh);
  EXPECT_EQ(r.nonmanifold_vertices, 1u);
  ASSERT_EQ(r.nonmanifold_vertex_places.size(), 1u);
  EXPECT_EQ(r.nonmanifold_vertex_places[0], (Vec3{0.5, 0.5, 0.5}));
  EXPECT_EQ(r.nonmanifold_edges, 0u);
  EXPECT_EQ(r.border_edges, 0u);
  EXPECT_EQ(r.unused_vertices, 1u);
  EXPECT_FALSE(is_valid(r));
}

TEST(Validate, AFinOnAnEdgeMakesItNonManifold) {
  SurfaceMesh mesh = make_box({1, 1, 1}, 1);
  mesh.vertices.push_back({3, 0, 0});
  mesh.add_triangle(mesh.triangles[0][0], mesh.triangles[0][1], 8);
  const MeshReport r = report_mesh(mesh);
  EXPECT_EQ(r.nonmanifold_edges, 1u);
  EXPECT_EQ(r.border_edges, 2u);
}

TEST(Validate, ShellsMustAlternateWithDepth) {
  const SurfaceMesh outer = make_sphere(1, 0.4), inner = make_sphere(0.5, 0.3), core = make_sphere(0.2, 0.1);
  EXPECT_EQ(report_mesh(flipped(outer)).shells_inside_out, 1u);
  EXPECT_FALSE(is_valid(report_mesh(flipped(outer))));
  EXPECT_EQ(report_mesh(joined(outer, inner)).shells_inside_out, 1u);
  EXPECT_TRUE(is_valid(report_mesh(joined(outer, flipped(inner)))));
  EXPECT_TRUE(is_valid(report_mesh(joined(joined(outer, flipped(inner)), core))));
  EXPECT_FALSE(is_valid(report_mesh(joined(joined(outer, flipped(inner)), flipped(core)))));
  EXPECT_TRUE(is_valid(report_mesh(joined(outer, inner, {3, 0, 0}))));
  EXPECT_FALSE(is_valid(report_mesh(joined(outer, flipped(inner), {3, 0, 0}))));
}

TEST(Validate, TrianglesWithoutAreaAndNeedlesAreToldApart) {
  SurfaceMesh mesh;
  for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0.5, 0, 0}, Vec3{0.5, 5e-5, 0}, Vec3{0.5, 2e-4, 0}})
    mesh.vertices.push_back(p);
  mesh.add_triangle(0, 1, 2);  // collinear
  mesh.add_triangle(0, 1, 1);  // repeated vertex
  mesh.add_triangle(0, 1, 3);  // altitude 5e-5 of the longest edge
  mesh.add_triangle(0, 1, 4);  // 2e-4: thin but usable
  const MeshReport r = report_mesh(mesh);
  EXPECT_EQ(r.degenerate_triangles, 2u);
  EXPECT_EQ(r.needle_triangles, 1u);
}

TEST(Validate, BadNumbersAreCountedNotFollowed) {
  SurfaceMesh mesh = make_box({1, 1, 1}, 1);
  mesh.vertices.x[2] = std::numeric_limits<Real>::quiet_NaN();
  mesh.vertices.y[3] = std::numeric_limits<Real>::infinity();
  EXPECT_EQ(report_mesh(mesh).bad_coordinates, 2u);
  EXPECT_FALSE(is_valid(report_mesh(mesh)));
  mesh = make_box({1, 1, 1}, 1);
  mesh.triangles[4][1] = 8;
  EXPECT_EQ(report_mesh(mesh).bad_indices, 1u);
  EXPECT_FALSE(is_valid(report_mesh(mesh)));
  EXPECT_FALSE(is_valid(report_mesh(SurfaceMesh{})));
}

TEST(Validate, OverlapCountsAsSelfIntersectionOnlyWhenAsked) {
  const SurfaceMesh mesh = joined(make_sphere(1, 0.5), make_sphere(1, 0.5), {1, 0.1, 0.2});
  EXPECT_EQ(report_mesh(mesh).self_intersections, -1);
  const MeshReport r = report_mesh(mesh, {.count_self_intersections = true});
  EXPECT_GT(r.self_intersections, 0);
  EXPECT_FALSE(r.self_intersection_places.empty());
  EXPECT_FALSE(is_valid(r));
  EXPECT_EQ(report_mesh(make_sphere(1, 0.5), {.count_self_intersections = true}).self_intersections, 0);
}

// Edges 3, 4, 5 and the face diagonals; the torus has genus 1, two of them 2.
TEST(Validate, MeasuresAndGenusAreThoseOfTheShape) {
  const MeshReport r = report_mesh(make_box({3, 4, 5}, 10));
  EXPECT_EQ(r.vertices, 8u);
  EXPECT_NEAR(r.volume, 60, 1e-12);
  EXPECT_NEAR(r.area, 94, 1e-12);
  EXPECT_EQ(r.min_edge, 3);
  EXPECT_NEAR(r.max_edge, std::sqrt(41.0), 1e-14);
  EXPECT_NEAR(r.min_angle, std::atan2(3.0, 5.0) * 180 / 3.14159265358979323846, 1e-10);
  const SurfaceMesh torus = make_torus(1, 0.3, 0.2);
  EXPECT_EQ(report_mesh(joined(torus, torus, {0, 2, 0})).genus, 2);
}

TEST(Validate, TextAndJsonSayWhatIsWrong) {
  SurfaceMesh mesh = make_sphere(1, 0.5);
  EXPECT_NE(to_text(report_mesh(mesh)).find("valid: bounds a solid"), std::string::npos);
  drop_triangle(mesh, 5);
  const MeshReport r = report_mesh(mesh);
  EXPECT_NE(to_text(r).find("3 border edges (holes), first near ("), std::string::npos) << to_text(r);
  const nlohmann::json j = nlohmann::json::parse(to_json(r));
  EXPECT_EQ(j["valid"], false);
  EXPECT_EQ(j["border_edges"], 3);
  EXPECT_EQ(j["places"]["border_edges"].size(), 3u);
  mesh.vertices.x[0] = std::numeric_limits<Real>::quiet_NaN();
  EXPECT_TRUE(nlohmann::json::accept(to_json(report_mesh(mesh))));
}

// The counts another program (CGAL, numpy) found, in the shared folder's manifest.
TEST(Validate, AgreesWithTheManifestOfTheSharedMeshes) {
  const std::string folder = std::string(SHERD_SHARED) + "/meshes/broken/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no shared meshes";
  const struct {
    const char* file;
    std::size_t triangles, border, nonmanifold_edges, nonmanifold_vertices, misoriented;
  } rows[] = {{"bunny_open.ply", 69451, 223, 0, 0, 0},    {"teapot_open_selfint.ply", 6320, 160, 0, 1, 0},
              {"cow_selfint.ply", 5804, 0, 0, 1, 0},      {"beast_nonmanifold.ply", 64618, 0, 2, 0, 0},
              {"moebius.ply", 448, 112, 0, 0, 4},         {"sphere_flipped.ply", 1280, 0, 0, 0, 276},
              {"cubes_sharing_edge.ply", 216, 0, 3, 0, 0}};
  for (const auto& row : rows) {
    LoadLog log;
    const MeshReport r = report_mesh(load_mesh(folder + row.file, {}, log));
    EXPECT_EQ(r.triangles, row.triangles) << row.file;
    EXPECT_EQ(r.border_edges, row.border) << row.file;
    EXPECT_EQ(r.nonmanifold_edges, row.nonmanifold_edges) << row.file;
    EXPECT_EQ(r.nonmanifold_vertices, row.nonmanifold_vertices) << row.file;
    EXPECT_EQ(r.misoriented_edges, row.misoriented) << row.file;
    EXPECT_FALSE(is_valid(r)) << row.file;
  }
}

}  // namespace
}  // namespace sherd
