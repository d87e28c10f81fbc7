// Axisymmetric solutions of Navier's equation without body force, built from the solid harmonics phi_n of degree n
// about the z axis: grad phi_n and r^2 grad phi_n + alpha_n x phi_n (Love 1927, article 172). Sums of them, fitted to
// tractions on concentric spheres, are the exact solutions of the spherical cases.
#pragma once
#include <functional>
#include <vector>

#include "kernels/core/symmetric.h"
#include "kernels/fundamental/elastic.h"

namespace sherd::exact {

// r^l P_l(z / r), or r^(-l-1) P_l(z / r) when decaying; order l in {0, 2, 4}.
struct SolidHarmonic {
  int order = 0;
  bool decaying = false;
  int degree() const { return decaying ? -order - 1 : order; }
};

struct HarmonicValue {
  Real value = 0;
  Vec3 gradient;
  Mat3 hessian;
};
HarmonicValue evaluate(const SolidHarmonic& harmonic, const Vec3& x);

enum class NavierType { kGradient, kLove };  // grad phi, or r^2 grad phi + alpha x phi

// coefficient * field; the unit of the coefficient is whatever makes the sum a displacement in m.
struct NavierField {
  NavierType type = NavierType::kGradient;
  SolidHarmonic harmonic;
  Real coefficient = 1;
};
Vec3 displacement(const NavierField& field, const Elastic& material, const Vec3& x);  // m
Sym3 stress(const NavierField& field, const Elastic& material, const Vec3& x);        // Pa

// One sphere about the origin and the traction wanted on it, for the normal x / |x|.
struct SphereTraction {
  Real radius = 1;                            // m
  std::function<Vec3(const Vec3&)> traction;  // Pa, axisymmetric about z
};

// Sets the coefficients so that `base` plus the fields has the tractions of `spheres` (least squares over latitudes;
// the fit is exact when the tractions lie in the fields' span). Returns the largest traction left over relative to the
// largest wanted or of `base`.
Real fit_tractions(std::vector<NavierField>& fields, const Elastic& material,
                   const std::function<Sym3(const Vec3&)>& base, const std::vector<SphereTraction>& spheres);

}  // namespace sherd::exact
