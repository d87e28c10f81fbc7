#include "engine/mesh/attributes.h"

#include <gtest/gtest.h>

#include "engine/mesh/shapes.h"
#include "engine/mesh/solids.h"
#include "kernels/core/random.h"

namespace sherd {
namespace {

// A linear function of the place and the face's number, so that values jump across every edge.
float value_at(const Vec3& p, std::size_t face, int component) {
  return static_cast<float>(0.25 * p.x - 0.5 * p.y + 0.125 * p.z + static_cast<Real>(face) + 100.0 * component);
}

SurfaceMesh painted_box() {
  SurfaceMesh mesh = make_box({1, 2, 3}, 0.7);
  mesh.channels = {{"uv", 2, {}}, {"heat", 1, {}}};
  for (CornerChannel& c : mesh.channels)
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < c.components; ++i) c.value.push_back(value_at(mesh.corner(t, k), t, i));
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) mesh.faces.source[t] = static_cast<std::int32_t>(t);
  return mesh;
}

// Every corner's value is the painted function of its place; 4 roundings of values below 300 in single precision.
void expect_painted(const SurfaceMesh& mesh) {
  ASSERT_EQ(check_attributes(mesh), "");
  ASSERT_EQ(mesh.channels.size(), 2u);
  for (const CornerChannel& c : mesh.channels)
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        for (int i = 0; i < c.components; ++i)
          ASSERT_NEAR(c.value[c.width() * t + k * static_cast<std::size_t>(c.components) + static_cast<std::size_t>(i)],
                      value_at(mesh.corner(t, static_cast<int>(k)), static_cast<std::size_t>(mesh.faces.source[t]), i),
                      300 * 4 * 6e-8);
}

TEST(Attributes, ExtractedAndKeptFacesKeepTheirCornerValues) {
  SurfaceMesh mesh = painted_box();
  expect_painted(mesh);
  expect_painted(extract_faces(mesh, {1, 4, 5, 17}));
  std::vector<bool> keep(mesh.triangle_count(), false);
  keep[3] = keep[8] = true;
  keep_faces(mesh, keep);
  EXPECT_EQ(mesh.triangle_count(), 2u);
  expect_painted(mesh);
}

TEST(Attributes, AFaceTurnedOverKeepsTheValueAtEachPoint) {
  SurfaceMesh mesh = painted_box();
  const SurfaceMesh before = mesh;
  turn_face(mesh, 5);
  expect_painted(mesh);
  turn_face(mesh, 5);
  EXPECT_EQ(mesh, before);
}

TEST(Attributes, PartsOfAFaceGetTheFacesValuesAtTheirCorners) {
  const SurfaceMesh mesh = painted_box();
  SurfaceMesh parts;
  match_channels(mesh, parts);
  Random random(3);
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    std::array<Vec3, 3> at;
    for (Vec3& p : at) {
      const Real a = random.uniform(0, 1), b = random.uniform(0, 1 - a);
      p = (1 - a - b) * mesh.corner(t, 0) + a * mesh.corner(t, 1) + b * mesh.corner(t, 2);
      parts.vertices.push_back(p);
    }
    const auto n = static_cast<std::uint32_t>(parts.vertex_count());
    parts.triangles.push_back({n - 3, n - 2, n - 1});
    parts.faces.push_back_from(mesh.faces, t);
    interpolate_corners(mesh, t, at, parts);
  }
  expect_painted(parts);
}

TEST(Attributes, MatchedChannelsAreThoseOfThePatternInItsOrder) {
  const SurfaceMesh pattern = painted_box();
  SurfaceMesh mesh = make_box({1, 1, 1}, 1);
  mesh.channels = {{"other", 1, std::vector<float>(3 * mesh.triangle_count(), 7)},
                   {"heat", 1, std::vector<float>(3 * mesh.triangle_count(), 5)}};
  match_channels(pattern, mesh);
  ASSERT_EQ(mesh.channels.size(), 2u);
  EXPECT_EQ(mesh.channels[0].name, "uv");
  EXPECT_EQ(mesh.channels[0].value, std::vector<float>(6 * mesh.triangle_count(), 0));
  EXPECT_EQ(mesh.channels[1].name, "heat");
  EXPECT_EQ(mesh.channels[1].value, std::vector<float>(3 * mesh.triangle_count(), 5));
  EXPECT_EQ(check_attributes(mesh), "");
}

TEST(Attributes, ColumnsAndChannelsGrowWithTriangles) {
  SurfaceMesh mesh = painted_box();
  mesh.add_triangle(0, 1, 2);
  EXPECT_EQ(check_attributes(mesh), "");
  EXPECT_EQ(mesh.faces.side.back(), 0);
  EXPECT_EQ(mesh.faces.material.back(), 0);
  mesh.channels[0].value.pop_back();
  EXPECT_NE(check_attributes(mesh), "");
}

}  // namespace
}  // namespace sherd
