#include "engine/rigid/solver.h"

#include <algorithm>

#include "engine/rigid/newton.h"

namespace sherd {
namespace {

constexpr int kFewSweeps = 30;  // of small islands: Newton's method is cheap there
constexpr Real kRough = 10;     // residual over tolerance that large islands may keep after the sweeps

// Friction first with the last normal impulse, then the normal, so that the normal condition holds at the end of the
// row. Returns the change in m/s.
Real relax(Motion& a, Motion& b, ContactRow& r, const RowTerms& p) {
  const Tangents f = friction_wanted(a, b, r, p, r.friction * r.impulse[0]);
  const Real d1 = f.x - r.impulse[1], d2 = f.y - r.impulse[2];
  if (d1 != 0 || d2 != 0) apply_impulse(a, b, r, p, 1, d1), apply_impulse(a, b, r, p, 2, d2);
  r.impulse[1] = f.x, r.impulse[2] = f.y;
  const Real n = normal_wanted(a, b, r, p), d0 = n - r.impulse[0];
  if (d0 != 0) apply_impulse(a, b, r, p, 0, d0);
  r.impulse[0] = n;
  return std::max(std::abs(d0) * p.normal_rate, std::max(std::abs(d1), std::abs(d2)) * p.tangent_rate);
}

struct Problem {
  std::span<Motion> motions;
  std::span<ContactRow> rows;
  std::vector<RowTerms> terms;

  void apply_all(const std::vector<Vec3>& change, Real scale) {
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const Real d = scale * change[i][k];
        if (d == 0) continue;
        rows[i].impulse[k] += d;
        apply_impulse(motions[rows[i].a], motions[rows[i].b], rows[i], terms[i], k, d);
      }
  }
  Real sweep() {
    Real change = 0;
    const auto at = [&](std::size_t i) {
      change = std::max(change, relax(motions[rows[i].a], motions[rows[i].b], rows[i], terms[i]));
    };
    for (std::size_t i = 0; i < rows.size(); ++i) at(i);
    for (std::size_t i = rows.size(); i-- > 0;) at(i);
    return change;
  }
  Real residual() const { return residual_of(motions, rows, terms); }
};

// The step of a sweep is minus the gradient; the direction forgets its past when steps grow.
class Acceleration {
 public:
  explicit Acceleration(std::size_t rows) : before_(rows), step_(rows), direction_(rows) {}

  void remember(std::span<const ContactRow> rows) {
    for (std::size_t i = 0; i < rows.size(); ++i)
      before_[i] = {rows[i].impulse[0], rows[i].impulse[1], rows[i].impulse[2]};
  }
  void advance(Problem& problem) {
    Real size = 0;  // in energy: m/s times N s
    for (std::size_t i = 0; i < problem.rows.size(); ++i) {
      const ContactRow& r = problem.rows[i];
      step_[i] = Vec3{r.impulse[0], r.impulse[1], r.impulse[2]} - before_[i];
      const RowTerms& p = problem.terms[i];
      size += step_[i].x * step_[i].x * p.normal_rate +
              (step_[i].y * step_[i].y + step_[i].z * step_[i].z) * p.tangent_rate;
    }
    const Real beta = last_ > 0 ? size / last_ : 0;
    last_ = size;
    if (beta > 1 || beta == 0) {
      direction_ = step_;
      return;
    }
    problem.apply_all(direction_, beta);
    for (std::size_t i = 0; i < direction_.size(); ++i) direction_[i] = direction_[i] * beta + step_[i];
  }

 private:
  std::vector<Vec3> before_, step_, direction_;
  Real last_ = 0;
};

}  // namespace

SolveReport solve_contacts(std::span<Motion> motions, std::span<ContactRow> rows, int iterations, Real tolerance) {
  SolveReport report;
  if (rows.empty()) return report;
  const std::vector<Motion> unmoved(motions.begin(), motions.end());
  Problem problem{motions, rows, {}};
  problem.terms.reserve(rows.size());
  for (ContactRow& r : rows) {
    problem.terms.push_back(row_terms(motions[r.a], motions[r.b], r));
    for (int k = 0; k < 3; ++k)
      if (r.impulse[k] != 0) apply_impulse(motions[r.a], motions[r.b], r, problem.terms.back(), k, r.impulse[k]);
  }
  const Real first = problem.residual();
  Real residual = first;
  const std::vector<ContactRow> warm(rows.begin(), rows.end());
  const std::vector<Motion> warm_motions(motions.begin(), motions.end());
  const bool few = motions.size() <= kFewMotions;
  const int sweeps = few ? std::min(iterations, kFewSweeps) : iterations;
  Acceleration acceleration(rows.size());
  while (residual > tolerance && report.iterations < sweeps) {
    acceleration.remember(rows);
    const Real change = problem.sweep();
    ++report.iterations;
    // A sweep that changes much leaves a residual; only projected impulses, those before an acceleration, can be kept.
    const bool last = report.iterations == sweeps;
    if (change <= 10 * tolerance || last) residual = problem.residual();
    if (residual > tolerance && !last) acceleration.advance(problem);
  }
  if (residual > tolerance * (few ? 1 : kRough)) {
    // Sweeps spoil a good start where masses differ.
    if (first <= residual) {
      residual = first;
      std::copy(warm.begin(), warm.end(), rows.begin()),
          std::copy(warm_motions.begin(), warm_motions.end(), motions.begin());
    }
    std::vector<Motion> moved = unmoved;
    const Real reached = solve_by_newton(moved, rows, problem.terms, tolerance, residual);
    if (reached < residual) residual = reached, std::copy(moved.begin(), moved.end(), motions.begin());
  }
  report.residual = residual / tolerance;
  report.unconverged = residual > tolerance ? 1 : 0;
  return report;
}

}  // namespace sherd
