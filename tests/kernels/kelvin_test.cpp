// Laws of the fundamental solutions.
#include "kernels/fundamental/kelvin.h"

#include <gtest/gtest.h>

#include "kernels/core/random.h"
#include "kernels/fundamental/laplace.h"

namespace sherd {
namespace {

const Elastic kMaterial{2.5, 0.27};
const Vec3 kForce{0.3, -1.1, 0.7};

Vec3 random_point(Random& r) {
  return {r.uniform(0.4, 1.2), r.uniform(-1.2, -0.4), r.uniform(0.3, 1)};
}

TEST(Kelvin, GradientIsTheDerivativeOfTheDisplacement) {
  Random random(1);
  const Real h = 1e-5;  // error h^2 f''' ~ 1e-10, rounding 1e-16/h = 1e-11
  for (int n = 0; n < 20; ++n) {
    const Vec3 r = random_point(random);
    const Mat3 g = kelvin::gradient(r, kForce, kMaterial);
    for (int k = 0; k < 3; ++k) {
      Vec3 e{};
      e[k] = h;
      const Vec3 d =
          (kelvin::displacement(r + e, kForce, kMaterial) - kelvin::displacement(r - e, kForce, kMaterial)) / (2 * h);
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(g[i][k], d[i], 1e-9);
    }
  }
}

TEST(Kelvin, StressIsDivergenceFreeAwayFromTheForce) {
  Random random(2);
  const Real h = 1e-4;
  for (int n = 0; n < 20; ++n) {
    const Vec3 r = random_point(random);
    Vec3 divergence;
    for (int k = 0; k < 3; ++k) {
      Vec3 e{};
      e[k] = h;
      const Mat3 a = to_matrix(kelvin::stress(r - e, kForce, kMaterial)),
                 b = to_matrix(kelvin::stress(r + e, kForce, kMaterial));
      for (int i = 0; i < 3; ++i) divergence[i] += (b[i][k] - a[i][k]) / (2 * h);
    }
    EXPECT_LT(norm(divergence), 2e-7);  // h^2 times third derivatives of order 10
  }
}

TEST(Kelvin, TractionOnASphereBalancesTheForce) {
  Vec3 sum;
  const int n = 200;  // midpoint rule in the polar angle, spectral in the azimuth
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 16; ++j) {
      const Real z = -1 + (i + 0.5) * 2 / n, s = std::sqrt(1 - z * z), p = 2 * std::numbers::pi * j / 16;
      const Vec3 x{s * std::cos(p), s * std::sin(p), z};
      sum += kelvin::traction(x, kForce, x, kMaterial) * (4 * std::numbers::pi / (n * 16));
    }
  EXPECT_LT(norm(sum + kForce), 5e-5);  // midpoint error 1/(n^2)
}

TEST(Newton, DivergenceOfTheKernelIsKelvinsDisplacement) {
  Random random(3);
  const Real h = 1e-4;
  for (int n = 0; n < 20; ++n) {
    const Vec3 r = random_point(random);  // y - x
    Vec3 divergence;                      // d/dy_k W_ijk b_j
    for (int k = 0; k < 3; ++k) {
      Vec3 e{}, normal{};
      e[k] = h, normal[k] = 1;
      const auto w = [&](const Vec3& q) { return kelvin::newton(normalized(q), kForce, normal, kMaterial); };
      divergence += (w(r + e) - w(r - e)) / (2 * h);
    }
    EXPECT_LT(norm(divergence - kelvin::displacement(r, kForce, kMaterial)), 1e-8);
  }
}

TEST(Laplace, GradientAndDoubleLayerFollowFromTheSingleLayer) {
  Random random(4);
  const Vec3 normal = normalized(Vec3{0.2, 0.5, -0.4});
  for (int n = 0; n < 20; ++n) {
    const Vec3 r = random_point(random);
    const Real h = 1e-5;
    Vec3 d;
    for (int k = 0; k < 3; ++k) {
      Vec3 e{};
      e[k] = h;
      d[k] = (laplace::single_layer(r + e) - laplace::single_layer(r - e)) / (2 * h);
    }
    EXPECT_LT(norm(d - laplace::single_layer_gradient(r)), 1e-9);
    EXPECT_NEAR(laplace::double_layer(r, normal), -dot(laplace::single_layer_gradient(r), normal), 1e-15);
  }
}

}  // namespace
}  // namespace sherd
