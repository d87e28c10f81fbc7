// Laws of the Newton potential of a constant body force.
#include "engine/elastostatic/newton.h"

#include <gtest/gtest.h>

#include "kernels/core/random.h"
#include "kernels/fundamental/kelvin.h"
#include "kernels/quadrature/gauss.h"
#include "tests/elastostatic/indirect_support.h"

namespace sherd {
namespace {

const Elastic kMaterial{2.5, 0.27};
const Vec3 kForce{0.3, -1.1, 0.7};
constexpr Real kStep = 0.01;
constexpr QuadratureOptions kExact{1e30, 1e30};

TEST(NewtonKernel, DivergenceOfBothFormsIsKelvinsDisplacement) {
  Random random(3);
  for (int n = 0; n < 20; ++n) {
    const Vec3 r{random.uniform(0.5, 1.2), random.uniform(-1.2, -0.5), random.uniform(0.5, 1)};  // y - x
    const Vec3 u = kelvin::displacement(r, kForce, kMaterial);
    Vec3 paper, simple;
    for (int k = 0; k < 3; ++k) {
      Vec3 normal{};
      normal[k] = 1;
      paper += derivative([&](const Vec3& q) { return kelvin::newton(normalized(q), kForce, normal, kMaterial); }, r, k,
                          kStep);
      simple += derivative([&](const Vec3& q) { return newton_kernel(normalized(q), kForce, normal, kMaterial); }, r, k,
                           kStep);
    }
    EXPECT_LT(norm(paper - u), 1e-12 * norm(u));  // derivative(): 1e-13
    EXPECT_LT(norm(simple - u), 1e-12 * norm(u));
  }
}

TEST(NewtonPotential, BothKernelsGiveTheSamePotentialOverAClosedSurface) {
  const SurfaceMesh mesh = make_box({1, 0.7, 1.3}, 0.2);
  const Boundary boundary(mesh, kExact);
  for (const Vec3& x : {Vec3{2, 0.4, -0.3}, Vec3{-1.5, 1.1, 0.2}}) {
    Vec3 paper;
    for (const PanelFrame& f : boundary.panels)
      for (const TrianglePoint& g : kGauss7) {
        const Vec3 y = f.vertex[0] * g.a + f.vertex[1] * g.b + f.vertex[2] * g.c;
        paper += kelvin::newton(normalized(y - x), kForce, f.normal, kMaterial) * (g.weight * f.area);
      }
    const Vec3 u = NewtonPotential(boundary, kForce, kMaterial).displacement(x);
    EXPECT_LT(norm(paper - u),
              1e-7 * norm(u));  // seven points five edges away: below 1e-7 a panel (design notes, sec. 2)
  }
}

TEST(NewtonPotential, GradientIsTheDerivativeOfTheDisplacement) {
  const SurfaceMesh mesh = make_box({1, 0.7, 1.3}, 0.5);
  const Boundary boundary(mesh, kExact);
  const NewtonPotential p(boundary, kForce, kMaterial);
  for (const Vec3& x : {Vec3{0.05, 0.02, -0.1}, Vec3{0.9, 0.1, 0.2}, Vec3{1.1, 1.2, -1}}) {
    const Mat3 g = p.gradient(x);
    for (int k = 0; k < 3; ++k) {
      const Vec3 d = derivative([&](const Vec3& y) { return p.displacement(y); }, x, k, kStep);
      // Nearest distance to an edge 0.3: (h / 0.3)^8 = 2e-12 of the gradient
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(g[i][k], d[i], 1e-10);
    }
  }
}

TEST(NewtonPotential, StressBalancesTheForceInsideAndNothingOutside) {
  const SurfaceMesh mesh = make_shell(1, 0.4, 0.6);
  const Boundary boundary(mesh, kExact);
  const NewtonPotential p(boundary, kForce, kMaterial);
  const auto unbalanced = [&](const Vec3& x) {
    Vec3 divergence;
    for (int k = 0; k < 3; ++k) {
      const Sym3 d = derivative([&](const Vec3& y) { return p.stress(y); }, x, k, kStep);
      divergence += to_matrix(d).column(k);
    }
    return divergence;
  };
  // Nearest distance to the surface 0.2: (h / 0.2)^8 = 4e-11
  EXPECT_LT(norm(unbalanced({0.4, 0.3, -0.4}) + kForce), 1e-9);
  EXPECT_LT(norm(unbalanced({0.05, 0, -0.1})), 1e-9);  // in the cavity
  EXPECT_LT(norm(unbalanced({1.1, 0.5, -0.2})), 1e-9);
}

TEST(NewtonPotential, FarAwayTheBodyIsAPointForce) {
  const SurfaceMesh mesh = make_box({1, 0.7, 1.3}, 0.35);
  const Boundary boundary(mesh, QuadratureOptions{});
  const NewtonPotential p(boundary, kForce, kMaterial);
  const Vec3 x{9, -13, 11};
  const Vec3 point = kelvin::displacement(x, kForce * signed_volume(mesh), kMaterial);
  // The first neglected moment is the second: (1.3 / 19)^2 / 24, times a few of the kernel's second derivative.
  EXPECT_LT(norm(p.displacement(x) - point), 1e-3 * norm(point));
}

TEST(NewtonPotential, StressIsContinuousAcrossTheSurface) {
  const SurfaceMesh mesh = make_box({1, 0.7, 1.3}, 0.35);
  const Boundary boundary(mesh, kExact);
  const NewtonPotential p(boundary, kForce, kMaterial);
  for (std::size_t t = 0; t < mesh.triangle_count(); t += 7) {
    const Vec3 x = boundary.centroid[t], n = boundary.panels[t].normal;
    const Sym3 at = p.stress(x);
    for (const Real side : {-1e-9, 1e-9}) {
      const Sym3 d = p.stress(x + n * side) - at;
      // second derivatives are bounded at centroids: the distance times b / (lambda + 2 mu) times the stiffness
      EXPECT_LT(std::abs(d.xx) + std::abs(d.yy) + std::abs(d.zz) + std::abs(d.yz) + std::abs(d.xz) + std::abs(d.xy),
                1e-7);
    }
  }
}

TEST(BodyForceField, BalancesTheWholeForceWhicheverPotentialIsChosen) {
  const SurfaceMesh mesh = make_box({1, 0.7, 1.3}, 0.5);
  const Boundary boundary(mesh, kExact);
  BodyForce force{kForce, Mat3::identity() * 0.4, {0.1, 0, 0.2}};
  force.linear[0][1] = 0.3;
  const ParticularSolution polynomial(force, kMaterial);
  const Vec3 x{0.05, 0.02, -0.1};
  for (const BodyForcePotential potential : {BodyForcePotential::kPolynomial, BodyForcePotential::kNewton}) {
    const BodyForceField field(boundary, force, polynomial, potential, kMaterial);
    Vec3 divergence;
    for (int k = 0; k < 3; ++k)
      divergence += to_matrix(derivative([&](const Vec3& y) { return field.stress(y); }, x, k, kStep)).column(k);
    EXPECT_LT(norm(divergence + force.constant + force.linear * (x - force.origin)), 1e-10);
  }
}

}  // namespace
}  // namespace sherd
