// Symmetric second-order tensors (stress, strain) in Voigt order xx, yy, zz, yz, xz, xy, and their eigensystem.
#pragma once
#include "kernels/core/vec3.h"

namespace sherd {

struct Sym3 {
  Real xx{}, yy{}, zz{}, yz{}, xz{}, xy{};

  Sym3& operator+=(const Sym3& b) {
    xx += b.xx, yy += b.yy, zz += b.zz, yz += b.yz, xz += b.xz, xy += b.xy;
    return *this;
  }
  Sym3& operator*=(Real s) {
    xx *= s, yy *= s, zz *= s, yz *= s, xz *= s, xy *= s;
    return *this;
  }
  friend Sym3 operator+(Sym3 a, const Sym3& b) { return a += b; }
  friend Sym3 operator-(const Sym3& a, const Sym3& b) { return a + b * -1.0; }
  friend Sym3 operator*(Sym3 a, Real s) { return a *= s; }
  friend Sym3 operator*(Real s, Sym3 a) { return a *= s; }
  friend Vec3 operator*(const Sym3& a, const Vec3& v) {
    return {a.xx * v.x + a.xy * v.y + a.xz * v.z, a.xy * v.x + a.yy * v.y + a.yz * v.z,
            a.xz * v.x + a.yz * v.y + a.zz * v.z};
  }
  friend bool operator==(const Sym3&, const Sym3&) = default;
};

inline Mat3 to_matrix(const Sym3& s) {
  Mat3 m;
  m[0][0] = s.xx, m[1][1] = s.yy, m[2][2] = s.zz;
  m[1][2] = m[2][1] = s.yz, m[0][2] = m[2][0] = s.xz, m[0][1] = m[1][0] = s.xy;
  return m;
}
// Symmetric part of m.
inline Sym3 symmetric_part(const Mat3& m) {
  return {m[0][0], m[1][1], m[2][2], 0.5 * (m[1][2] + m[2][1]), 0.5 * (m[0][2] + m[2][0]), 0.5 * (m[0][1] + m[1][0])};
}

struct Eigen3 {
  Real value[3];   // descending
  Vec3 vector[3];  // orthonormal, right-handed
};
// Cyclic Jacobi: exact to rounding for any finite input, deterministic, no branch on near-equal eigenvalues.
Eigen3 eigen_symmetric(const Sym3& s);

}  // namespace sherd
