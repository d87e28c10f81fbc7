// The solved homogeneous problem on one triangle: cubic displacement and quadratic traction, and what they contribute
// to the displacement gradient elsewhere (Somigliana's identity differentiated; design notes, elastostatics section 1).
#pragma once
#include "engine/elastostatic/boundary.h"
#include "kernels/fundamental/elastic.h"
#include "kernels/quadrature/cubic.h"

namespace sherd {

class ElementField {
 public:
  using Quadratic = std::array<Vec3, kQuadraticMonomials>;  // coefficients of the monomials of moments.h

  ElementField() = default;
  // displacement: at the ten nodes (cubic.h), m; traction: Pa.
  ElementField(const PanelFrame& panel, const std::array<Vec3, cubic::kNodes>& displacement, const Quadratic& traction,
               const Elastic& material);

  // [i][k] = u_i,k along the surface at (s, t); its product with the normal is zero.
  Mat3 surface_gradient(const PanelFrame& panel, Real s, Real t) const;
  Vec3 traction_at(Real s, Real t) const;
  // Contribution to u_i,k(x), x off the panel: closed form within `near` of the centroid, seven points within `middle`,
  // three beyond (metres).
  Mat3 gradient_at(const PanelFrame& panel, const Vec3& x, const Elastic& material, Real near, Real middle,
                   Side side = Side::kAway) const;

 private:
  // What a point of the panel sends out: density of the Kelvin layer t - 2 mu M u, M u, the surface gradient.
  struct Source {
    Vec3 density, guenter;
    Mat3 gradient;
  };
  Source source(const PanelFrame& panel, const Vec3& us, const Vec3& ut, const Vec3& traction, Real mu) const;
  Mat3 closed_form(const PanelFrame& panel, const Vec3& x, const Elastic& material, Side side) const;

  Quadratic u_s_, u_t_, traction_;  // derivatives of u along s and t, m; Pa
  std::array<Source, 3> far_;       // at kGauss3, times area: exact against kernels linear over the panel
};

}  // namespace sherd
