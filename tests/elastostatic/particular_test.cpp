#include "engine/elastostatic/particular.h"

#include <gtest/gtest.h>

#include "kernels/fundamental/kelvin.h"

namespace sherd {
namespace {

BodyForce general_force() {
  BodyForce f;
  f.constant = {0.4, -1.2, 0.7};
  const Real b[9] = {0.3, -0.8, 0.2, 0.9, -0.5, 0.6, -0.1, 0.35, 0.75};
  for (int i = 0; i < 9; ++i) f.linear[i / 3][i % 3] = b[i];
  f.origin = {0.1, 0.2, -0.3};
  return f;
}

TEST(ParticularSolution, StressIsHookesLawOfTheDisplacement) {
  const Elastic m{2.0, 0.23};
  const ParticularSolution p(general_force(), m);
  const Vec3 x{0.5, -0.4, 0.8};
  const Real h = 1e-4;  // displacements are cubic: central differences err by h^2/6 times a constant third derivative
  Mat3 g;
  for (int k = 0; k < 3; ++k) {
    Vec3 e{};
    e[k] = h;
    const Vec3 d = (p.displacement(x + e) - p.displacement(x - e)) / (2 * h);
    for (int i = 0; i < 3; ++i) g[i][k] = d[i];
  }
  const Mat3 a = to_matrix(kelvin::hooke(g, m)), b = to_matrix(p.stress(x));
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(a[i / 3][i % 3], b[i / 3][i % 3], 1e-7);
}

TEST(ParticularSolution, DivergenceOfTheStressBalancesTheBodyForce) {
  for (const Real nu : {-0.5, 0.0, 0.3, 0.499}) {
    const BodyForce f = general_force();
    const ParticularSolution p(f, {2.0, nu});
    const Vec3 x{0.5, -0.4, 0.8};
    const Real h = 1e-3;  // stresses are quadratic: central differences are exact but for rounding 1e-16/h
    Vec3 divergence;
    for (int k = 0; k < 3; ++k) {
      Vec3 e{};
      e[k] = h;
      const Mat3 a = to_matrix(p.stress(x - e)), b = to_matrix(p.stress(x + e));
      for (int i = 0; i < 3; ++i) divergence[i] += (b[i][k] - a[i][k]) / (2 * h);
    }
    EXPECT_LT(norm(divergence + f.constant + f.linear * (x - f.origin)), 1e-11);
  }
}

}  // namespace
}  // namespace sherd
