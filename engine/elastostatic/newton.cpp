#include "engine/elastostatic/newton.h"

#include <numbers>

#include "kernels/fundamental/kelvin.h"
#include "kernels/quadrature/gauss.h"
#include "kernels/quadrature/moments.h"

namespace sherd {
namespace {

Vec3 at(const PanelFrame& f, const TrianglePoint& p) {
  return f.vertex[0] * p.a + f.vertex[1] * p.b + f.vertex[2] * p.c;
}

// Integral of (y - x)/l over the panel, m^2.
template <std::size_t N>
Vec3 gauss_direction(const PanelFrame& f, const Vec3& x, const std::array<TrianglePoint, N>& rule) {
  Vec3 sum;
  for (const TrianglePoint& p : rule) sum += normalized(at(f, p) - x) * (p.weight * f.area);
  return sum;
}
Vec3 direction_integral(const PanelFrame& f, const Vec3& x, Real d2, Real near2, Real middle2) {
  if (d2 > middle2) return gauss_direction(f, x, kGauss3);
  if (d2 > near2) return gauss_direction(f, x, kGauss7);
  PanelMoments moments;
  integrate_panel_moments(f, x, Side::kAway, moments);
  const Vec3 e1 = f.vertex[1] - f.vertex[0], e2 = f.vertex[2] - f.vertex[0];
  return (f.vertex[0] - x) * moments.inverse[0] + e1 * moments.inverse[1] + e2 * moments.inverse[2];
}

// H = integral of (I - e e^T)/l over the panel, m: minus the x-derivative of the integral above.
template <std::size_t N>
Mat3 gauss_hessian(const PanelFrame& f, const Vec3& x, const std::array<TrianglePoint, N>& rule) {
  Mat3 sum;
  for (const TrianglePoint& p : rule) {
    const Vec3 r = x - at(f, p);
    const Real inverse = 1 / norm(r), w = p.weight * f.area * inverse;
    sum += Mat3::identity() * w - outer(r, r) * (w * inverse * inverse);
  }
  return sum;
}
Mat3 hessian_integral(const PanelFrame& f, const Vec3& x, Real d2, Real near2, Real middle2) {
  if (d2 > middle2) return gauss_hessian(f, x, kGauss3);
  if (d2 > near2) return gauss_hessian(f, x, kGauss7);
  PanelValues v;
  integrate_panel(f, x, Side::kAway, v);
  return Mat3::identity() * v.inverse - v.dyad;
}

// b0 is the Newton potential's part.
BodyForce without_constant(const BodyForce& force) {
  return {{}, force.linear, force.origin};
}

}  // namespace

Vec3 newton_kernel(const Vec3& e, const Vec3& b, const Vec3& n, const Elastic& m) {
  const Real a = 1 / (8 * std::numbers::pi * m.mu), alpha = 1 / (2 * (1 - m.nu));
  return (b * dot(e, n) - e * (alpha * dot(b, n))) * a;
}

Vec3 NewtonPotential::displacement(const Vec3& x) const {
  Vec3 u;
  const Boundary& b = *boundary_;
  for (std::size_t t = 0; t < b.panels.size(); ++t) {
    const PanelFrame& f = b.panels[t];
    const Vec3 e = direction_integral(f, x, distance2(x, b.centroid[t]), b.near2[t], b.middle2[t]);
    u += newton_kernel(e, force_, f.normal, material_);  // linear in e
  }
  return u;
}

Mat3 NewtonPotential::gradient(const Vec3& x) const {
  const Real alpha = 1 / (2 * (1 - material_.nu));
  Mat3 g;
  const Boundary& b = *boundary_;
  for (std::size_t t = 0; t < b.panels.size(); ++t) {
    const PanelFrame& f = b.panels[t];
    const Mat3 h = hessian_integral(f, x, distance2(x, b.centroid[t]), b.near2[t], b.middle2[t]);
    g += outer(force_, h * f.normal) - h * (alpha * dot(force_, f.normal));
  }
  return g * (-1 / (8 * std::numbers::pi * material_.mu));
}

Sym3 NewtonPotential::stress(const Vec3& x) const {
  return kelvin::hooke(gradient(x), material_);
}

BodyForceField::BodyForceField(const Boundary& boundary, const BodyForce& force, const ParticularSolution& polynomial,
                               BodyForcePotential potential, const Elastic& material)
    : polynomial_(potential == BodyForcePotential::kNewton ? ParticularSolution(without_constant(force), material)
                                                           : polynomial) {
  if (potential == BodyForcePotential::kNewton && norm2(force.constant) > 0)
    newton_.emplace(boundary, force.constant, material);
}

Sym3 BodyForceField::stress(const Vec3& x) const {
  return newton_ ? polynomial_.stress(x) + newton_->stress(x) : polynomial_.stress(x);
}

}  // namespace sherd
