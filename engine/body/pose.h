// Unit quaternions and rigid placements.
#pragma once
#include "kernels/core/vec3.h"

namespace sherd {

struct Quat {
  Real w = 1, x = 0, y = 0, z = 0;
  friend bool operator==(const Quat&, const Quat&) = default;
};
inline Quat conjugate(const Quat& q) {
  return {q.w, -q.x, -q.y, -q.z};
}
inline Quat operator*(const Quat& a, const Quat& b) {
  return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
inline Quat normalized(const Quat& q) {
  const Real s = 1 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {q.w * s, q.x * s, q.y * s, q.z * s};
}
inline Vec3 rotate(const Quat& q, const Vec3& v) {
  const Vec3 u{q.x, q.y, q.z}, t = 2.0 * cross(u, v);
  return v + q.w * t + cross(u, t);
}
inline Mat3 to_matrix(const Quat& q) {
  return Mat3::from_columns(rotate(q, {1, 0, 0}), rotate(q, {0, 1, 0}), rotate(q, {0, 0, 1}));
}
// Rotation by |r| radians about r (the exponential map).
inline Quat from_rotation_vector(const Vec3& r) {
  const Real a = norm(r);
  const Real s = a < 1e-8 ? 0.5 - a * a / 48 : std::sin(0.5 * a) / a;
  return {std::cos(0.5 * a), s * r.x, s * r.y, s * r.z};
}

struct Pose {
  Vec3 position;     // of the centre of mass, world, metres
  Quat orientation;  // material to world
  friend bool operator==(const Pose&, const Pose&) = default;
};

}  // namespace sherd
