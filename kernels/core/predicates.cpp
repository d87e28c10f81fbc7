#include "kernels/core/predicates.h"

#include "kernels/core/expansion.h"

namespace sherd {
namespace {

constexpr Real kEps = 0x1p-53;
// Forward error bounds of the two determinants below relative to their permanents (Shewchuk 1997, tables 1 and 3).
constexpr Real kOrient2dBound = (3 + 16 * kEps) * kEps;
constexpr Real kOrient3dBound = (7 + 56 * kEps) * kEps;

int sign_of(Real v) {
  return v > 0 ? 1 : (v < 0 ? -1 : 0);
}

int orient2d_exact(Real ax, Real ay, Real bx, Real by, Real cx, Real cy) {
  const Expansion left = Expansion::difference(bx, ax) * Expansion::difference(cy, ay);
  const Expansion right = Expansion::difference(by, ay) * Expansion::difference(cx, ax);
  return (left - right).sign();
}

}  // namespace

Expansion orient3d_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  Expansion u[3], v[3], w[3];
  for (int k = 0; k < 3; ++k) {
    u[k] = Expansion::difference(b[k], a[k]);
    v[k] = Expansion::difference(c[k], a[k]);
    w[k] = Expansion::difference(d[k], a[k]);
  }
  return (u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] + (u[0] * v[1] - u[1] * v[0]) * w[2];
}

FilteredValue orient3d_value(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const Real u1v2 = u.y * v.z, u2v1 = u.z * v.y, u2v0 = u.z * v.x, u0v2 = u.x * v.z, u0v1 = u.x * v.y, u1v0 = u.y * v.x;
  const Real det = (u1v2 - u2v1) * w.x + (u2v0 - u0v2) * w.y + (u0v1 - u1v0) * w.z;
  const Real permanent = (std::abs(u1v2) + std::abs(u2v1)) * std::abs(w.x) +
                         (std::abs(u2v0) + std::abs(u0v2)) * std::abs(w.y) +
                         (std::abs(u0v1) + std::abs(u1v0)) * std::abs(w.z);
  return {det, kOrient3dBound * permanent};
}

int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const FilteredValue f = orient3d_value(a, b, c, d);
  if (std::abs(f.value) > f.error) return sign_of(f.value);
  return orient3d_exact(a, b, c, d).sign();
}

int orient2d(Real ax, Real ay, Real bx, Real by, Real cx, Real cy) {
  const Real left = (bx - ax) * (cy - ay), right = (by - ay) * (cx - ax);
  const Real det = left - right;
  if (std::abs(det) > kOrient2dBound * (std::abs(left) + std::abs(right))) return sign_of(det);
  return orient2d_exact(ax, ay, bx, by, cx, cy);
}

}  // namespace sherd
