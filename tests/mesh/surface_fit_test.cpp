// Laws of the polynomial fits on surface patches and of the smooth groups they stay in.
#include "engine/mesh/surface_fit.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/mesh/shapes.h"
#include "kernels/core/random.h"

namespace sherd {
namespace {

Real along(const std::vector<Real>& row, const std::vector<std::uint32_t>& patch, const auto& value) {
  Real sum = 0;
  for (std::size_t k = 0; k < patch.size(); ++k) sum += row[k] * value(patch[k]);
  return sum;
}

std::vector<SurfaceMesh> bodies() {
  return {make_box({1, 0.8, 0.6}, 0.2), make_sphere(0.7, 0.2), make_goblet(1, 0.25, 0.02, 0.08),
          make_plate(1, 1, 0.02, 0.1), make_box({1, 1, 1}, 1)};
}

TEST(SurfaceFit, DerivativesOfAConstantAreZeroAndOfPositionAreTheTangents) {
  for (const SurfaceMesh& mesh : bodies())
    for (const int degree : {1, 2, 3, 4}) {
      const SurfaceCorners corners = make_surface_corners(mesh, 35);
      for (std::size_t c = 0; c < corners.corner.size(); ++c) {
        const SurfaceFit f(mesh, corners, c, {degree, degree});
        const Real size = distance(mesh.vertices[f.patch()[0]], mesh.vertices[f.patch()[1]]);
        for (const auto* row : {&f.row_x(), &f.row_y()})
          // Rounding of rows whose sum of magnitudes is some tens per nearest edge.
          EXPECT_LT(std::abs(along(*row, f.patch(), [](std::uint32_t) { return 1.0; })) * size, 1e-12);
        const auto tangent = [&](const std::vector<Real>& row) {
          Vec3 sum;
          for (std::size_t k = 0; k < row.size(); ++k) sum += mesh.vertices[f.patch()[k]] * row[k];
          return sum;
        };
        EXPECT_LT(norm(tangent(f.row_x()) - f.a() - f.normal() * f.slope_x()), 1e-11);
        EXPECT_LT(norm(tangent(f.row_y()) - f.b() - f.normal() * f.slope_y()), 1e-11);
      }
    }
}

TEST(SurfaceFit, IsExactForPolynomialsOfItsDegreeOnFlatPatches) {
  const SurfaceMesh mesh = make_box({1, 0.8, 0.6}, 0.08);  // every face more than six elements wide
  const SurfaceCorners corners = make_surface_corners(mesh, 35);
  for (const int degree : {1, 2, 3}) {
    const auto value = [&](const Vec3& x) { return std::pow(1 + 0.7 * x.x - 0.4 * x.y + 0.9 * x.z, degree); };
    const auto derivative = [&](const Vec3& x) {
      return Vec3{0.7, -0.4, 0.9} * (degree * std::pow(1 + 0.7 * x.x - 0.4 * x.y + 0.9 * x.z, degree - 1));
    };
    for (std::size_t c = 0; c < corners.corner.size(); ++c) {
      const SurfaceFit f(mesh, corners, c, {degree, degree});
      const Vec3 g = derivative(mesh.vertices[f.patch()[0]]);
      const auto at = [&](std::uint32_t v) { return value(mesh.vertices[v]); };
      EXPECT_NEAR(along(f.row_x(), f.patch(), at), dot(g, f.a()), 1e-10) << degree;
      EXPECT_NEAR(along(f.row_y(), f.patch(), at), dot(g, f.b()), 1e-10) << degree;
    }
  }
}

// The safeguard relaxes a fit until values perturbed by e move no derivative by more than 8 e over the nearest
// neighbour, as long as a first derivative is resolved.
TEST(SurfaceFit, AmplifiesNoiseLittleOnAnyMesh) {
  Random random(3);
  for (SurfaceMesh mesh : bodies()) {
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      const Real x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
      mesh.vertices.set(v, mesh.vertices[v] + Vec3{x, y, z} * 0.003);
    }
    const SurfaceCorners corners = make_surface_corners(mesh, 35);
    for (std::size_t c = 0; c < corners.corner.size(); ++c) {
      const SurfaceFit f(mesh, corners, c, {});
      Real nearest = 1e300, x = 0, y = 0;
      for (std::size_t k = 1; k < f.patch().size(); ++k) {
        nearest = std::min(nearest, distance(mesh.vertices[f.patch()[0]], mesh.vertices[f.patch()[k]]));
        x += std::abs(f.row_x()[k]), y += std::abs(f.row_y()[k]);
      }
      EXPECT_LT(nearest * std::max(x, y), 20) << c;
    }
  }
}

TEST(SurfaceFit, ScalesInBitsWithTheMesh) {
  const SurfaceMesh mesh = make_goblet(1, 0.25, 0.02, 0.08);
  SurfaceMesh small = mesh;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) small.vertices.set(v, mesh.vertices[v] * 0x1p-10);
  const SurfaceCorners corners = make_surface_corners(mesh, 35), same = make_surface_corners(small, 35);
  ASSERT_EQ(corners.of, same.of);
  for (std::size_t c = 0; c < corners.corner.size(); c += 11) {
    const SurfaceFit a(mesh, corners, c, {}), b(small, same, c, {});
    ASSERT_EQ(a.patch(), b.patch());
    for (std::size_t k = 0; k < a.patch().size(); ++k) {
      EXPECT_EQ(a.row_x()[k], b.row_x()[k] * 0x1p-10);
      EXPECT_EQ(a.row_y()[k], b.row_y()[k] * 0x1p-10);
    }
  }
}

TEST(SurfaceFit, StaysFiniteOnNeedles) {
  // A fan of four faces flattened until a patch is a line to rounding.
  for (const Real height : {1e-3, 1e-6, 1e-9, 1e-12}) {
    SurfaceMesh mesh = make_box({1, 1, 1}, 0.5);
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      const Vec3 p = mesh.vertices[v];
      mesh.vertices.set(v, {p.x, p.y * height, p.z * height});
    }
    for (const Real angle : {0.0, 35.0, 180.0}) {
      const SurfaceCorners corners = make_surface_corners(mesh, angle);
      for (std::size_t c = 0; c < corners.corner.size(); ++c) {
        const SurfaceFit f(mesh, corners, c, {});
        for (std::size_t k = 0; k < f.patch().size(); ++k)
          EXPECT_TRUE(std::isfinite(f.row_x()[k]) && std::isfinite(f.row_y()[k])) << height << " corner " << c;
        EXPECT_TRUE(std::isfinite(f.slope_x()) && std::isfinite(f.slope_y()));
      }
    }
  }
}

TEST(SurfaceCorners, FeatureAngleZeroKeepsFlatFacesTogetherAndParts) {
  const SurfaceMesh box = make_box({1, 1, 1}, 0.25), sphere = make_sphere(1, 0.3);
  EXPECT_EQ(make_surface_corners(box, 0).corner.size(), make_surface_corners(box, 35).corner.size());
  // No two faces of a sphere are coplanar: a corner for each corner of each triangle.
  EXPECT_EQ(make_surface_corners(sphere, 0).corner.size(), 3 * sphere.triangle_count());
  EXPECT_EQ(make_surface_corners(box, 180).corner.size(), box.vertex_count());
}

TEST(SurfaceCorners, EveryCornerOfEveryFaceBelongsToOneGroupOfItsVertex) {
  for (const SurfaceMesh& mesh : bodies()) {
    const SurfaceCorners corners = make_surface_corners(mesh, 35);
    std::size_t faces = 0;
    for (const SurfaceCorner& c : corners.corner) {
      EXPECT_TRUE(std::is_sorted(c.faces.begin(), c.faces.end()));
      faces += c.faces.size();
    }
    EXPECT_EQ(faces, 3 * mesh.triangle_count());
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const SurfaceCorner& c = corners.corner[corners.at(t, k)];
        EXPECT_EQ(c.vertex, mesh.triangles[t][k]);
        EXPECT_TRUE(std::binary_search(c.faces.begin(), c.faces.end(), static_cast<std::uint32_t>(t)));
      }
  }
}

}  // namespace
}  // namespace sherd
