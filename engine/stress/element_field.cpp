#include "engine/stress/element_field.h"

#include <numbers>

#include "kernels/fundamental/kelvin.h"
#include "kernels/fundamental/laplace.h"
#include "kernels/quadrature/gauss.h"

namespace sherd {
namespace {

Vec3 evaluate(const ElementField::Quadratic& q, Real s, Real t) {
  return q[0] + q[1] * s + q[2] * t + q[3] * (s * s) + q[4] * (s * t) + q[5] * (t * t);
}

// (1/4 pi) { M u A,k + (A,l n_l) G - n_k A,l G_il } of one monomial or point, A,k the gradient of 1/l.
Mat3 laplace_part(const Vec3& guenter, const Mat3& gradient, const Vec3& inverse, const Vec3& n) {
  return (outer(guenter, inverse) + gradient * dot(inverse, n) - outer(gradient * inverse, n)) *
         (1 / (4 * std::numbers::pi));
}

Vec3 position(const PanelFrame& f, const TrianglePoint& p) {
  return f.vertex[0] * p.a + f.vertex[1] * p.b + f.vertex[2] * p.c;
}

Mat3 point_gradient(const Vec3& r, const ElementField::Source& s, const Vec3& n, const Elastic& m) {
  return kelvin::gradient(r, s.density, m) +
         laplace_part(s.guenter, s.gradient, laplace::single_layer_gradient(r) * (4 * std::numbers::pi), n);
}

}  // namespace

ElementField::ElementField(const PanelFrame& panel, const std::array<Vec3, cubic::kNodes>& u, const Quadratic& traction,
                           const Elastic& material)
    : traction_(traction) {
  for (std::size_t a = 0; a < cubic::kNodes; ++a) {
    const auto s = cubic::derivative(cubic::kShape[a], 0), t = cubic::derivative(cubic::kShape[a], 1);
    for (std::size_t m = 0; m < kQuadraticMonomials; ++m) u_s_[m] += u[a] * s[m], u_t_[m] += u[a] * t[m];
  }
  constexpr int exponent[kQuadraticMonomials][2] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}};
  for (int q = 0; q < 3; ++q) {
    // Mean of a monomial times 2 lambda_q - 1/3, the linear function that is 1 at point q and 0 at the others.
    Vec3 us, ut, t;
    for (std::size_t m = 0; m < kQuadraticMonomials; ++m) {
      const int i = exponent[m][0], j = exponent[m][1];
      const Real one = cubic::mean_monomial(i, j), ms = cubic::mean_monomial(i + 1, j),
                 mt = cubic::mean_monomial(i, j + 1);
      const Real w = panel.area * (2 * (q == 0 ? one - ms - mt : (q == 1 ? ms : mt)) - one / 3);
      us += u_s_[m] * w, ut += u_t_[m] * w, t += traction_[m] * w;
    }
    far_[static_cast<std::size_t>(q)] = source(panel, us, ut, t, material.mu);
  }
}

ElementField::Source ElementField::source(const PanelFrame& panel, const Vec3& us, const Vec3& ut, const Vec3& traction,
                                          Real mu) const {
  Source out;
  const Vec3 gs = panel.shape_gradient(1), gt = panel.shape_gradient(2), n = panel.normal;
  out.gradient = outer(us, gs) + outer(ut, gt);
  out.guenter = transpose(out.gradient) * n - n * trace(out.gradient);  // (M u)_i = n_j d_i u_j - n_i d_j u_j
  out.density = traction - out.guenter * (2 * mu);
  return out;
}

Mat3 ElementField::surface_gradient(const PanelFrame& panel, Real s, Real t) const {
  return outer(evaluate(u_s_, s, t), panel.shape_gradient(1)) + outer(evaluate(u_t_, s, t), panel.shape_gradient(2));
}

Vec3 ElementField::traction_at(Real s, Real t) const {
  return evaluate(traction_, s, t);
}

Mat3 ElementField::closed_form(const PanelFrame& panel, const Vec3& x, const Elastic& m, Side side) const {
  PanelMomentGradients p;
  integrate_panel_moment_gradients(panel, x, side, p);
  Mat3 g;
  for (std::size_t i = 0; i < kQuadraticMonomials; ++i) {
    const Source s = source(panel, u_s_[i], u_t_[i], traction_[i], m.mu);
    for (int k = 0; k < 3; ++k) {
      const Vec3 column = (s.density * ((3 - 4 * m.nu) * p.inverse[i][k]) + p.dyad[k][i] * s.density) * m.kelvin();
      for (int j = 0; j < 3; ++j) g[j][k] += column[j];
    }
    g += laplace_part(s.guenter, s.gradient, p.inverse[i], panel.normal);
  }
  return g;
}

Mat3 ElementField::seven_points(const PanelFrame& panel, const Vec3& x, const Elastic& m) const {
  Mat3 g;
  for (const TrianglePoint& p : kGauss7) {
    const Real w = p.weight * panel.area;
    g += point_gradient(x - position(panel, p),
                        source(panel, evaluate(u_s_, p.b, p.c) * w, evaluate(u_t_, p.b, p.c) * w,
                               evaluate(traction_, p.b, p.c) * w, m.mu),
                        panel.normal, m);
  }
  return g;
}

Mat3 ElementField::three_points(const PanelFrame& panel, const Vec3& x, const Elastic& m, Real least) const {
  Mat3 g;
  for (std::size_t q = 0; q < 3; ++q) {
    const Vec3 r = x - position(panel, kGauss3[q]);
    if (norm2(r) > least) g += point_gradient(r, far_[q], panel.normal, m);
  }
  return g;
}

}  // namespace sherd
