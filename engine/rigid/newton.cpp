#include "engine/rigid/newton.h"

#include <Eigen/Sparse>
#include <algorithm>

namespace sherd {
namespace {

constexpr Real kWeight = 1e6;  // rho over the contact's own mass
constexpr Real kInner = 1e-3;  // tolerance of Newton's steps over that of the solve
constexpr Real kFlat = 1e-2;   // slope that counts as none in the line search, over the first
constexpr int kPatience = 6;   // rounds without a smaller residual
constexpr int kRounds = 40, kSteps = 30, kHalvings = 50;

using Vector = Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix3 = Eigen::Matrix<double, 3, 3>;
using Matrix36 = Eigen::Matrix<double, 3, 6>;

Vector6 six(const Vec3& linear, const Vec3& angular) {
  return (Vector6() << linear.x, linear.y, linear.z, angular.x, angular.y, angular.z).finished();
}

// Motion m's part of a vector.
auto at(Vector& v, std::size_t m) {
  return v.segment<6>(static_cast<Eigen::Index>(6 * m));
}
auto at(const Vector& v, std::size_t m) {
  return v.segment<6>(static_cast<Eigen::Index>(6 * m));
}

class Problem {
 public:
  Problem(std::span<const Motion> motions, std::span<const ContactRow> rows, std::span<const RowTerms> terms)
      : rows_(rows.begin(), rows.end()), terms_(terms), size_(static_cast<Eigen::Index>(6 * (motions.size()))) {
    start_ = Vector::Zero(size_);
    for (std::size_t m = 0; m < motions.size(); ++m) {
      const Motion& motion = motions[m];
      mass_.push_back(Matrix6::Identity());  // of what does not move: no row has a Jacobian there
      moves_.push_back(motion.inverse_mass > 0);
      if (!moves_.back()) continue;
      const Mat3 inertia = inverse(motion.inverse_inertia);
      mass_.back() /= motion.inverse_mass;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) mass_.back()(3 + i, 3 + j) = 0.5 * (inertia[i][j] + inertia[j][i]);
      at(start_, m) = six(motion.v, motion.w);
    }
    for (const ContactRow& r : rows) radius_.push_back(r.friction * r.impulse[0]);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      Matrix36 a = Matrix36::Zero(), b = Matrix36::Zero();
      for (int k = 0; k < 3; ++k) {
        if (moves_[rows[i].a]) a.row(k) = six(rows[i].axis[k], terms[i].turn_a[k]).transpose();
        if (moves_[rows[i].b]) b.row(k) = -six(rows[i].axis[k], terms[i].turn_b[k]).transpose();
      }
      jacobian_a_.push_back(a), jacobian_b_.push_back(b);
    }
    value_ = start_;
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const RowTerms& p = terms[i];
        const Real impulse = rows[i].impulse[k];
        at(value_, rows[i].a) += impulse * six(rows[i].axis[k] * motions[rows[i].a].inverse_mass, p.spin_a[k]);
        at(value_, rows[i].b) -= impulse * six(rows[i].axis[k] * motions[rows[i].b].inverse_mass, p.spin_b[k]);
      }
    make_pattern();
  }

  // Velocities for the impulses of the last round; false when a factorization fails.
  bool minimize(Real tolerance) {
    for (int step = 0; step < kSteps; ++step) {
      const Vector gradient = derivatives(value_);
      if (!factor()) return false;
      const Vector change = -solver_.solve(gradient);
      const Real slope = gradient.dot(change);
      if (!(slope < 0)) return true;
      value_ += length_of(change, slope) * change;
      if (largest_velocity(change) <= kInner * tolerance) return true;
    }
    return true;
  }
  // Takes the impulses of the velocities for the next round's.
  // Bounds of friction that follow the normal impulses at once may go back and forth between two values.
  void next_round(Real follow) {
    derivatives(value_);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      for (int k = 0; k < 3; ++k) rows_[i].impulse[k] = wanted_[i][k];
      radius_[i] += follow * (rows_[i].friction * wanted_[i].x - radius_[i]);
    }
  }
  const std::vector<ContactRow>& rows() const { return rows_; }

 private:
  Real largest_velocity(const Vector& v) const {
    Real most = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const Vec3 u = velocities(v, i);
      most = std::max({most, std::abs(u.x), std::abs(u.y), std::abs(u.z)});
    }
    return most;
  }
  Real weight(std::size_t i) const { return kWeight * terms_[i].normal_mass; }

  // Impulses of row i for contact velocities u.
  Vec3 impulses(std::size_t i, const Vec3& u) const {
    const ContactRow& r = rows_[i];
    const Real rho = weight(i);
    const Tangents f = into_disc({r.impulse[1] - rho * u.y, r.impulse[2] - rho * u.z}, radius_[i]);
    return {std::max(0.0, r.impulse[0] + rho * (r.target - u.x)), f.x, f.y};
  }
  Vec3 velocities(const Vector& v, std::size_t i) const {
    const Eigen::Vector3d u = jacobian_a_[i] * at(v, rows_[i].a) + jacobian_b_[i] * at(v, rows_[i].b);
    return {u.x(), u.y(), u.z()};
  }

  // Where the slope along `change` vanishes, at most 1: full steps overshoot where contacts open and slide.
  Real length_of(const Vector& change, Real slope) const {
    Real linear = 0, square = 0;
    for (std::size_t m = 0; m < mass_.size(); ++m) {
      const Vector6 momentum = mass_[m] * at(change, m);
      linear += momentum.dot(at(value_, m) - at(start_, m)), square += momentum.dot(at(change, m));
    }
    std::vector<Vec3> now(rows_.size()), ahead(rows_.size());
    for (std::size_t i = 0; i < rows_.size(); ++i) now[i] = velocities(value_, i), ahead[i] = velocities(change, i);
    const auto slope_at = [&](Real t) {
      Real sum = linear + square * t;
      for (std::size_t i = 0; i < rows_.size(); ++i) sum -= dot(impulses(i, now[i] + ahead[i] * t), ahead[i]);
      return sum;
    };
    if (slope_at(1) <= kFlat * -slope) return 1;
    Real low = 0, high = 1;
    for (int n = 0; n < kHalvings; ++n) {
      const Real middle = 0.5 * (low + high), s = slope_at(middle);
      (s < 0 ? low : high) = middle;
      if (std::abs(s) <= kFlat * -slope) break;
    }
    return 0.5 * (low + high);
  }

  // Gradient of the cost; leaves the impulses in wanted_ and their derivatives in curvature_.
  Vector derivatives(const Vector& v) {
    Vector g(size_);
    for (std::size_t m = 0; m < mass_.size(); ++m) at(g, m) = mass_[m] * (at(v, m) - at(start_, m));
    wanted_.resize(rows_.size()), curvature_.resize(rows_.size());
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const ContactRow& r = rows_[i];
      const Real rho = weight(i);
      const Vec3 u = velocities(v, i);
      const Tangents s{r.impulse[1] - rho * u.y, r.impulse[2] - rho * u.z};
      const Real radius = radius_[i], size = std::sqrt(s.x * s.x + s.y * s.y);
      wanted_[i] = impulses(i, u);
      Mat3& d = curvature_[i];
      d = {};
      d[0][0] = wanted_[i].x > 0 ? rho : 0;
      if (size <= radius) {
        d[1][1] = d[2][2] = rho;
      } else {  // sliding: only the direction of friction follows the velocity
        const Real slide = rho * radius / size, x = s.x / size, y = s.y / size;
        d[1][1] = slide * y * y, d[2][2] = slide * x * x, d[1][2] = d[2][1] = -slide * x * y;
      }
      const Eigen::Vector3d impulse(wanted_[i].x, wanted_[i].y, wanted_[i].z);
      at(g, r.a).noalias() -= jacobian_a_[i].transpose() * impulse;
      at(g, r.b).noalias() -= jacobian_b_[i].transpose() * impulse;
    }
    return g;
  }

  bool factor() {
    for (std::size_t m = 0; m < mass_.size(); ++m) blocks_[diagonal_[m]] = mass_[m];
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (off_[i] != kNoBlock) blocks_[off_[i]].setZero();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const Mat3& c = curvature_[i];
      if (trace(c) == 0) continue;
      const Matrix3 d = (Matrix3() << c[0][0], 0, 0, 0, c[1][1], c[1][2], 0, c[2][1], c[2][2]).finished();
      const Matrix36 da = d * jacobian_a_[i], db = d * jacobian_b_[i];
      const std::uint32_t a = rows_[i].a, b = rows_[i].b;
      if (moves_[a]) blocks_[diagonal_[a]].noalias() += jacobian_a_[i].transpose() * da;
      if (moves_[b]) blocks_[diagonal_[b]].noalias() += jacobian_b_[i].transpose() * db;
      if (off_[i] == kNoBlock) continue;
      if (b > a)
        blocks_[off_[i]].noalias() += jacobian_b_[i].transpose() * da;
      else
        blocks_[off_[i]].noalias() += jacobian_a_[i].transpose() * db;
    }
    // Columns of six: the blocks below one another.
    double* value = hessian_.valuePtr();
    for (std::size_t m = 0; m < mass_.size(); ++m)
      for (int j = 0; j < 6; ++j)
        for (std::size_t k = diagonal_[m]; k < (m + 1 < mass_.size() ? diagonal_[m + 1] : blocks_.size()); ++k)
          for (int i = 0; i < 6; ++i) *value++ = blocks_[k](i, j);
    solver_.factorize(hessian_);
    return solver_.info() == Eigen::Success;
  }

  // Blocks of the lower triangle, by column: the motion itself, then the later ones it touches.
  void make_pattern() {
    std::vector<std::vector<std::uint32_t>> below(mass_.size());
    for (const ContactRow& r : rows_)
      if (moves_[r.a] && moves_[r.b]) below[std::min(r.a, r.b)].push_back(std::max(r.a, r.b));
    std::vector<Eigen::Triplet<double>> entries;
    std::size_t count = 0;
    for (std::uint32_t m = 0; m < mass_.size(); ++m) {
      std::vector<std::uint32_t>& list = below[m];
      list.push_back(m);
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
      diagonal_.push_back(count), count += list.size();
      for (const std::uint32_t n : list)
        for (int i = 0; i < 6; ++i)
          for (int j = 0; j < 6; ++j)
            entries.emplace_back(static_cast<int>(6 * n) + i, static_cast<int>(6 * m) + j, 1.0);
    }
    blocks_.resize(count);
    for (const ContactRow& r : rows_) {
      const std::uint32_t m = std::min(r.a, r.b), n = std::max(r.a, r.b);
      const std::vector<std::uint32_t>& list = below[m];
      off_.push_back(moves_[m] && moves_[n]
                         ? diagonal_[m] +
                               static_cast<std::size_t>(std::lower_bound(list.begin(), list.end(), n) - list.begin())
                         : kNoBlock);
    }
    hessian_.resize(size_, size_);
    hessian_.setFromTriplets(entries.begin(), entries.end());
    solver_.analyzePattern(hessian_);
  }

  static constexpr std::size_t kNoBlock = static_cast<std::size_t>(-1);
  std::vector<ContactRow> rows_;
  std::span<const RowTerms> terms_;
  Eigen::Index size_;
  Vector start_, value_;
  std::vector<Matrix6> mass_;
  std::vector<char> moves_;
  std::vector<Matrix36> jacobian_a_, jacobian_b_;
  std::vector<Real> radius_;  // of friction's disc
  std::vector<Vec3> wanted_;
  std::vector<Mat3> curvature_;
  std::vector<Matrix6> blocks_;        // of the Hessian
  std::vector<std::size_t> diagonal_;  // of each motion among them
  std::vector<std::size_t> off_;       // of each row, or kNoBlock
  Sparse hessian_;
  Eigen::SimplicialLDLT<Sparse, Eigen::Lower> solver_;
};

}  // namespace

Real solve_by_newton(std::span<Motion> motions, std::span<ContactRow> rows, std::span<const RowTerms> terms,
                     Real tolerance, Real residual) {
  Problem problem(motions, rows, terms);
  std::vector<Motion> best_motions;
  std::vector<ContactRow> best_rows;
  Real last = std::numeric_limits<Real>::infinity(), least = last;  // residuals of the last round, and the smallest
  int idle = 0;                                                     // rounds since that
  bool damped = false;
  for (int round = 0; round < kRounds && residual > tolerance && idle < kPatience; ++round) {
    if (!problem.minimize(tolerance)) break;
    problem.next_round(damped ? 0.5 : 1);
    // Velocities from the impulses, these within the cone of the new normal impulse but for its slack.
    std::vector<Motion> moved(motions.begin(), motions.end());
    std::vector<ContactRow> now = problem.rows();
    for (std::size_t i = 0; i < now.size(); ++i) {
      ContactRow& r = now[i];
      const Tangents f = into_disc({r.impulse[1], r.impulse[2]}, (1 + kConeSlack) * r.friction * r.impulse[0]);
      r.impulse[1] = f.x, r.impulse[2] = f.y;
      for (int k = 0; k < 3; ++k) apply_impulse(moved[r.a], moved[r.b], r, terms[i], k, r.impulse[k]);
    }
    const Real reached = residual_of(moved, now, terms);
    damped = reached > 0.25 * last;
    idle = reached < 0.95 * least ? 0 : idle + 1;
    last = reached, least = std::min(least, reached);
    if (reached < residual) residual = reached, best_motions = std::move(moved), best_rows = std::move(now);
  }
  if (!best_rows.empty()) {
    std::copy(best_motions.begin(), best_motions.end(), motions.begin());
    std::copy(best_rows.begin(), best_rows.end(), rows.begin());
  }
  return residual;
}

}  // namespace sherd
