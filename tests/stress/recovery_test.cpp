// Laws of the stress recovery and of the seeds it gives.
#include "engine/stress/recovery.h"

#include <gtest/gtest.h>

#include "engine/mesh/shapes.h"
#include "kernels/fundamental/kelvin.h"

namespace sherd {
namespace {

const Elastic kMaterial{2.0, 0.28};

Vec3Column field(const SurfaceMesh& mesh, const auto& u) {
  Vec3Column out(mesh.vertex_count());
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) out.set(i, u(mesh.vertices[i]));
  return out;
}

Mat3 some_gradient() {
  Mat3 g;
  const Real v[9] = {0.3, -0.2, 0.5, 0.1, 0.7, -0.4, 0.25, 0.15, -0.6};
  for (int i = 0; i < 9; ++i) g[i / 3][i % 3] = v[i];
  return g;
}

// Largest error of the recovered stress when displacement and traction are exact, relative to the largest stress.
Real recovery_error(const SurfaceMesh& mesh, int degree, const auto& u, const auto& gradient) {
  const SurfaceRecovery recovery(mesh, {35, degree});
  Vec3Column traction(recovery.corners().size());
  std::vector<Sym3> exact(traction.size());
  Real size = 0, error = 0;
  for (std::size_t c = 0; c < exact.size(); ++c) {
    const StressCorner& corner = recovery.corners()[c];
    exact[c] = kelvin::hooke(gradient(mesh.vertices[corner.vertex]), kMaterial);
    traction.set(c, exact[c] * corner.normal);
    size = std::max(size, std::abs(eigen_symmetric(exact[c]).value[0]));
  }
  const std::vector<Sym3> stress = recovery.stress(field(mesh, u), traction, kMaterial);
  for (std::size_t c = 0; c < exact.size(); ++c) {
    const Eigen3 e = eigen_symmetric(stress[c] - exact[c]);
    error = std::max({error, std::abs(e.value[0]), std::abs(e.value[2])});
  }
  return error / size;
}

TEST(SurfaceRecovery, IsExactForAffineDisplacementsOnAnyBody) {
  const auto u = [](const Vec3& x) { return some_gradient() * x; };
  const auto g = [](const Vec3&) { return some_gradient(); };
  for (const int degree : {2, 3}) {
    EXPECT_LT(recovery_error(make_box({1, 0.8, 0.6}, 0.2), degree, u, g), 1e-11);
    EXPECT_LT(recovery_error(make_sphere(0.7, 0.15), degree, u, g), 1e-11);
    EXPECT_LT(recovery_error(make_goblet(1, 0.25, 0.02, 0.05), degree, u, g), 1e-9);  // fits on long thin patches
  }
}

TEST(SurfaceRecovery, IsExactForQuadraticDisplacementsOnFlatFaces) {
  const auto u = [](const Vec3& x) { return Vec3{x.x * x.y, x.z * x.z - 0.3 * x.x * x.x, x.y * x.z}; };
  const auto g = [](const Vec3& x) {
    Mat3 m;
    m[0][0] = x.y, m[0][1] = x.x, m[1][0] = -0.6 * x.x, m[1][2] = 2 * x.z, m[2][1] = x.z, m[2][2] = x.y;
    return m;
  };
  EXPECT_LT(recovery_error(make_box({1, 0.8, 0.6}, 0.1), 3, u, g), 1e-10);
}

TEST(SurfaceRecovery, CornersSplitAtCreasesOnly) {
  const SurfaceMesh box = make_box({1, 1, 1}, 0.5);
  const SurfaceRecovery recovery(box, {});
  std::vector<int> corners(box.vertex_count(), 0);
  for (const SurfaceCorner& c : recovery.corners()) ++corners[c.vertex];
  // 8 box corners have three groups, edge vertices two, face vertices one.
  EXPECT_EQ(std::count(corners.begin(), corners.end(), 3), 8);
  for (std::size_t v = 0; v < corners.size(); ++v) {
    const Vec3 x = box.vertices[v];
    int extreme = 0;
    for (int k = 0; k < 3; ++k) extreme += std::abs(std::abs(x[k]) - 0.5) < 1e-12;
    EXPECT_EQ(corners[v], extreme);
  }
  const SurfaceMesh sphere = make_sphere(1, 0.3);
  EXPECT_EQ(SurfaceRecovery(sphere, {}).corners().size(), sphere.vertex_count());
}

}  // namespace
}  // namespace sherd
