// The solved homogeneous problem on one triangle: cubic displacement and quadratic traction, and what they contribute
// to the displacement gradient elsewhere (Somigliana's identity differentiated; design notes, elastostatics section 1).
#pragma once
#include "engine/elastostatic/boundary.h"
#include "kernels/fundamental/elastic.h"
#include "kernels/quadrature/cubic.h"

namespace sherd {

class ElementField {
 public:
  // What a point of the panel sends out: density of the Kelvin layer t - 2 mu M u, M u, the surface gradient.
  struct Source {
    Vec3 density, guenter;
    Mat3 gradient;
  };
  using Quadratic = std::array<Vec3, kQuadraticMonomials>;  // coefficients of the monomials of moments.h

  ElementField() = default;
  // displacement: at the ten nodes (cubic.h), m; traction: Pa.
  ElementField(const PanelFrame& panel, const std::array<Vec3, cubic::kNodes>& displacement, const Quadratic& traction,
               const Elastic& material);

  // [i][k] = u_i,k along the surface at (s, t); its product with the normal is zero.
  Mat3 surface_gradient(const PanelFrame& panel, Real s, Real t) const;
  Vec3 traction_at(Real s, Real t) const;
  // At kGauss3, times area: exact against kernels that are linear over the panel.
  const std::array<Source, 3>& far() const { return far_; }
  // Contribution to u_i,k(x) in closed form, by seven points and by the three points of far(), of which those whose
  // squared distance is not above `least` are left out.
  Mat3 closed_form(const PanelFrame& panel, const Vec3& x, const Elastic& material, Side side) const;
  Mat3 seven_points(const PanelFrame& panel, const Vec3& x, const Elastic& material) const;
  Mat3 three_points(const PanelFrame& panel, const Vec3& x, const Elastic& material, Real least) const;

  Source source(const PanelFrame& panel, const Vec3& us, const Vec3& ut, const Vec3& traction, Real mu) const;
  Quadratic u_s_, u_t_, traction_;  // derivatives of u along s and t, m; Pa
  std::array<Source, 3> far_;
};

}  // namespace sherd
