// The paper's way to equilibrate a body force (its eq. 4): the Newton potential u_i(x) = integral of U_ij(x - y) b_j
// over the body, for a constant force turned into an integral over the closed surface. The polynomials of particular.h
// do the same exactly and for free; this one is the reference the paper's results are compared with.
#pragma once
#include <optional>

#include "engine/elastostatic/boundary.h"
#include "engine/elastostatic/particular.h"

namespace sherd {

// u_i = W_ijk b_j n_k dS with W_ijk = [d_ij e_k - alpha d_jk e_i] / (8 pi mu), e = (y - x)/l, alpha = 1/(2 (1 - nu)):
// shorter than kelvin::newton (the paper's eq. 5, corrected) and equal to it up to a divergence-free term, so that both
// have d/dy_k W_ijk = U_ij and give the same potential over a closed surface.
Vec3 newton_kernel(const Vec3& e, const Vec3& b, const Vec3& n, const Elastic& material);

// Potential of the constant force b (N/m^3) filling a closed surface: div sigma + b = 0 inside, div sigma = 0 outside,
// displacement and stress continuous everywhere. O(triangles) a point. Keeps a reference to the boundary.
class NewtonPotential {
 public:
  NewtonPotential(const Boundary& boundary, const Vec3& b, const Elastic& material)
      : boundary_(&boundary), force_(b), material_(material) {}
  Vec3 displacement(const Vec3& x) const;  // m
  Mat3 gradient(const Vec3& x) const;      // [i][k] = u_i,k
  Sym3 stress(const Vec3& x) const;        // Pa

 private:
  const Boundary* boundary_;
  Vec3 force_;
  Elastic material_;
};

enum class BodyForcePotential { kPolynomial, kNewton };

// Stress that balances the body force b0 + B (x - origin) of a load: wholly polynomial, or b0 by the Newton potential
// and the linear rest, which the surface form of that potential does not cover, by the polynomial. Keeps a reference to
// the boundary.
class BodyForceField {
 public:
  // `polynomial`: of the whole force, as used for kPolynomial.
  BodyForceField(const Boundary& boundary, const BodyForce& force, const ParticularSolution& polynomial,
                 BodyForcePotential potential, const Elastic& material);
  Sym3 stress(const Vec3& x) const;  // Pa
  bool zero() const { return polynomial_.zero() && !newton_; }

 private:
  ParticularSolution polynomial_;
  std::optional<NewtonPotential> newton_;
};

}  // namespace sherd
