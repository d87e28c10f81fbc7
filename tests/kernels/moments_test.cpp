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

// Largest difference over the largest entry, for each of the arrays.
struct Difference {
  Real inverse = 0, dyad = 0, angle = 0;
  Real largest() const { return std::max({inverse, dyad, angle}); }
};
struct Worst {
  Real difference = 0, entry = 0;
  void add(Real value, reference::Wide expected) {
    difference = std::max(difference, static_cast<Real>(std::abs(value - expected)));
    entry = std::max(entry, static_cast<Real>(std::abs(expected)));
    if (!std::isfinite(value)) difference = INFINITY;
  }
  Real relative() const { return difference / entry; }
};

Difference compare_values(const PanelFrame& f, const Vec3& x) {
  const reference::Integrator integrator(f, x, false);
  const reference::Moments& r = integrator.result();
  PanelMoments v;
  integrate_panel_moments(f, x, Side::kAway, v);
  Worst inverse, dyad, angle;
  for (int m = 0; m < kQuadraticMonomials; ++m) {
    inverse.add(v.inverse[m], r.inverse[m]);
    for (int i = 0; i < 6; ++i) dyad.add(components(v.dyad[m])[i], r.dyad[m][i]);
  }
  for (int m = 0; m < kCubicMonomials; ++m) angle.add(v.angle[m], r.angle[m]);
  if (angle.entry == 0) angle.entry = 1;
  return {inverse.relative(), dyad.relative(), angle.relative()};
}

// In the plane z = 0 with vertices and edges at round numbers, so that targets near them are exact.
std::vector<PanelFrame> panels() {
  std::vector<PanelFrame> all;
  for (const Real h : {0.875, 0.1}) {
    all.push_back(make_panel({0, 0, 0}, {1, 0, 0}, {0.5, h, 0}));
    all.push_back(make_panel({1, 0, 0}, {0.125, h, 0}, {0, 0, 0}));
    all.push_back(make_panel({0, h, 0}, {0, 0, 0}, {1, 0, 0}));  // one short edge
  }
  return all;
}

// Above corners, edges, the inside and edge extensions, `d` off the plane; beside edges in the plane.
std::vector<Vec3> targets_near(const PanelFrame& f, Real d) {
  std::vector<Vec3> x;
  const Vec3 up{0, 0, d};
  for (int e = 0; e < 3; ++e) {
    x.push_back(f.vertex[e] + up);
    x.push_back(f.vertex[e] - up);
    x.push_back(f.vertex[e] + Vec3{d, 0, 0});
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

// Rounding grows by distance over altitude to the fourth at most (degree 3, and the height): 8^4 * 2e-16 = 1e-12.
TEST(PanelMoments, ValuesAgreeWithAdaptiveQuadrature) {
  for (const PanelFrame& f : panels())
    for (const Real d : {1e-3, 0.5})
      for (const Vec3& x : targets_near(f, d)) {
        const Difference c = compare_values(f, x);
        EXPECT_LT(c.largest(), 1e-11) << c.inverse << ' ' << c.dyad << ' ' << c.angle << " altitude " << 2 * f.area
                                      << " target " << x.x << ' ' << x.y << ' ' << x.z;
      }
}

}  // namespace
}  // namespace sherd
