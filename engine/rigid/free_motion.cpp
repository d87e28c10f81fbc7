#include "engine/rigid/free_motion.h"

#include <algorithm>

namespace sherd {
namespace {

constexpr Real kTurn = 0.25;  // rad at a time
constexpr int kMaxTurns = 4096;
constexpr int kMaxRounds = 30;  // of Newton's method: needles take up to 17, or all where rounding keeps changes large

// The m with m = x - h/2 w(m) x m, where w(m) = I^-1 m: the mean of x and of x turned back by the Cayley map of h w(m).
// Newton's method, since a fixed point diverges for needles: a trace of m along the axis, where the inertia is small,
// is a fast spin. The motion itself is slow there (|I1 - I2| <= I3).
Vec3 middle_of(const Vec3& x, const Mat3& inverse_inertia, Real h) {
  Vec3 m = x;
  for (int round = 0; round < kMaxRounds; ++round) {
    const Vec3 w = inverse_inertia * m;
    const Mat3 slope = Mat3::identity() + (cross_matrix(w) - cross_matrix(m) * inverse_inertia) * (0.5 * h);
    const Vec3 change = inverse(slope) * (x - m - cross(w, m) * (0.5 * h));
    m += change;
    if (norm2(change) <= 1e-30 * norm2(x)) break;
  }
  return m;
}

Quat cayley(const Vec3& r) {
  return normalized(Quat{1, 0.5 * r.x, 0.5 * r.y, 0.5 * r.z});
}

}  // namespace

Vec3 spin_momentum(const Body& b) {
  const Quat& q = b.pose.orientation;
  return rotate(q, b.mass.inertia * rotate(conjugate(q), b.angular_velocity));
}

Vec3 spin_of(const Body& b, const Vec3& spin_momentum) {
  const Quat& q = b.pose.orientation;
  return rotate(q, inverse(b.mass.inertia) * rotate(conjugate(q), spin_momentum));
}

// In the body's axes M' = M x w, w = I^-1 M. Midpoint: M1 = M0 turned back by h w(m), m = (M0 + M1) / 2; the body turns
// by h w(m), so R M stays (Austin, Krishnaprasad and Wang 1993).
void move_freely(Body& b, Real t) {
  b.pose.position += b.velocity * t;
  if (b.angular_velocity == Vec3{}) return;
  const Vec3 kept = spin_momentum(b);
  const Mat3 inverse_inertia = inverse(b.mass.inertia);
  const int turns =
      static_cast<int>(std::clamp(std::ceil(norm(b.angular_velocity) * t / kTurn), 1.0, static_cast<Real>(kMaxTurns)));
  const Real h = t / turns;
  for (int n = 0; n < turns; ++n) {
    const Vec3 start = rotate(conjugate(b.pose.orientation), kept);
    const Quat turn = cayley(inverse_inertia * middle_of(start, inverse_inertia, h) * h);
    b.pose.orientation = normalized(b.pose.orientation * turn);
  }
  b.angular_velocity = spin_of(b, kept);
}

}  // namespace sherd
