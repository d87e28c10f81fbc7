#include "engine/mesh/remesh_part.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "engine/mesh/attributes.h"
#include "engine/mesh/certificate.h"
#include "engine/mesh/shapes.h"
#include "tests/mesh/mesh_edits.h"

namespace sherd {
namespace {

// Unlocked within `radius` of `centre`.
RemeshOptions unlocked_near(const SurfaceMesh& mesh, const Vec3& centre, Real radius, Real edge) {
  RemeshOptions options;
  options.edge_length = edge;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    options.locked.push_back(distance(mesh.vertices[v], centre) > radius ? 1 : 0);
  return options;
}

SurfaceMesh numbered(SurfaceMesh mesh) {
  mesh.channels = {{"number", 1, {}}};
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    mesh.faces.source[t] = static_cast<std::int32_t>(t);
    for (int k = 0; k < 3; ++k) mesh.channels[0].value.push_back(static_cast<float>(mesh.corner(t, k).y));
  }
  return mesh;
}

// Each face as its corners, its source and its values.
using Face = std::tuple<std::array<Real, 9>, std::int32_t, std::array<float, 3>>;
std::vector<Face> faces_of(const SurfaceMesh& mesh) {
  std::vector<Face> faces;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    Face f;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = mesh.corner(t, static_cast<int>(k));
      for (std::size_t i = 0; i < 3; ++i) std::get<0>(f)[3 * k + i] = p[static_cast<int>(i)];
      std::get<2>(f)[k] = mesh.channels[0].value[3 * t + k];
    }
    std::get<1>(f) = mesh.faces.source[t];
    faces.push_back(f);
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

TEST(RemeshPart, FacesBetweenLockedVerticesStayToTheBit) {
  const SurfaceMesh in = numbered(make_sphere(0.5, 0.05));
  const RemeshOptions options = unlocked_near(in, {0, 0.5, 0}, 0.15, 0.03);
  ASSERT_TRUE(cut_out_part(in, options).has_value());
  SurfaceMesh out;
  const RemeshReport report = remesh(in, options, out);
  ASSERT_EQ(report.status, RemeshStatus::kOk) << report.reason;
  EXPECT_GT(report.splits, 0u);
  const MeshCertificate c = certify(out);
  EXPECT_TRUE(c.ok()) << c.first_defect;
  EXPECT_EQ(c.genus, 0);
  SurfaceMesh kept = in;
  std::vector<bool> keep;
  for (const Triangle& t : in.triangles)
    keep.push_back(std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return options.locked[v] != 0; }));
  keep_faces(kept, keep);
  EXPECT_GT(kept.triangle_count(), in.triangle_count() / 2);
  const std::vector<Face> before = faces_of(kept), after = faces_of(out);
  EXPECT_TRUE(std::includes(after.begin(), after.end(), before.begin(), before.end()));
}

// What is far away plays no role: the same vertices come out with a second body beside.
TEST(RemeshPart, TheRestOfTheMeshPlaysNoRole) {
  const SurfaceMesh one = numbered(make_sphere(0.5, 0.05));
  SurfaceMesh two = numbered(joined(one, make_box({1, 1, 1}, 0.2), {3, 0, 0}));
  SurfaceMesh a, b;
  const Vec3 top{0, 0.5, 0};
  ASSERT_EQ(remesh(one, unlocked_near(one, top, 0.15, 0.03), a).status, RemeshStatus::kOk);
  ASSERT_EQ(remesh(two, unlocked_near(two, top, 0.15, 0.03), b).status, RemeshStatus::kOk);
  const std::vector<Face> alone = faces_of(a), beside = faces_of(b);
  EXPECT_TRUE(std::includes(beside.begin(), beside.end(), alone.begin(), alone.end()));
}

// Vertices of one side move; the other side is locked and a thirtieth of an edge away.
TEST(RemeshPart, ALockedWallCloseByIsNotTouched) {
  SurfaceMesh in = numbered(make_plate(2, 2, 0.01, 0.3));
  for (std::size_t v = 0; v < in.vertex_count(); ++v) {
    const Vec3 p = in.vertices[v];
    in.vertices.set(v, p + Vec3{0, 0.1 * std::sin(3 * p.x) * std::sin(2 * p.z), 0});
  }
  RemeshOptions options;
  options.edge_length = 0.2, options.keep_volume = true;
  for (std::size_t v = 0; v < in.vertex_count(); ++v) {
    const Vec3 p = in.vertices[v];
    const bool upper = p.y > 0.1 * std::sin(3 * p.x) * std::sin(2 * p.z);
    options.locked.push_back(upper && std::abs(p.x) < 0.5 && std::abs(p.z) < 0.5 ? 0 : 1);
  }
  SurfaceMesh out;
  const RemeshReport report = remesh(in, options, out);
  ASSERT_EQ(report.status, RemeshStatus::kOk) << report.reason;
  EXPECT_GT(report.splits + report.moves, 0u);
  const MeshCertificate c = certify(out);
  EXPECT_TRUE(c.ok()) << c.first_defect;
}

TEST(RemeshPart, AMeshOpenWhereVerticesMayChangeIsRefused) {
  SurfaceMesh in = numbered(make_sphere(0.5, 0.05));
  const RemeshOptions options = unlocked_near(in, {0, 0.5, 0}, 0.15, 0.03);
  std::vector<bool> keep(in.triangle_count(), true);
  for (std::size_t t = 0; t < keep.size() && keep[t]; ++t)
    if (in.centroid(t).y > 0.49) keep[t] = false;
  keep_faces(in, keep);
  SurfaceMesh out;
  const RemeshReport report = remesh(in, options, out);
  EXPECT_EQ(report.status, RemeshStatus::kRefused);
  EXPECT_EQ(out, in);
}

}  // namespace
}  // namespace sherd
