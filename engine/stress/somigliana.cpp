#include "engine/stress/somigliana.h"

#include <algorithm>
#include <numbers>

#include "engine/stress/lane_gradients.h"
#include "kernels/core/parallel.h"
#include "kernels/fmm/plan.h"

namespace sherd {
namespace {

// Closed form and seven points reach less far than in the operator, in longest edges from the centroid: gradients of
// constants err by 7e-5 with seven points at two edges and by 3e-4 with three at five (design notes, elastostatics
// section 2), a panel, which is below what the displacement brings along.
constexpr Real kNearLess = 1, kMiddleLess = 3;

// The fast sum takes as long as the direct one at so many points and for so many pairs together, of which three
// quarters are translations that a process makes once (measured: sherd-bench micro
// --benchmark_filter=interior_gradients).
constexpr double kFastPoints = 2000, kFastPairs = 4e8;
// Coarsest that keeps far sums below the three-point rule's error; its translations are those of bulky bodies' solver.
constexpr Real kFastTolerance = 1e-5;
// In roots of the panel's area: a source nearer contributes 1e4 times what is left once it has been taken out.
constexpr Real kTouch = 1e-2;

constexpr std::size_t kChunk = 768;  // sources of a direct sum that a task takes: a front asks at few points at once

std::vector<Real> squared_reach(const Boundary& b, Real edges) {
  std::vector<Real> out;
  for (const PanelFrame& f : b.panels) out.push_back(edges * edges * f.longest2);
  return out;
}

Real near_edges(const QuadratureOptions& o) {
  return std::max(o.closed_form - kNearLess, 1.0);
}
Real middle_edges(const QuadratureOptions& o) {
  return std::max(o.gauss7 - kMiddleLess, near_edges(o));
}

void append(std::vector<double>& out, const std::vector<double>& column) {
  out.insert(out.end(), column.begin(), column.end());
}

}  // namespace

Somigliana::Somigliana(const Boundary& b, const std::vector<ElementField>& elements, const Elastic& material,
                       const QuadratureOptions& options)
    : boundary_(b),
      elements_(elements),
      material_(material),
      position_(far_points(b.panels)),
      near2_(squared_reach(b, near_edges(options))),
      middle2_(squared_reach(b, middle_edges(options))),
      search_(b.centroid, middle2_) {
  for (std::size_t t = 0; t < elements.size(); ++t) {
    const PanelFrame& f = b.panels[t];
    least2_ = std::min(least2_, 1e-12 * f.area);
    for (std::size_t q = 0; q < 3; ++q) {
      const ElementField::Source& s = elements[t].far()[q];
      density_.push_back(s.density), guenter_.push_back(s.guenter), normal_.push_back(f.normal);
      for (std::size_t i = 0; i < 9; ++i) gradient_[i].push_back(s.gradient.m[i / 3][i % 3]);
    }
  }
}

void Somigliana::gradients(const Vec3Column& x, std::span<const std::uint32_t> face, std::span<Mat3> out,
                           FarSum sum) const {
  const double sources = static_cast<double>(position_.size()), targets = static_cast<double>(x.size());
  const bool fast =
      sum == FarSum::kFast || (sum == FarSum::kAutomatic && sources * targets > sources * kFastPoints + kFastPairs);
  std::vector<char> direct(x.size(), 1);
  if (fast) {
    fast_sums(x, out);
    parallel_for(x.size(), 64, [&](std::size_t k) {
      direct[k] = touches_source(x[k]);
      if (!direct[k]) out[k] += correction(x[k], face[k], 0);
    });
  }
  std::vector<std::uint32_t> left;
  for (std::uint32_t k = 0; k < x.size(); ++k)
    if (direct[k]) left.push_back(k);
  const std::size_t chunks = (position_.size() + kChunk - 1) / kChunk;
  sum_lanes(
      lane_groups(left.size()), chunks,
      [&](std::size_t group, std::size_t chunk, LaneGradients& part) {
        direct_sum(LaneTargets(x, lane_group(left, group)), chunk, part);
      },
      [&](std::size_t group, const LaneGradients& total) {
        const auto points = lane_group(left, group);
        for (std::size_t k = 0; k < points.size(); ++k) out[points[k]] = lane(total, k);
      });
  parallel_for(left.size(), 1, [&](std::size_t i) {
    const std::uint32_t k = left[i];
    out[k] += correction(x[k], face[k], least2_);
  });
}

void Somigliana::direct_sum(const LaneTargets& targets, std::size_t chunk, LaneGradients& sum) const {
  const std::size_t first = chunk * kChunk;
  const auto part = [&](const Vec3Column& c) {
    return std::array{c.x.data() + first, c.y.data() + first, c.z.data() + first};
  };
  const auto y = part(position_), f = part(density_), g = part(guenter_), n = part(normal_);
  LaneElements s{{y[0], y[1], y[2]}, {f[0], f[1], f[2]},
                 {g[0], g[1], g[2]}, {},
                 {n[0], n[1], n[2]}, std::min(kChunk, position_.size() - first)};
  for (std::size_t i = 0; i < 9; ++i) s.gradient[i] = gradient_[i].data() + first;
  lane_kernels().gradient_sum(s, material_.kelvin(), 3 - 4 * material_.nu, least2_, targets.x, sum.data());
}

// Row i of the gradient is that of Kelvin's layer and of M u_i / 4 pi l, and the curl of c_i / 4 pi l with
// c_i = (surface gradient of u_i) x n: (A.n) g - (A.g) n = A x (g x n).
void Somigliana::fast_sums(const Vec3Column& x, std::span<Mat3> out) const {
  const std::size_t n = position_.size(), m = x.size();
  constexpr std::size_t kSets = 4, kStrengths = 9, kOutputs = 9;  // f, g and the dipoles, which are zero
  std::vector<double> strength, value(kSets * kOutputs * m);
  strength.reserve(kSets * kStrengths * n);
  for (const Vec3Column* column : {&density_, &guenter_})
    append(strength, column->x), append(strength, column->y), append(strength, column->z);
  strength.resize(kStrengths * n, 0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    strength.resize(strength.size() + 3 * n, 0.0);
    Vec3Column c(n);
    for (std::size_t p = 0; p < n; ++p)
      c.set(p, cross({gradient_[3 * i][p], gradient_[3 * i + 1][p], gradient_[3 * i + 2][p]}, normal_[p]));
    append(strength, c.x), append(strength, c.y), append(strength, c.z);
    strength.resize((i + 2) * kStrengths * n, 0.0);
  }
  fmm::PlanOptions options;
  options.tolerance = kFastTolerance;
  const fmm::Plan plan(
      fmm::PairSum::kElasticGradient,
      {(3 - 4 * material_.nu) * material_.kelvin(), material_.kelvin(), 1 / (4 * std::numbers::pi), 0, 0},
      {position_, x, &normal_, nullptr}, options);
  plan.apply(strength, value, kSets);
  parallel_for(m, 1024, [&](std::size_t k) {
    const auto at = [&](std::size_t set, std::size_t i, std::size_t j) {
      return value[(set * kOutputs + 3 * i + j) * m + k];
    };
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        const std::size_t a = (j + 1) % 3, b = (j + 2) % 3;  // curl_j = d_a c_b - d_b c_a
        out[k].m[i][j] = at(0, i, j) + at(i + 1, b, a) - at(i + 1, a, b);
      }
  });
}

bool Somigliana::touches_source(const Vec3& x) const {
  bool touches = false;
  Box at;
  at.grow(x);
  search_.visit(at, [&](std::size_t block) {
    for (const std::uint32_t t : search_.block(block))
      for (std::size_t q = 3 * t; q < 3 * t + 3; ++q)
        touches |= distance2(x, position_[q]) < kTouch * kTouch * boundary_.panels[t].area;
  });
  return touches;
}

Mat3 Somigliana::correction(const Vec3& x, std::uint32_t face, Real least) const {
  Mat3 g;
  Box at;
  at.grow(x);
  search_.visit(at, [&](std::size_t block) {
    for (const std::uint32_t t : search_.block(block)) {
      const Real d2 = distance2(x, boundary_.centroid[t]);
      if (d2 > middle2_[t]) continue;
      const PanelFrame& f = boundary_.panels[t];
      const ElementField& e = elements_[t];
      const Side side = t == face ? Side::kInterior : Side::kAway;
      g += (d2 > near2_[t] ? e.seven_points(f, x, material_) : e.closed_form(f, x, material_, side)) -
           e.three_points(f, x, material_, least);
    }
  });
  return g;
}

}  // namespace sherd
