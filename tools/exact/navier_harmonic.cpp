#include "tools/exact/navier_harmonic.h"

#include <Eigen/Dense>
#include <algorithm>
#include <numbers>

#include "kernels/core/error.h"

namespace sherd::exact {
namespace {

// Growing harmonics as polynomials in s = x^2 + y^2 and z.
HarmonicValue growing(int order, const Vec3& x) {
  const Real s = x.x * x.x + x.y * x.y, z = x.z;
  Real f = 0, fs = 0, fz = 0, fss = 0, fsz = 0, fzz = 0;
  if (order == 0) {
    f = 1;
  } else if (order == 2) {
    f = z * z - 0.5 * s, fs = -0.5, fz = 2 * z, fzz = 2;
  } else {
    SHERD_CHECK(order == 4, "solid harmonic of order {}", order);
    f = z * z * z * z - 3 * z * z * s + 0.375 * s * s;
    fs = -3 * z * z + 0.75 * s, fz = 4 * z * z * z - 6 * z * s;
    fss = 0.75, fsz = -6 * z, fzz = 12 * z * z - 6 * s;
  }
  HarmonicValue v;
  v.value = f;
  v.gradient = {2 * x.x * fs, 2 * x.y * fs, fz};
  v.hessian[0][0] = 2 * fs + 4 * x.x * x.x * fss, v.hessian[1][1] = 2 * fs + 4 * x.y * x.y * fss;
  v.hessian[0][1] = v.hessian[1][0] = 4 * x.x * x.y * fss;
  v.hessian[0][2] = v.hessian[2][0] = 2 * x.x * fsz, v.hessian[1][2] = v.hessian[2][1] = 2 * x.y * fsz;
  v.hessian[2][2] = fzz;
  return v;
}

// Love's constant of r^2 grad phi_n + alpha_n x phi_n.
Real love_alpha(int n, const Elastic& m) {
  const Real l = m.lambda(), k = n;
  return -2 * (k * l + (3 * k + 1) * m.mu) / ((k + 3) * l + (k + 5) * m.mu);
}

Mat3 gradient(const NavierField& f, const Elastic& m, const Vec3& x) {
  const HarmonicValue h = evaluate(f.harmonic, x);
  if (f.type == NavierType::kGradient) return h.hessian * f.coefficient;
  const Real alpha = love_alpha(f.harmonic.degree(), m);
  const Mat3 g = outer(h.gradient, x) * 2.0 + h.hessian * norm2(x) + Mat3::identity() * (alpha * h.value) +
                 outer(x, h.gradient) * alpha;
  return g * f.coefficient;
}

}  // namespace

HarmonicValue evaluate(const SolidHarmonic& harmonic, const Vec3& x) {
  const HarmonicValue p = growing(harmonic.order, x);
  if (!harmonic.decaying) return p;
  // Kelvin transform: p r^-k with k = 2 l + 1.
  const Real k = 2 * harmonic.order + 1, r2 = norm2(x), g = std::pow(r2, -0.5 * k);
  HarmonicValue v;
  v.value = p.value * g;
  const Vec3 dg = x * (-k * g / r2);
  v.gradient = p.gradient * g + dg * p.value;
  const Mat3 ddg = (Mat3::identity() + outer(x, x) * (-(k + 2) / r2)) * (-k * g / r2);
  v.hessian = p.hessian * g + outer(p.gradient, dg) + outer(dg, p.gradient) + ddg * p.value;
  return v;
}

Vec3 displacement(const NavierField& f, const Elastic& m, const Vec3& x) {
  const HarmonicValue h = evaluate(f.harmonic, x);
  if (f.type == NavierType::kGradient) return h.gradient * f.coefficient;
  return (h.gradient * norm2(x) + x * (love_alpha(f.harmonic.degree(), m) * h.value)) * f.coefficient;
}

Sym3 stress(const NavierField& f, const Elastic& m, const Vec3& x) {
  const Mat3 g = gradient(f, m, x);
  const Real pressure = m.lambda() * trace(g);
  return symmetric_part(g) * (2 * m.mu) + Sym3{pressure, pressure, pressure, 0, 0, 0};
}

Real fit_tractions(std::vector<NavierField>& fields, const Elastic& material,
                   const std::function<Sym3(const Vec3&)>& base, const std::vector<SphereTraction>& spheres) {
  constexpr int kLatitudes = 9;
  const auto rows = static_cast<Eigen::Index>(2 * kLatitudes * spheres.size());
  Eigen::MatrixXd a(rows, static_cast<Eigen::Index>(fields.size()));
  Eigen::VectorXd b(rows);
  for (NavierField& f : fields) f.coefficient = 1;
  Eigen::Index row = 0;
  Real scale = 0;
  for (const SphereTraction& s : spheres)
    for (int i = 0; i < kLatitudes; ++i, row += 2) {
      const Real angle = std::numbers::pi * (i + 0.5) / kLatitudes;
      const Vec3 n{std::sin(angle), 0, std::cos(angle)}, south{std::cos(angle), 0, -std::sin(angle)}, x = n * s.radius;
      const Vec3 wanted = s.traction(x), given = base(x) * n;
      scale = std::max({scale, norm(wanted), norm(given)});
      b[row] = dot(wanted - given, n), b[row + 1] = dot(wanted - given, south);
      for (std::size_t j = 0; j < fields.size(); ++j) {
        const Vec3 t = stress(fields[j], material, x) * n;
        a(row, static_cast<Eigen::Index>(j)) = dot(t, n), a(row + 1, static_cast<Eigen::Index>(j)) = dot(t, south);
      }
    }
  const Eigen::VectorXd norms = a.colwise().norm();
  const Eigen::MatrixXd scaled = a * norms.cwiseInverse().asDiagonal();
  const Eigen::VectorXd c = norms.cwiseInverse().asDiagonal() * scaled.colPivHouseholderQr().solve(b);
  for (std::size_t j = 0; j < fields.size(); ++j) fields[j].coefficient = c[static_cast<Eigen::Index>(j)];
  return (a * c - b).cwiseAbs().maxCoeff() / scale;
}

}  // namespace sherd::exact
