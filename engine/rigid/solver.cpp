#include "engine/rigid/solver.h"

#include <algorithm>

namespace sherd {
namespace {

// Jacobian parts that stay fixed over the sweeps.
struct Prepared {
  Vec3 turn_a[3], turn_b[3];               // arm x axis
  Vec3 spin_a[3], spin_b[3];               // inverse inertia times turn: change of w by a unit impulse
  Real normal_mass = 0;                    // kg
  Real tangent_mass = 0;                   // kg; of the stiffest tangential direction
  Real normal_rate = 0, tangent_rate = 0;  // m/s a unit of impulse changes the contact's own velocity
};

Prepared prepare(const Motion& a, const Motion& b, const ContactRow& r) {
  Prepared p;
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

Real velocity_along(const Motion& a, const Motion& b, const ContactRow& r, const Prepared& p, int k) {
  return dot(r.axis[k], a.v - b.v) + dot(p.turn_a[k], a.w) - dot(p.turn_b[k], b.w);
}

void apply(Motion& a, Motion& b, const ContactRow& r, const Prepared& p, int k, Real impulse) {
  a.v += r.axis[k] * (impulse * a.inverse_mass), a.w += p.spin_a[k] * impulse;
  b.v -= r.axis[k] * (impulse * b.inverse_mass), b.w -= p.spin_b[k] * impulse;
}

// Friction first with the last normal impulse, then the normal, so that the normal condition holds at the end of the
// row.
Real relax(Motion& a, Motion& b, ContactRow& r, const Prepared& p, Real target) {
  const Real v1 = velocity_along(a, b, r, p, 1), v2 = velocity_along(a, b, r, p, 2);
  // One mass for both tangents: then sliding friction ends up opposite to the velocity, which a step with the 2x2 block
  // followed by scaling back to the disc does not give.
  Real f1 = r.impulse[1] - p.tangent_mass * v1, f2 = r.impulse[2] - p.tangent_mass * v2;
  const Real size = std::hypot(f1, f2), most = r.friction * r.impulse[0];
  if (size > most) f1 *= most / size, f2 *= most / size;
  const Real d1 = f1 - r.impulse[1], d2 = f2 - r.impulse[2];
  if (d1 != 0 || d2 != 0) apply(a, b, r, p, 1, d1), apply(a, b, r, p, 2, d2);
  r.impulse[1] = f1, r.impulse[2] = f2;

  const Real n = std::max(0.0, r.impulse[0] + (target - velocity_along(a, b, r, p, 0)) * p.normal_mass);
  const Real d0 = n - r.impulse[0];
  if (d0 != 0) apply(a, b, r, p, 0, d0);
  r.impulse[0] = n;
  return std::max(std::abs(d0) * p.normal_rate, std::max(std::abs(d1), std::abs(d2)) * p.tangent_rate);
}

}  // namespace

SolveReport solve_contacts(std::span<Motion> motions, std::span<ContactRow> rows, std::span<const Real> target,
                           int iterations, Real tolerance) {
  std::vector<Prepared> prepared(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ContactRow& r = rows[i];
    prepared[i] = prepare(motions[r.a], motions[r.b], r);
    for (int k = 0; k < 3; ++k)
      if (r.impulse[k] != 0) apply(motions[r.a], motions[r.b], r, prepared[i], k, r.impulse[k]);
  }
  SolveReport report;
  for (; report.iterations < iterations && !rows.empty(); ++report.iterations) {
    report.change = 0;
    for (std::size_t s = 0; s < rows.size(); ++s) {
      const std::size_t i = report.iterations % 2 == 0 ? s : rows.size() - 1 - s;
      report.change =
          std::max(report.change, relax(motions[rows[i].a], motions[rows[i].b], rows[i], prepared[i], target[i]));
    }
    if (report.change <= tolerance) {
      ++report.iterations;
      break;
    }
  }
  return report;
}

}  // namespace sherd
