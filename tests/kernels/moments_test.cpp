// Panel moments against adaptive quadrature, the constant-density integrals and finite differences.
#include "kernels/quadrature/moments.h"

#include <gtest/gtest.h>

#include <vector>

#include "kernels/core/random.h"
#include "tests/kernels/moments_reference.h"

namespace sherd {
namespace {

const Real* components(const Sym3& s) {
  return &s.xx;
}

// Largest difference over the largest entry of an array.
struct Worst {
  Real difference = 0, entry = 0;
  void add(Real value, Real expected) {
    difference = std::max(difference, std::abs(value - expected));
    entry = std::max(entry, std::abs(expected));
    if (!std::isfinite(value)) difference = INFINITY;
  }
  // `least`: entries below it count as if they were that large.
  Real relative(Real least = 0) const { return difference / std::max(entry, least); }
};

// A panel seen nearly edge-on has small angles; their rounding is that of distance / altitude, not of the angle. They
// are held to 1e-11 of this, 1e-13, when all are smaller (4 pi is the whole).
constexpr Real kLeastAngle = 1e-2;

struct Errors {
  Real inverse = 0, dyad = 0, angle = 0, inverse_gradient = 0, dyad_gradient = 0;
  Real values() const { return std::max({inverse, dyad, angle}); }
  Real gradients() const { return std::max(inverse_gradient, dyad_gradient); }
  void raise(const Errors& b) {
    inverse = std::max(inverse, b.inverse), dyad = std::max(dyad, b.dyad), angle = std::max(angle, b.angle);
    inverse_gradient = std::max(inverse_gradient, b.inverse_gradient);
    dyad_gradient = std::max(dyad_gradient, b.dyad_gradient);
  }
};

Errors errors_at(const PanelFrame& f, const Vec3& x, bool gradients) {
  const reference::Integrator integrator(f, x, gradients);
  const reference::Sums& r = integrator.result();
  PanelMoments v;
  PanelMomentGradients g;
  integrate_panel_moments(f, x, Side::kAway, v);
  integrate_panel_moment_gradients(f, x, Side::kAway, g);
  Worst inverse, dyad, angle, inverse_gradient, dyad_gradient;
  for (int m = 0; m < kQuadraticMonomials; ++m) {
    inverse.add(v.inverse[m], r.inverse[m]);
    for (int i = 0; i < 6; ++i) dyad.add(components(v.dyad[m])[i], r.dyad[m][i]);
    for (int k = 0; k < 3; ++k) {
      inverse_gradient.add(g.inverse[m][k], r.inverse_gradient[k][m]);
      for (int i = 0; i < 6; ++i) dyad_gradient.add(components(g.dyad[k][m])[i], r.dyad_gradient[k][m][i]);
    }
  }
  for (int m = 0; m < kCubicMonomials; ++m) angle.add(v.angle[m], r.angle[m]);
  Errors e{inverse.relative(), dyad.relative(), angle.relative(kLeastAngle), 0, 0};
  if (gradients) e.inverse_gradient = inverse_gradient.relative(), e.dyad_gradient = dyad_gradient.relative();
  return e;
}

// In the plane z = 0 with edges and corners at round numbers, so that targets near them are exact.
std::vector<PanelFrame> panels(Real altitude) {
  return {make_panel({0, 0, 0}, {1, 0, 0}, {0.5, altitude, 0}), make_panel({1, 0, 0}, {0.125, altitude, 0}, {0, 0, 0}),
          make_panel({0, altitude, 0}, {0, 0, 0}, {1, 0, 0})};
}

// Above corners, edges, the inside and edge extensions, `d` off the plane; beside edges in the plane.
std::vector<Vec3> targets_near(const PanelFrame& f, Real d) {
  std::vector<Vec3> x;
  const Vec3 up{0, 0, d};
  for (int e = 0; e < 3; ++e) {
    x.push_back(f.vertex[e] + up);
    x.push_back(f.vertex[e] + Vec3{f.vertex[e].x > 0 ? d : -d, 0, 0});
    x.push_back(f.vertex[e] - Vec3{0, d, d});
  }
  x.push_back(Vec3{0.25, 0, d});
  x.push_back(Vec3{0.25, -d, 0});
  x.push_back(Vec3{0.25, -d, d});
  x.push_back(Vec3{-0.25, 0, d});
  x.push_back(Vec3{1.5, d, d});
  x.push_back(f.centroid() + up);
  x.push_back(f.centroid() - up);
  return x;
}

Errors worst_errors(Real altitude, const std::vector<Real>& distances, bool gradients) {
  Errors worst;
  for (const PanelFrame& f : panels(altitude))
    for (const Real d : distances)
      for (const Vec3& x : targets_near(f, d)) {
        const Errors e = errors_at(f, x, gradients);
        worst.raise(e);
      }
  return worst;
}

// Rounding grows by distance over altitude to the fourth at most (degree 3, and the height): 8^4 epsilon = 1e-12.
constexpr Real kTolerance = 1e-11;

void expect_small(const Errors& e) {
  EXPECT_LT(e.inverse, kTolerance);
  EXPECT_LT(e.dyad, kTolerance);
  EXPECT_LT(e.angle, kTolerance);
  EXPECT_LT(e.inverse_gradient, kTolerance);
  EXPECT_LT(e.dyad_gradient, kTolerance);
}

TEST(PanelMoments, AgreeWithAdaptiveQuadratureNearAndFar) {
  for (const Real altitude : {0.875, 1e-3}) expect_small(worst_errors(altitude, {1e-9, 1e-3, 0.5, 4}, true));
}

TEST(SlowPanelMoments, AgreeWithAdaptiveQuadratureForEveryAltitude) {
  for (const Real altitude : {0.875, 0.3, 0.1, 1e-2, 1e-3, 1e-4})
    expect_small(worst_errors(altitude, {1e-9, 1e-8, 1e-7, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5, 1, 2, 3, 6, 100}, true));
}

TEST(PanelMoments, ClosedFormAndGaussRuleMeetAtEightAltitudes) {
  Errors worst;
  for (const Real altitude : {0.875, 0.1, 1e-3})
    for (const PanelFrame& f : panels(altitude))
      for (const Real k : {7.9, 8.1}) {
        worst.raise(errors_at(f, f.centroid() + f.normal * (k * altitude), true));
        worst.raise(errors_at(f, Vec3{0.5, -k * altitude, 0.01 * altitude}, true));
        worst.raise(errors_at(f, Vec3{1 + k * altitude, 0, 0.3 * altitude}, true));
      }
  expect_small(worst);
}

// The parts that the quadrature gives up touch x and are 2^-50 of the panel in size: they hold 1e-15 of the integral.
TEST(PanelMoments, ValuesOnThePanelItselfAgreeWithAdaptiveQuadrature) {
  for (const PanelFrame& f : panels(0.875))
    for (const Vec3& x : {f.vertex[0], f.vertex[1], f.vertex[2], Vec3{0.25, 0, 0}, Vec3{0.4, 0.25, 0}}) {
      const Errors e = errors_at(f, x, false);
      EXPECT_LT(e.inverse, 1e-13);
      EXPECT_LT(e.dyad, 1e-13);
    }
}

const PanelFrame& tilted_panel() {
  static const PanelFrame f = make_panel({0.1, -0.2, 0.3}, {1.1, 0.1, 0.2}, {0.3, 0.9, -0.1});
  return f;
}
std::vector<Vec3> random_targets(int count, Real range) {
  Random random(11);
  std::vector<Vec3> x;
  for (int i = 0; i < count; ++i)
    x.push_back({random.uniform(-range, range), random.uniform(-range, range), random.uniform(-range, range)});
  return x;
}

// Both are exact to rounding, amplified by the square of the distance in edges (16).
TEST(PanelMoments, DegreeZeroAndOneAreTheConstantDensityIntegrals) {
  const PanelFrame& f = tilted_panel();
  std::vector<Vec3> targets = random_targets(200, 2);
  targets.push_back(f.centroid());
  for (const Vec3& x : targets)
    for (const Side side : {Side::kAway, Side::kOnSurface, Side::kInterior}) {
      if (side != Side::kAway && !(x == f.centroid())) continue;
      PanelMoments m;
      PanelMomentGradients g;
      PanelValues values;
      PanelGradients gradients;
      integrate_panel_moments(f, x, side, m);
      integrate_panel_moment_gradients(f, x, side, g);
      integrate_panel(f, x, side, values);
      integrate_panel_gradient(f, x, side, gradients);
      const Real scale = std::max(values.inverse, norm(gradients.inverse)), tolerance = 1e-13 * std::max(scale, 1.0);
      EXPECT_NEAR(m.inverse[0], values.inverse, tolerance);
      EXPECT_NEAR(m.angle[0], values.solid_angle, tolerance);
      EXPECT_NEAR(m.angle[1], values.shape_angle[1], tolerance);
      EXPECT_NEAR(m.angle[2], values.shape_angle[2], tolerance);
      EXPECT_NEAR(norm(g.inverse[0] - gradients.inverse), 0, tolerance);
      const Mat3 dyad = to_matrix(m.dyad[0]);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          EXPECT_NEAR(dyad[i][j], values.dyad[i][j], tolerance);
          for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(to_matrix(g.dyad[k][0])[i][j], gradients.dyad[k][i][j], 4 * tolerance);
        }
    }
}

TEST(PanelMoments, TraceOfTheDyadIsTheInverseDistanceForEveryDensity) {
  const PanelFrame& f = tilted_panel();
  for (const Vec3& x : random_targets(200, 4)) {
    PanelMoments m;
    PanelMomentGradients g;
    integrate_panel_moments(f, x, Side::kAway, m);
    integrate_panel_moment_gradients(f, x, Side::kAway, g);
    for (int i = 0; i < kQuadraticMonomials; ++i) {
      EXPECT_NEAR(m.dyad[i].xx + m.dyad[i].yy + m.dyad[i].zz, m.inverse[i], 1e-12 * m.inverse[0]);
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(g.dyad[k][i].xx + g.dyad[k][i].yy + g.dyad[k][i].zz, g.inverse[i][k], 1e-12 * norm(g.inverse[0]));
    }
  }
}

// Sixth-order central differences with step h at distance d: error h^6 f(7) / 140 ~ 5040 / 140 (h / d)^6 / d and
// rounding 1e-14 / h; h = 0.003 d gives 3e-14 and 1e-11.
TEST(PanelMoments, GradientsAreTheDerivativesOfTheValues) {
  const PanelFrame& f = tilted_panel();
  constexpr Real kStencil[3] = {45.0 / 60, -9.0 / 60, 1.0 / 60};
  for (const Vec3& x : {f.centroid() + f.normal * 0.2, f.centroid() - f.normal * 1.7, f.vertex[1] + f.normal * 0.3,
                        f.vertex[0] - f.tangent[0] * 0.4, f.centroid() + f.outward[1] * 3.0}) {
    const Real step = 0.003 * 0.2;
    PanelMomentGradients g;
    integrate_panel_moment_gradients(f, x, Side::kAway, g);
    for (int k = 0; k < 3; ++k) {
      Real inverse[kQuadraticMonomials] = {};
      Sym3 dyad[kQuadraticMonomials];
      for (int i = 0; i < 3; ++i)
        for (const Real sign : {1.0, -1.0}) {
          Vec3 y = x;
          y[k] += sign * (i + 1) * step;
          PanelMoments m;
          integrate_panel_moments(f, y, Side::kAway, m);
          for (int j = 0; j < kQuadraticMonomials; ++j) {
            inverse[j] += sign * kStencil[i] / step * m.inverse[j];
            dyad[j] += m.dyad[j] * (sign * kStencil[i] / step);
          }
        }
      for (int j = 0; j < kQuadraticMonomials; ++j) {
        EXPECT_NEAR(g.inverse[j][k], inverse[j], 1e-10);
        for (int c = 0; c < 6; ++c) EXPECT_NEAR(components(g.dyad[k][j])[c], components(dyad[j])[c], 1e-10);
      }
    }
  }
}

// From inside (d < 0) the values tend to those of kInterior like d, the gradients like d log d.
TEST(PanelMoments, InteriorSideIsTheLimitFromAgainstTheNormal) {
  const PanelFrame& f = tilted_panel();
  const Vec3 x = f.centroid() + f.tangent[0] * 0.1;
  const Real d = 1e-9;
  PanelMoments limit, near;
  PanelMomentGradients limit_gradient, near_gradient;
  integrate_panel_moments(f, x, Side::kInterior, limit);
  integrate_panel_moments(f, x - f.normal * d, Side::kAway, near);
  integrate_panel_moment_gradients(f, x, Side::kInterior, limit_gradient);
  integrate_panel_moment_gradients(f, x - f.normal * d, Side::kAway, near_gradient);
  for (int m = 0; m < kCubicMonomials; ++m) EXPECT_NEAR(limit.angle[m], near.angle[m], 100 * d);
  for (int m = 0; m < kQuadraticMonomials; ++m) {
    EXPECT_NEAR(limit.inverse[m], near.inverse[m], 100 * d);
    for (int c = 0; c < 6; ++c) EXPECT_NEAR(components(limit.dyad[m])[c], components(near.dyad[m])[c], 100 * d);
    EXPECT_NEAR(norm(limit_gradient.inverse[m] - near_gradient.inverse[m]), 0, 1000 * d);
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 6; ++c)
        EXPECT_NEAR(components(limit_gradient.dyad[k][m])[c], components(near_gradient.dyad[k][m])[c], 1000 * d);
  }
}

// On the panel the double layer of m is its jump alone, and the normal derivative of the single layer as well.
TEST(PanelMoments, OnThePanelTheJumpIsTwoPiTimesTheDensity) {
  const PanelFrame& f = tilted_panel();
  const Real s = 0.3, t = 0.45, pi = std::numbers::pi;
  const Vec3 x = f.vertex[0] + (f.vertex[1] - f.vertex[0]) * s + (f.vertex[2] - f.vertex[0]) * t;
  const Real monomial[kCubicMonomials] = {1, s, t, s * s, s * t, t * t, s * s * s, s * s * t, s * t * t, t * t * t};
  PanelMoments interior, surface;
  PanelMomentGradients interior_gradient, surface_gradient;
  integrate_panel_moments(f, x, Side::kInterior, interior);
  integrate_panel_moments(f, x, Side::kOnSurface, surface);
  integrate_panel_moment_gradients(f, x, Side::kInterior, interior_gradient);
  integrate_panel_moment_gradients(f, x, Side::kOnSurface, surface_gradient);
  for (int m = 0; m < kCubicMonomials; ++m) {
    EXPECT_NEAR(interior.angle[m], -2 * pi * monomial[m], 1e-14);
    EXPECT_EQ(surface.angle[m], 0);
  }
  for (int m = 0; m < kQuadraticMonomials; ++m) {
    const Vec3 jump = interior_gradient.inverse[m] - surface_gradient.inverse[m];
    EXPECT_NEAR(norm(jump - f.normal * (2 * pi * monomial[m])), 0, 1e-13);
    EXPECT_NEAR(dot(surface_gradient.inverse[m], f.normal), 0, 1e-13);
    EXPECT_EQ(interior.inverse[m], surface.inverse[m]);
  }
}

// Powers of two change no digit: 1/l and r r/l^3 over the area scale by length, angles and gradients not at all.
TEST(PanelMoments, ScaleExactlyWithTheLength) {
  const PanelFrame& f = tilted_panel();
  for (const Real scale : {0x1p-20, 0x1p10}) {
    const PanelFrame scaled = make_panel(f.vertex[0] * scale, f.vertex[1] * scale, f.vertex[2] * scale);
    for (const Vec3& x : random_targets(50, 12)) {
      PanelMoments a, b;
      PanelMomentGradients ga, gb;
      integrate_panel_moments(f, x, Side::kAway, a);
      integrate_panel_moments(scaled, x * scale, Side::kAway, b);
      integrate_panel_moment_gradients(f, x, Side::kAway, ga);
      integrate_panel_moment_gradients(scaled, x * scale, Side::kAway, gb);
      for (int m = 0; m < kCubicMonomials; ++m) EXPECT_EQ(a.angle[m], b.angle[m]);
      for (int m = 0; m < kQuadraticMonomials; ++m) {
        EXPECT_EQ(a.inverse[m] * scale, b.inverse[m]);
        EXPECT_EQ(a.dyad[m] * scale, b.dyad[m]);
        EXPECT_EQ(ga.inverse[m], gb.inverse[m]);
        for (int k = 0; k < 3; ++k) EXPECT_EQ(ga.dyad[k][m], gb.dyad[k][m]);
      }
    }
  }
}

// Tilted slivers: the rounded corners tilt the normal by epsilon / altitude, relative to the altitude once more.
TEST(PanelMoments, TiltedSliversAgreeWithAdaptiveQuadrature) {
  for (const Real altitude : {1e-2, 1e-4}) {
    const Vec3 along = normalized(Vec3{0.6, -0.5, 0.4}), across = any_perpendicular(along);
    const Vec3 origin{0.3, 0.7, -0.2};
    const PanelFrame f = make_panel(origin, origin + along, origin + along * 0.4 + across * altitude);
    for (const Vec3& x : random_targets(30, 3)) {
      const Errors e = errors_at(f, x, true);
      EXPECT_LT(std::max(e.values(), e.gradients()), 1e-11 + 100 * 2e-16 / altitude);
    }
    for (const Real k : {0.5, 3.0}) {
      const Errors e = errors_at(f, origin + along * 0.37 + (across * -0.3 + f.normal) * (k * altitude), true);
      EXPECT_LT(std::max(e.values(), e.gradients()), 1e-11 + 100 * 2e-16 / altitude);
    }
  }
}

TEST(PanelMoments, FiniteAtCornersOnEdgesAndOnThePanel) {
  const PanelFrame& f = tilted_panel();
  for (const Vec3& x : {f.vertex[0], f.vertex[2], 0.5 * (f.vertex[0] + f.vertex[1]), f.centroid()})
    for (const Side side : {Side::kAway, Side::kOnSurface, Side::kInterior}) {
      PanelMoments v;
      PanelMomentGradients g;
      integrate_panel_moments(f, x, side, v);
      integrate_panel_moment_gradients(f, x, side, g);
      for (int m = 0; m < kCubicMonomials; ++m) EXPECT_TRUE(std::isfinite(v.angle[m]));
      for (int m = 0; m < kQuadraticMonomials; ++m) {
        EXPECT_GT(v.inverse[m], 0);
        EXPECT_TRUE(is_finite(g.inverse[m]));
        for (int c = 0; c < 6; ++c) {
          EXPECT_TRUE(std::isfinite(components(v.dyad[m])[c]));
          for (int k = 0; k < 3; ++k) EXPECT_TRUE(std::isfinite(components(g.dyad[k][m])[c]));
        }
      }
    }
}

}  // namespace
}  // namespace sherd
