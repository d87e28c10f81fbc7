#include "engine/rigid/free_motion.h"

#include <algorithm>

namespace sherd {
namespace {

constexpr Real kTurn = 0.25;  // rad at a time
constexpr int kMaxTurns = 4096;
constexpr int kMaxRounds = 60;  // of the fixed point, which gains a factor of kTurn or more each

// x turned back by the Cayley map of r: (1 + [r/2])^-1 (1 - [r/2]) x.
Vec3 turned_back(const Quat& half, const Vec3& x) {
  return rotate(conjugate(half), x);
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
    Vec3 middle = start;
    Quat turn;
    for (int round = 0; round < kMaxRounds; ++round) {
      turn = cayley(inverse_inertia * middle * h);
      const Vec3 next = 0.5 * (start + turned_back(turn, start));
      const bool same = distance2(next, middle) <= 1e-32 * norm2(start);
      middle = next;
      if (same) break;
    }
    b.pose.orientation = normalized(b.pose.orientation * turn);
  }
  b.angular_velocity = spin_of(b, kept);
}

}  // namespace sherd
