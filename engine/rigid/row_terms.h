// What the contact solvers share of a row: Jacobian parts that stay fixed over a solve, and the row's conditions.
#pragma once
#include <algorithm>

#include "engine/rigid/solver.h"

namespace sherd {

struct RowTerms {
  Vec3 turn_a[3], turn_b[3];               // arm x axis
  Vec3 spin_a[3], spin_b[3];               // inverse inertia times turn: change of w by a unit impulse
  Real normal_mass = 0;                    // kg
  Real tangent_mass = 0;                   // kg; of the stiffest tangential direction
  Real normal_rate = 0, tangent_rate = 0;  // m/s a unit of impulse changes the contact's own velocity
};

inline RowTerms row_terms(const Motion& a, const Motion& b, const ContactRow& r) {
  RowTerms p;
  for (int k = 0; k < 3; ++k) {
    p.turn_a[k] = cross(r.arm_a, r.axis[k]), p.turn_b[k] = cross(r.arm_b, r.axis[k]);
    p.spin_a[k] = a.inverse_inertia * p.turn_a[k], p.spin_b[k] = b.inverse_inertia * p.turn_b[k];
  }
  const Real m = a.inverse_mass + b.inverse_mass;
  const auto k = [&](int i, int j) {
    return (i == j ? m : 0) + dot(p.turn_a[i], p.spin_a[j]) + dot(p.turn_b[i], p.spin_b[j]);
  };
  p.normal_rate = k(0, 0);
  p.normal_mass = p.normal_rate > 0 ? 1 / p.normal_rate : 0;
  const Real xx = k(1, 1), yy = k(2, 2), xy = 0.5 * (k(1, 2) + k(2, 1));
  p.tangent_rate = 0.5 * (xx + yy) + std::hypot(0.5 * (xx - yy), xy);
  p.tangent_mass = p.tangent_rate > 0 ? 1 / p.tangent_rate : 0;
  return p;
}

inline Real velocity_along(const Motion& a, const Motion& b, const ContactRow& r, const RowTerms& p, int k) {
  return dot(r.axis[k], a.v - b.v) + dot(p.turn_a[k], a.w) - dot(p.turn_b[k], b.w);
}

inline void apply_impulse(Motion& a, Motion& b, const ContactRow& r, const RowTerms& p, int k, Real impulse) {
  a.v += r.axis[k] * (impulse * a.inverse_mass), a.w += p.spin_a[k] * impulse;
  b.v -= r.axis[k] * (impulse * b.inverse_mass), b.w -= p.spin_b[k] * impulse;
}

struct Tangents {
  Real x = 0, y = 0;
};
inline Tangents into_disc(Tangents f, Real radius) {
  const Real size = std::sqrt(f.x * f.x + f.y * f.y);
  if (size > radius) f.x *= radius / size, f.y *= radius / size;
  return f;
}

// The impulse that a row would take for the velocities as they are: its own at a solution. One mass for both tangents:
// then sliding friction ends up opposite to the velocity, which a step with the 2x2 block followed by scaling back to
// the disc does not give.
inline Tangents friction_wanted(const Motion& a, const Motion& b, const ContactRow& r, const RowTerms& p, Real radius) {
  return into_disc({r.impulse[1] - p.tangent_mass * velocity_along(a, b, r, p, 1),
                    r.impulse[2] - p.tangent_mass * velocity_along(a, b, r, p, 2)},
                   radius);
}
inline Real normal_wanted(const Motion& a, const Motion& b, const ContactRow& r, const RowTerms& p) {
  return std::max(0.0, r.impulse[0] + (r.target - velocity_along(a, b, r, p, 0)) * p.normal_mass);
}

// Friction may miss its bound by this share: of redundant contacts the normal impulses are not unique, and settle
// slowly where that changes no velocity.
constexpr Real kConeSlack = 1e-3;

// Largest of all rows, m/s.
inline Real residual_of(std::span<const Motion> motions, std::span<const ContactRow> rows,
                        std::span<const RowTerms> terms) {
  Real worst = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ContactRow& r = rows[i];
    const RowTerms& p = terms[i];
    const Motion &a = motions[r.a], &b = motions[r.b];
    const Real size = std::sqrt(r.impulse[1] * r.impulse[1] + r.impulse[2] * r.impulse[2]),
               radius = r.friction * r.impulse[0];
    const Tangents f = friction_wanted(a, b, r, p, std::abs(size - radius) <= kConeSlack * radius ? size : radius);
    worst = std::max({worst, std::abs(normal_wanted(a, b, r, p) - r.impulse[0]) * p.normal_rate,
                      std::hypot(f.x - r.impulse[1], f.y - r.impulse[2]) * p.tangent_rate});
  }
  return worst;
}

}  // namespace sherd
