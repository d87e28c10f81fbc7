// Closed-form panel integrals against quadrature, and the identities between them.
#include "kernels/quadrature/triangle.h"

#include <gtest/gtest.h>

#include <array>
#include <numbers>
#include <vector>

#include "kernels/core/random.h"
#include "kernels/quadrature/gauss.h"

namespace sherd {
namespace {

struct Reference {
  Real inverse = 0;
  Mat3 dyad;
  Real omega = 0;
  Vec3 shape;
};

// Adaptive: splits a sub-triangle in four while it is closer than four of its own diameters; 7-point rule then errs by
// less than 1e-7 at distance 4 per level of |integrand|, so a further global level of subdivision (two more here) gives
// 1e-12.
void integrate_reference(const PanelFrame& f, const std::array<Vec3, 3>& c, const Vec3& x, int extra, int depth,
                         Reference& r) {
  const Vec3 centre = (c[0] + c[1] + c[2]) / 3.0;
  const Real diameter = std::max({distance(c[0], c[1]), distance(c[1], c[2]), distance(c[2], c[0])});
  const bool near = distance(x, centre) < 4 * diameter;
  if ((near && depth > 0) || extra > 0) {
    const Vec3 m0 = 0.5 * (c[0] + c[1]), m1 = 0.5 * (c[1] + c[2]), m2 = 0.5 * (c[2] + c[0]);
    for (const std::array<Vec3, 3>& s : {std::array{c[0], m0, m2}, {m0, c[1], m1}, {m2, m1, c[2]}, {m0, m1, m2}})
      integrate_reference(f, s, x, near ? extra : extra - 1, depth - 1, r);
    return;
  }
  const Real area = 0.5 * norm(cross(c[1] - c[0], c[2] - c[0]));
  for (const TrianglePoint& g : kGauss7) {
    const Vec3 y = c[0] * g.a + c[1] * g.b + c[2] * g.c, q = x - y;
    const Real l = norm(q), w = g.weight * area;
    r.inverse += w / l;
    r.dyad += outer(q, q) * (w / (l * l * l));
    const Real k = w * dot(q, f.normal) / (l * l * l);
    r.omega += k;
    for (int a = 0; a < 3; ++a) r.shape[a] += k * (1 + dot(f.shape_gradient(a), y - f.vertex[a]));
  }
}

std::vector<Vec3> targets(const PanelFrame& f) {
  const Vec3 c = f.centroid();
  std::vector<Vec3> x;
  for (const Real d : {3.0, 0.6, 0.1, 0.02}) {
    x.push_back(c + f.normal * d);
    x.push_back(c - f.normal * d);
    x.push_back(f.vertex[1] + f.normal * d);
    x.push_back(0.5 * (f.vertex[1] + f.vertex[2]) + f.outward[1] * d);  // in the plane, off an edge
    x.push_back(f.vertex[0] - f.tangent[0] * d);                        // on the extension of an edge
    x.push_back(f.vertex[2] + f.normal * d + f.outward[0] * (0.7 * d));
  }
  return x;
}

const PanelFrame& panel() {
  static const PanelFrame f = make_panel({0.1, -0.2, 0.3}, {1.1, 0.1, 0.2}, {0.3, 0.9, -0.1});
  return f;
}

TEST(PanelIntegral, ValuesAgreeWithAdaptiveQuadrature) {
  for (const Vec3& x : targets(panel())) {
    Reference r;
    integrate_reference(panel(), {panel().vertex[0], panel().vertex[1], panel().vertex[2]}, x, 2, 14, r);
    PanelValues v;
    integrate_panel(panel(), x, Side::kAway, v);
    const Real tolerance = 2e-10;  // of the reference, see above (7 points, worst near leaf 1e-7/4^5)
    EXPECT_NEAR(v.inverse, r.inverse, tolerance * std::abs(r.inverse));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) EXPECT_NEAR(v.dyad[i][j], r.dyad[i][j], tolerance * std::abs(r.inverse));
    EXPECT_NEAR(v.solid_angle, r.omega, 1e-8);
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(v.shape_angle[a], r.shape[a], 1e-8);
  }
}

TEST(PanelIntegral, GradientsAreTheDerivativesOfTheValues) {
  const Real step = 1e-5;  // central differences err by step^2 f'''/6 ~ 1e-10 / d^3 and rounding 1e-16/step = 1e-11
  for (const Vec3& x : targets(panel())) {
    PanelGradients g;
    integrate_panel_gradient(panel(), x, Side::kAway, g);
    for (int k = 0; k < 3; ++k) {
      Vec3 h{};
      h[k] = step;
      PanelValues a, b;
      integrate_panel(panel(), x + h, Side::kAway, b);
      integrate_panel(panel(), x - h, Side::kAway, a);
      const Real tolerance = 2e-5;  // d >= 0.02: step^2/d^3 = 1.3e-5 for the steepest target
      EXPECT_NEAR(g.inverse[k], (b.inverse - a.inverse) / (2 * step), tolerance);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) EXPECT_NEAR(g.dyad[k][i][j], (b.dyad[i][j] - a.dyad[i][j]) / (2 * step), tolerance);
    }
  }
}

TEST(PanelIntegral, TraceOfTheDyadIsTheInverseDistance) {
  Random random(7);
  for (int i = 0; i < 200; ++i) {
    const Vec3 x{random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)};
    PanelValues v;
    integrate_panel(panel(), x, Side::kAway, v);
    EXPECT_NEAR(trace(v.dyad), v.inverse, 1e-12 * std::max(1.0, v.inverse));
    EXPECT_NEAR(v.shape_angle.x + v.shape_angle.y + v.shape_angle.z, v.solid_angle, 1e-12);
  }
}

TEST(PanelIntegral, FiniteAtVerticesEdgesAndOnThePanel) {
  const PanelFrame& f = panel();
  for (const Vec3& x : {f.vertex[0], f.vertex[2], 0.5 * (f.vertex[0] + f.vertex[1]), f.centroid()})
    for (const Side side : {Side::kAway, Side::kOnSurface, Side::kInterior}) {
      PanelValues v;
      PanelGradients g;
      integrate_panel(f, x, side, v);
      integrate_panel_gradient(f, x, side, g);
      EXPECT_TRUE(std::isfinite(v.inverse) && std::isfinite(v.dyad[0][1]) && is_finite(v.shape_angle) &&
                  is_finite(g.inverse));
      EXPECT_GT(v.inverse, 0);
    }
}

TEST(PanelIntegral, SolidAnglesOfAClosedSurfaceSumToMinusFourPiInsideAndZeroOutside) {
  const Vec3 v[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  for (const auto& [x, expected] :
       {std::pair{Vec3{0.1, 0.2, 0.15}, -4 * std::numbers::pi}, {Vec3{0.7, 0.9, 0.3}, 0.0}}) {
    Real sum = 0;
    for (const auto& face : faces) {
      PanelValues values;
      integrate_panel(make_panel(v[face[0]], v[face[1]], v[face[2]]), x, Side::kAway, values);
      sum += values.solid_angle;
    }
    EXPECT_NEAR(sum, expected, 1e-13);
  }
}

}  // namespace
}  // namespace sherd
