#include "engine/stress/layer_gradient.h"

#include "kernels/core/symmetric.h"
#include "kernels/quadrature/gauss.h"

namespace sherd {
namespace {

// kelvin::gradient summed over the points of a rule, with the sums that do not depend on the rule's point taken out:
// c [-(3-4nu) q S^T + S q^T + (S.q) I - 3 sum w (e.q) e e^T / l^2], S = sum w e / l^2 = -A,k.
template <std::size_t N>
LayerGradient gauss(const PanelFrame& f, const Vec3& x, const Vec3& q, const std::array<TrianglePoint, N>& rule,
                    const Elastic& m) {
  Vec3 sum;
  Sym3 dyads;
  for (const TrianglePoint& p : rule) {
    const Vec3 r = x - (f.vertex[0] * p.a + f.vertex[1] * p.b + f.vertex[2] * p.c);
    const Real inverse2 = 1 / norm2(r), w = p.weight * f.area * inverse2 * std::sqrt(inverse2);
    const Real d = 3 * w * inverse2 * dot(r, q);
    sum += r * w;
    dyads += Sym3{r.x * r.x, r.y * r.y, r.z * r.z, r.y * r.z, r.x * r.z, r.x * r.y} * d;
  }
  Mat3 g = outer(q, sum) * -(3 - 4 * m.nu) + outer(sum, q) - to_matrix(dyads);
  for (int i = 0; i < 3; ++i) g[i][i] += dot(sum, q);
  return {g * m.kelvin(), -sum};
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
