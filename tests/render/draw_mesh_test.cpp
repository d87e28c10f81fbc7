#include "render/draw_mesh.h"

#include <cmath>

#include "tests/render/picture.h"

namespace sherd {
namespace {

Vec3 normal_at(const DrawMesh& mesh, std::uint32_t vertex) {
  const float* v = mesh.vertices.data() + 6 * static_cast<std::size_t>(vertex);
  return {v[3], v[4], v[5]};
}

TEST(DrawMesh, ABoxKeepsItsCreases) {
  const SurfaceMesh box = make_box({1, 2, 3}, 0.5);
  const DrawMesh drawn = make_draw_mesh(box);
  ASSERT_EQ(drawn.indices.size(), 3 * box.triangle_count());
  for (std::size_t t = 0; t < box.triangle_count(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      // Flat sides: every normal is the side's own, to single precision.
      EXPECT_GT(dot(normal_at(drawn, drawn.indices[3 * t + k]), normalized(box.area_normal2(t))), 1 - 1e-6);
}

TEST(DrawMesh, ASphereIsSmoothAndSharesItsVertices) {
  const SurfaceMesh sphere = make_sphere(1, 0.2);
  const DrawMesh drawn = make_draw_mesh(sphere);
  EXPECT_EQ(drawn.vertices.size(), 6 * sphere.vertex_count());
  for (std::size_t i = 0; i < drawn.vertices.size(); i += 6) {
    const float* v = drawn.vertices.data() + i;
    const Vec3 p = Vec3{v[0], v[1], v[2]} + drawn.origin, n{v[3], v[4], v[5]};
    // Face normals deviate by about half an edge (0.1 rad); their mean by its square where the ring is uneven.
    EXPECT_GT(dot(normalized(p), n), std::cos(0.02));
  }
}

TEST(DrawMesh, CrackFacesComeLastAndShareNoVertexWithTheOriginalSurface) {
  SurfaceMesh sphere = make_sphere(1, 0.2);
  sphere.faces.resize(sphere.triangle_count());
  std::size_t cracks = 0;
  for (std::size_t t = 0; t < sphere.triangle_count(); ++t)
    if (sphere.centroid(t).x > 0) sphere.faces.kind[t] = FaceKind::kCrack, ++cracks;
  const DrawMesh drawn = make_draw_mesh(sphere);
  EXPECT_EQ(drawn.indices.size() - drawn.original_indices, 3 * cracks);
  std::uint32_t last_original = 0;
  for (std::size_t i = 0; i < drawn.original_indices; ++i) last_original = std::max(last_original, drawn.indices[i]);
  for (std::size_t i = drawn.original_indices; i < drawn.indices.size(); ++i)
    EXPECT_GT(drawn.indices[i], last_original);
}

}  // namespace
}  // namespace sherd
