// Displacement gradients summed by the fast multipole method against the direct sum.
#include "engine/stress/somigliana.h"

#include <gtest/gtest.h>

#include <cstring>

#include "engine/elastostatic/reconstruction.h"
#include "engine/mesh/shapes.h"
#include "kernels/core/parallel.h"
#include "kernels/core/random.h"
#include "kernels/quadrature/gauss.h"

namespace sherd {
namespace {

using FarSum = Somigliana::FarSum;
constexpr Elastic kMaterial{1, 0.3};
// Four sums make the gradient, each of them to 1e-5 (somigliana.cpp) of its own size, which is about the gradient's.
constexpr Real kFarTolerance = 4e-5;

// Any displacement and traction: the identity's sums do not ask whether they belong together.
struct Body {
  Boundary boundary;
  std::vector<ElementField> elements;
  Somigliana somigliana;

  explicit Body(const SurfaceMesh& mesh)
      : boundary(mesh, QuadratureOptions{}), elements(fields()), somigliana(boundary, elements, kMaterial, {}) {}

  std::vector<ElementField> fields() const {
    const Reconstruction reconstruction(boundary.mesh, kMaterial.nu, {});
    Vec3Column u(boundary.mesh.vertex_count()), nodes;
    for (std::size_t v = 0; v < u.size(); ++v) {
      const Vec3 p = boundary.mesh.vertices[v];
      u.set(v, {std::sin(2 * p.y) + p.x, p.x * p.z, std::cos(3 * p.x) - p.y});
    }
    reconstruction.apply(u, nodes);
    std::vector<ElementField> out;
    for (std::size_t t = 0; t < boundary.panels.size(); ++t) {
      std::array<Vec3, cubic::kNodes> at;
      for (std::size_t a = 0; a < at.size(); ++a) at[a] = nodes[reconstruction.nodes(t)[a]];
      const Vec3 c = boundary.centroid[t];
      out.emplace_back(boundary.panels[t], at, ElementField::Quadratic{Vec3{c.y, 1, -c.x}, Vec3{0.1, 0, 0.2}},
                       kMaterial);
    }
    return out;
  }
  std::vector<Mat3> gradients(const Vec3Column& x, const std::vector<std::uint32_t>& face, FarSum sum) const {
    std::vector<Mat3> out(x.size());
    somigliana.gradients(x, face, out, sum);
    return out;
  }
};

// Relative, in the root mean square.
Real difference(const std::vector<Mat3>& a, const std::vector<Mat3>& b) {
  Real error = 0, size = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        error += (a[k][i][j] - b[k][i][j]) * (a[k][i][j] - b[k][i][j]), size += b[k][i][j] * b[k][i][j];
  return std::sqrt(error / size);
}

TEST(Somigliana, FastSumsAgreeWithDirectOnesInsideAndOutside) {
  const Body body(make_sphere(1, 0.1));
  Random random(3);
  Vec3Column x;
  while (x.size() < 3000)
    x.push_back({random.uniform(-1.3, 1.3), random.uniform(-1.3, 1.3), random.uniform(-1.3, 1.3)});
  const std::vector<std::uint32_t> face(x.size(), kNone);
  const auto direct = body.gradients(x, face, FarSum::kDirect), fast = body.gradients(x, face, FarSum::kFast);
  EXPECT_LT(difference(fast, direct), kFarTolerance);
  EXPECT_GT(difference(fast, direct), 0);  // there is a far field
}

TEST(Somigliana, FastSumsAgreeWithDirectOnesInTheLimitFromInside) {
  const Body body(make_box({1, 0.6, 0.4}, 0.06));
  Vec3Column x;
  std::vector<std::uint32_t> face;
  for (std::uint32_t t = 0; t < body.boundary.panels.size(); ++t) {
    const auto& v = body.boundary.panels[t].vertex;
    x.push_back(v[0] * 0.5 + v[1] * 0.3 + v[2] * 0.2), face.push_back(t);
  }
  const auto direct = body.gradients(x, face, FarSum::kDirect), fast = body.gradients(x, face, FarSum::kFast);
  EXPECT_LT(difference(fast, direct), kFarTolerance);
}

TEST(Somigliana, PointsOnAndBesideSourcesLoseNoDigits) {
  const Body body(make_sphere(1, 0.15));
  Vec3Column x;
  std::vector<std::uint32_t> face;
  // Towards a corner, of the way there: the last is the first that sums may take out again.
  const Real steps[] = {0, 1e-14, 1e-9, 1e-6, 1e-3, 2e-2};
  for (std::uint32_t t = 0; t < 300; ++t) {
    const PanelFrame& f = body.boundary.panels[t];
    const TrianglePoint& p = kGauss3[t % 3];
    const Vec3 y = f.vertex[0] * p.a + f.vertex[1] * p.b + f.vertex[2] * p.c;
    x.push_back(y + (f.vertex[0] - y) * steps[t % 6]), face.push_back(t);
  }
  const auto direct = body.gradients(x, face, FarSum::kDirect), fast = body.gradients(x, face, FarSum::kFast);
  EXPECT_LT(difference(fast, direct), kFarTolerance);
}

TEST(Somigliana, FastSumsAreTheSameBitsForAnyNumberOfThreads) {
  const Body body(make_sphere(1, 0.12));
  Random random(4);
  Vec3Column x;
  while (x.size() < 2000) x.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
  const std::vector<std::uint32_t> face(x.size(), kNone);
  std::vector<Mat3> one;
  {
    const ThreadLimit limit(1);
    one = body.gradients(x, face, FarSum::kFast);
  }
  const auto all = body.gradients(x, face, FarSum::kFast);
  EXPECT_EQ(std::memcmp(one.data(), all.data(), one.size() * sizeof(Mat3)), 0);
}

TEST(Somigliana, NoPointsGiveNothing) {
  const Body body(make_box({1, 1, 1}, 0.5));
  EXPECT_TRUE(body.gradients({}, {}, FarSum::kFast).empty());
  EXPECT_TRUE(body.gradients({}, {}, FarSum::kAutomatic).empty());
}

}  // namespace
}  // namespace sherd
