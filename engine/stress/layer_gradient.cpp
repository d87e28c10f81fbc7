#include "engine/stress/layer_gradient.h"

#include <numbers>

#include "kernels/fundamental/kelvin.h"
#include "kernels/fundamental/laplace.h"
#include "kernels/quadrature/gauss.h"

namespace sherd {
namespace {

template <std::size_t N>
LayerGradient gauss(const PanelFrame& f, const Vec3& x, const Vec3& q, const std::array<TrianglePoint, N>& rule,
                    const Elastic& m) {
  LayerGradient g;
  for (const TrianglePoint& p : rule) {
    const Vec3 r = x - (f.vertex[0] * p.a + f.vertex[1] * p.b + f.vertex[2] * p.c);
    const Real w = p.weight * f.area;
    g.kelvin += kelvin::gradient(r, q * w, m);
    g.inverse += laplace::single_layer_gradient(r) * (4 * std::numbers::pi * w);
  }
  return g;
}

LayerGradient closed_form(const PanelFrame& f, const Vec3& x, const Vec3& q, const Elastic& m, Side side) {
  PanelGradients p;
  integrate_panel_gradient(f, x, side, p);
  LayerGradient g;
  g.inverse = p.inverse;
  for (int k = 0; k < 3; ++k) {
    const Vec3 column = (q * ((3 - 4 * m.nu) * p.inverse[k]) + p.dyad[k] * q) * m.kelvin();
    for (int i = 0; i < 3; ++i) g.kelvin[i][k] = column[i];
  }
  return g;
}

}  // namespace

LayerGradient layer_gradient(const PanelFrame& f, const Vec3& x, const Vec3& q, const Elastic& m,
                             const QuadratureOptions& o, Side side) {
  const Real d2 = distance2(x, f.centroid()) / f.longest2;
  if (side == Side::kAway && d2 > o.gauss7 * o.gauss7) return gauss(f, x, q, kGauss3, m);
  if (side == Side::kAway && d2 > o.closed_form * o.closed_form) return gauss(f, x, q, kGauss7, m);
  return closed_form(f, x, q, m, side);
}

}  // namespace sherd
