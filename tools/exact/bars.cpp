#include <algorithm>
#include <numbers>

#include "kernels/core/error.h"
#include "tools/exact/case.h"
#include "tools/exact/meshes.h"

namespace sherd::exact {
namespace {

const Elastic kMaterial{1.0, 0.3};
constexpr Real kJitter = 0.2;
const Real kYoung = 2 * kMaterial.mu * (1 + kMaterial.nu);

// Saint-Venant's warping of the square |x|, |y| <= 1/2 at unit twist and its derivatives (Timoshenko and Goodier,
// article 109): phi = x y - (32 a^2 / pi^3) sum (-1)^n sin(k x) sinh(k y) / ((2n+1)^3 cosh(k a)), k = (2n+1) pi / (2a).
// The series needs |y| < a; where |y| > |x| the antisymmetry phi(x, y) = -phi(y, x) takes over, so it converges like
// exp(-k (a - min(|x|, |y|))) and slowly at the four corners alone, where both shear stresses vanish.
struct Warping {
  Real value, dx, dy;
};
Warping warping(Real x, Real y) {
  constexpr Real kHalf = 0.5, kPi = std::numbers::pi;
  constexpr int kTerms = 300;
  if (std::abs(y) > std::abs(x)) {
    const Warping w = warping(y, x);
    return {-w.value, -w.dy, -w.dx};
  }
  if (std::abs(y) >= kHalf * (1 - 1e-12)) return {0, y, -x};
  Warping w{x * y, y, x};
  for (int n = 0; n < kTerms; ++n) {
    const Real odd = 2 * n + 1, k = odd * kPi / (2 * kHalf);
    const Real grow = std::exp(k * (y - kHalf)), fall = std::exp(-k * (y + kHalf)),
               below = 1 + std::exp(-2 * k * kHalf);
    const Real sinh = (grow - fall) / below, cosh = (grow + fall) / below;  // over cosh(k a)
    const Real c = (n % 2 == 0 ? 1 : -1) * 32 * kHalf * kHalf / (kPi * kPi * kPi * odd * odd * odd);
    w.value -= c * std::sin(k * x) * sinh;
    w.dx -= c * k * std::cos(k * x) * sinh, w.dy -= c * k * std::sin(k * x) * cosh;
  }
  return w;
}

}  // namespace

ExactCase stretched_cube(int n) {
  ExactCase c;
  c.name = "stretched cube", c.load = "exact tractions: 1 on the faces z = +-1/2";
  c.material = kMaterial;
  c.mesh = jittered_box({1, 1, 1}, n, kJitter);
  c.displacement = [](const Vec3& x) { return Vec3{-kMaterial.nu * x.x, -kMaterial.nu * x.y, x.z} / kYoung; };
  c.stress = [](const Vec3&) { return Sym3{0, 0, 1, 0, 0, 0}; };
  c.traction = [](const Vec3&, const Vec3& n_) { return Vec3{0, 0, n_.z}; };
  return c;
}

ExactCase square_torsion(int n) {
  ExactCase c;
  c.name = "square torsion", c.load = "exact tractions on the ends, sides free";
  c.material = kMaterial;
  c.mesh = jittered_box({1, 1, 2}, n, kJitter);
  c.displacement = [](const Vec3& x) { return Vec3{-x.y * x.z, x.x * x.z, warping(x.x, x.y).value}; };
  c.stress = [](const Vec3& x) {
    const Warping w = warping(x.x, x.y);
    return Sym3{0, 0, 0, kMaterial.mu * (w.dy + x.x), kMaterial.mu * (w.dx - x.y), 0};
  };
  c.traction = [sigma = c.stress](const Vec3& x, const Vec3& m) { return std::abs(m.z) > 0.5 ? sigma(x) * m : Vec3{}; };
  c.peak = norm(c.stress({0.5, 0, 0}) * Vec3{0, 0, 1});  // at the middle of a side
  return c;
}

ExactCase circular_torsion(int m, int layers) {
  ExactCase c;
  c.name = "circular torsion", c.load = "exact tractions on the ends; practical: side facets free";
  c.material = kMaterial;
  c.mesh = structured_cylinder(1, 3, m, layers);
  c.displacement = [](const Vec3& x) { return Vec3{-x.y * x.z, x.x * x.z, 0}; };
  c.stress = [](const Vec3& x) { return Sym3{0, 0, 0, kMaterial.mu * x.x, -kMaterial.mu * x.y, 0}; };
  c.traction = [sigma = c.stress](const Vec3& x, const Vec3& n) { return std::abs(n.z) > 0.5 ? sigma(x) * n : Vec3{}; };
  return c;
}

ExactCase hanging_bar(int n) {
  ExactCase c;
  c.name = "self weight", c.load = "body force (0, -1, 0), exact tractions: 3 at the top, the rest free";
  c.material = kMaterial;
  c.mesh = jittered_box({1, 3, 1}, n, kJitter);
  c.body_force.constant = {0, -1, 0};
  c.displacement = [](const Vec3& x) {
    const Real y = x.y + 1.5, nu = kMaterial.nu;
    return Vec3{-nu * y * x.x, 0.5 * (y * y + nu * (x.x * x.x + x.z * x.z)), -nu * y * x.z} / kYoung;
  };
  c.stress = [](const Vec3& x) { return Sym3{0, x.y + 1.5, 0, 0, 0, 0}; };
  c.traction = [](const Vec3&, const Vec3& m) { return Vec3{0, m.y > 0.5 ? 3.0 : 0.0, 0}; };
  c.peak = 3;
  return c;
}

ExactCase harmonic_plate(int k, Real thickness, Real q) {
  ExactCase c;
  c.name = fmt::format("plate q={:g} T={:g}", q, thickness), c.load = "exact tractions on the rim, faces free";
  c.material = kMaterial;
  c.mesh = jittered_box({1, 1, thickness}, k, kJitter);
  // w harmonic: u = (-z w,x, -z w,y, w) has no dilatation and no transverse shear, so it is an exact field in 3D.
  c.displacement = [q](const Vec3& x) {
    return Vec3{x.z * q * std::sin(q * x.x) * std::cosh(q * x.y), -x.z * q * std::cos(q * x.x) * std::sinh(q * x.y),
                std::cos(q * x.x) * std::cosh(q * x.y)};
  };
  c.stress = [q](const Vec3& x) {
    const Real bend = 2 * kMaterial.mu * x.z * q * q;
    const Real xx = bend * std::cos(q * x.x) * std::cosh(q * x.y), xy = bend * std::sin(q * x.x) * std::sinh(q * x.y);
    return Sym3{xx, -xx, 0, 0, 0, xy};
  };
  c.traction = [sigma = c.stress](const Vec3& x, const Vec3& n) { return std::abs(n.z) > 0.5 ? Vec3{} : sigma(x) * n; };
  c.peak = kMaterial.mu * thickness * q * q * std::cosh(0.5 * q);  // at x = 0, y = +-1/2
  c.thickness = thickness;
  return c;
}

}  // namespace sherd::exact
