// Kelvin's fundamental solution of linear elasticity (paper eq. 6): the displacement at x of a unit force at y.
// r = x - y, l = |r|, e = r/l. U_ij = c [(3-4nu) d_ij + e_i e_j] / l with c = 1/(16 pi mu (1-nu)).
#pragma once
#include "kernels/core/symmetric.h"
#include "kernels/fundamental/elastic.h"

namespace sherd::kelvin {

// u_i = U_ij f_j.
SHERD_HD inline Vec3 displacement(const Vec3& r, const Vec3& f, const Elastic& m) {
  const Real inverse = 1 / norm(r), c = m.kelvin() * inverse;
  return f * (c * (3 - 4 * m.nu)) + r * (c * inverse * inverse * dot(r, f));
}

// g[i][k] = U_ij,k f_j; U_ij,k = c/l^2 [-(3-4nu) d_ij e_k + d_ik e_j + d_jk e_i - 3 e_i e_j e_k].
SHERD_HD inline Mat3 gradient(const Vec3& r, const Vec3& f, const Elastic& m) {
  const Real inverse = 1 / norm(r), c = m.kelvin() * inverse * inverse;
  const Vec3 e = r * inverse;
  const Real ef = dot(e, f);
  Mat3 g = outer(f, e) * (-(3 - 4 * m.nu)) + outer(e, f) + outer(e, e) * (-3 * ef);
  for (int i = 0; i < 3; ++i) g[i][i] += ef;
  return g * c;
}

// Hooke's law: stress of a displacement gradient g[i][k] = u_i,k.
SHERD_HD inline Sym3 hooke(const Mat3& g, const Elastic& m) {
  const Sym3 strain = symmetric_part(g);
  const Real pressure = m.lambda() * trace(g);
  Sym3 s = strain * (2 * m.mu);
  s.xx += pressure, s.yy += pressure, s.zz += pressure;
  return s;
}

inline Sym3 stress(const Vec3& r, const Vec3& f, const Elastic& m) {
  return hooke(gradient(r, f, m), m);
}

// Traction on the plane with unit normal n through the target.
inline Vec3 traction(const Vec3& r, const Vec3& f, const Vec3& n, const Elastic& m) {
  return stress(r, f, m) * n;
}

// Newton potential of a constant body force b as a surface integral: u_i = closed integral of W_ijk b_j n_k dS, with
// e = (y - x)/l, solves div sigma + b = 0. W_ijk = e_k d_ij/(8 pi mu) - alpha/(32 pi mu) chi_ijk,
// chi_ijk = d_ij e_k + d_ik e_j + d_jk e_i - e_i e_j e_k (the paper prints the last term with a plus sign, which
// violates div_k W_ijk = U_ij by 30 %), alpha = 1/(2(1-nu)).
SHERD_HD inline Vec3 newton(const Vec3& e, const Vec3& b, const Vec3& n, const Elastic& m) {
  const Real a = 1 / (8 * std::numbers::pi * m.mu), alpha = 1 / (2 * (1 - m.nu));
  const Real en = dot(e, n), eb = dot(e, b), bn = dot(b, n);
  return b * (a * en) - (b * en + n * eb + e * bn - e * (eb * en)) * (0.25 * alpha * a);
}

}  // namespace sherd::kelvin
