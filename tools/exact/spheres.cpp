#include <algorithm>
#include <numbers>

#include "kernels/core/error.h"
#include "tools/exact/case.h"
#include "tools/exact/meshes.h"
#include "tools/exact/navier_harmonic.h"

namespace sherd::exact {
namespace {

const Elastic kMaterial{1.0, 0.3};
constexpr NavierType kGradient = NavierType::kGradient, kLove = NavierType::kLove;

Sym3 no_stress(const Vec3&) {
  return {};
}
Vec3 no_traction(const Vec3&) {
  return {};
}

// Adds the fields to whatever base the case already has.
void add_fields(ExactCase& c, const std::vector<NavierField>& fields) {
  c.displacement = [base = c.displacement, fields, m = c.material](const Vec3& x) {
    Vec3 u = base ? base(x) : Vec3{};
    for (const NavierField& f : fields) u += displacement(f, m, x);
    return u;
  };
  c.stress = [base = c.stress, fields, m = c.material](const Vec3& x) {
    Sym3 s = base ? base(x) : Sym3{};
    for (const NavierField& f : fields) s += stress(f, m, x);
    return s;
  };
}

void fit(ExactCase& c, std::vector<NavierField> fields, const std::vector<SphereTraction>& spheres) {
  const Real left = fit_tractions(fields, c.material, c.stress ? c.stress : no_stress, spheres);
  SHERD_CHECK(left < 1e-10, "{}: tractions of the exact solution are off by {}", c.name, left);
  add_fields(c, fields);
}

// The stress of an axisymmetric field is largest on the surface or at the centre; 400 latitudes find it to 1e-5.
Real largest_principal(const ExactCase& c, std::initializer_list<Real> radii) {
  Real peak = 0;
  for (const Real r : radii)
    for (int i = 0; i <= 400; ++i) {
      const Real a = std::numbers::pi * i / 400;
      const Eigen3 e = eigen_symmetric(c.stress({r * std::sin(a), 0, r * std::cos(a)}));
      peak = std::max({peak, std::abs(e.value[0]), std::abs(e.value[2])});
    }
  return peak;
}

}  // namespace

ExactCase hollow_sphere(int f, Real jitter) {
  constexpr Real kInner = 0.5;
  ExactCase c;
  c.name = "hollow sphere", c.load = "practical: pressure 1 on the inner facets, outer facets free";
  c.material = kMaterial;
  c.mesh = jittered_hollow_sphere(1, kInner, f, jitter);
  // x phi_0 and grad(1/r): Lame's solution.
  fit(c, {{kLove, {0, false}}, {kGradient, {0, true}}},
      {{kInner, [](const Vec3& x) { return normalized(x) * -1.0; }}, {1, no_traction}});
  c.traction = [](const Vec3& x, const Vec3& n) { return norm(x) < 0.75 ? n * -1.0 : Vec3{}; };
  c.nearest_inside = [](const Vec3& x) { return norm(x) < 0.5 ? normalized(x) * 0.5 : x; };
  c.peak = 1;  // the pressure itself; the hoop stress inside is 5/7
  return c;
}

ExactCase cavity(int f, Real outer, Real jitter) {
  ExactCase c;
  c.name = fmt::format("cavity R={:g}", outer);
  c.load = "tension 1 along z: exact tractions on the outer facets, cavity facets free";
  c.material = kMaterial;
  c.mesh = jittered_hollow_sphere(outer, 1, f, jitter);
  const Real young = 2 * kMaterial.mu * (1 + kMaterial.nu);
  c.displacement = [young](const Vec3& x) { return Vec3{-kMaterial.nu * x.x, -kMaterial.nu * x.y, x.z} / young; };
  c.stress = [](const Vec3&) { return Sym3{0, 0, 1, 0, 0, 0}; };
  fit(c, {{kGradient, {0, true}}, {kGradient, {2, true}}, {kLove, {2, true}}}, {{1, no_traction}});
  c.traction = [sigma = c.stress, middle = 0.5 * (1 + outer)](const Vec3& x, const Vec3& n) {
    return norm(x) < middle ? Vec3{} : sigma(x) * n;
  };
  c.nearest_inside = [](const Vec3& x) { return norm(x) < 1 ? normalized(x) : x; };
  c.peak = (27 - 15 * kMaterial.nu) / (2 * (7 - 5 * kMaterial.nu));  // Southwell and Gough 1926
  return c;
}

ExactCase rotating_sphere(int f) {
  ExactCase c;
  c.name = "rotating sphere", c.load = "practical: body force (x, y, 0), all facets free";
  c.material = kMaterial;
  c.mesh = jittered_sphere(1, f, 0, 1);
  c.body_force.linear[0][0] = c.body_force.linear[1][1] = 1;
  // b = grad(r^2/3 - phi_2/3), so u = grad chi with (lambda + 2 mu) laplace chi = phi_2/3 - r^2/3:
  // chi = k (r^2 phi_2 / 42 - r^4 / 60), k = 1/(lambda + 2 mu).
  const Real k = 1 / (kMaterial.lambda() + 2 * kMaterial.mu);
  const SolidHarmonic two{2, false};
  c.displacement = [=](const Vec3& x) {
    const HarmonicValue h = evaluate(two, x);
    const Real r2 = norm2(x);
    return ((x * (2 * h.value) + h.gradient * r2) / 42 - x * (r2 / 15)) * k;
  };
  c.stress = [=](const Vec3& x) {
    const HarmonicValue h = evaluate(two, x);
    const Real r2 = norm2(x);
    const Mat3 a = (Mat3::identity() * h.value + outer(x, h.gradient) + outer(h.gradient, x)) * 2.0 + h.hessian * r2;
    const Mat3 g = (a * (1.0 / 42) + (Mat3::identity() * r2 + outer(x, x) * 2.0) * (-1.0 / 15)) * k;
    const Real pressure = kMaterial.lambda() * trace(g);
    return symmetric_part(g) * (2 * kMaterial.mu) + Sym3{pressure, pressure, pressure, 0, 0, 0};
  };
  fit(c, {{kLove, {0, false}}, {kGradient, {2, false}}, {kLove, {2, false}}}, {{1, no_traction}});
  c.traction = [](const Vec3&, const Vec3&) { return Vec3{}; };
  c.peak = largest_principal(c, {0, 0.25, 0.5, 0.75, 1});
  return c;
}

ExactCase spherical_shell(int f, Real inner) {
  ExactCase c;
  c.name = fmt::format("shell a/b={:g}", inner),
  c.load = "pressure P4(cos theta) inside: exact tractions on all facets";
  c.material = kMaterial;
  c.mesh = jittered_hollow_sphere(1, inner, f, 0);
  const SolidHarmonic grow{4, false}, decay{4, true};
  const auto pressure = [grow](const Vec3& x) {
    const Vec3 n = normalized(x);
    return n * -evaluate(grow, n).value;
  };
  fit(c, {{kGradient, grow}, {kLove, grow}, {kGradient, decay}, {kLove, decay}}, {{inner, pressure}, {1, no_traction}});
  c.traction = [sigma = c.stress](const Vec3& x, const Vec3& n) { return sigma(x) * n; };
  c.nearest_inside = [inner](const Vec3& x) { return norm(x) < inner ? normalized(x) * inner : x; };
  c.peak = largest_principal(c, {inner, 1});
  c.thickness = 1 - inner;
  return c;
}

}  // namespace sherd::exact
