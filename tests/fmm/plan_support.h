// A planned sum beside the direct sum in double precision.
#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "kernels/fmm/direct.h"
#include "kernels/fmm/far_field.h"
#include "kernels/fmm/plan.h"
#include "tests/fmm/tree_support.h"

namespace sherd::fmm::test {

inline constexpr PairConstants<double> kConstants{2.6, 1, 0.7, 0.9, 0.5};

struct PlanCase {
  PairSum sum;
  Vec3Column sources, targets, source_normals, target_normals;
  PairConstants<double> constants = kConstants;
  PlanOptions options{};
  std::vector<double> strengths{};

  Points points() const { return {sources, targets, &source_normals, &target_normals}; }
  Plan plan() const { return Plan(sum, constants, points(), options); }
  std::vector<double> apply() const { return apply(plan()); }
  std::vector<double> apply(const Plan& p) const {
    std::vector<double> out(p.outputs() * targets.size(), 7.0);
    p.apply(strengths, out);
    return out;
  }
  std::vector<double> direct() const {
    std::vector<double> all = strengths, out(pair_shape(sum).outputs * targets.size());
    if (first_normal(sum) < pair_shape(sum).strengths)
      for (const auto* v : {&source_normals.x, &source_normals.y, &source_normals.z})
        all.insert(all.end(), v->begin(), v->end());
    direct_sum({.sum = sum,
                .sources = sources,
                .strengths = all,
                .targets = targets,
                .constants = constants,
                .target_normals = &target_normals},
               out);
    return out;
  }
};

inline std::vector<double> random_numbers(std::size_t n, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> v(n);
  for (double& x : v) x = random.uniform(-1, 1);
  return v;
}

// Independent strengths about zero are the hardest: far fields cancel, so that the error is relative to little.
// Normals are directions at random. leaf_size 0: by the cost model.
inline PlanCase plan_case(PairSum sum, const Vec3Column& sources, const Vec3Column& targets, std::size_t leaf_size = 60,
                          Arithmetic arithmetic = Arithmetic::kDouble, double tolerance = 1e-4) {
  PlanCase c{.sum = sum,
             .sources = sources,
             .targets = targets,
             .source_normals = sphere_points(sources.size(), 7),
             .target_normals = sphere_points(targets.size(), 8)};
  c.options.leaf_size = leaf_size, c.options.arithmetic = arithmetic, c.options.tolerance = tolerance;
  c.strengths = random_numbers(first_normal(sum) * sources.size(), 9);
  return c;
}

// Relative L2 error; absolute where the right answer is zero.
inline double relative_error(const std::vector<double>& got, const std::vector<double>& right) {
  double difference = 0, size = 0, largest = 0;
  for (const double v : right) largest = std::max(largest, std::abs(v));
  const double unit = largest > 0 ? largest : 1;  // squares must neither vanish nor overflow
  for (std::size_t i = 0; i < right.size(); ++i)
    difference += (got[i] / unit - right[i] / unit) * (got[i] / unit - right[i] / unit),
        size += (right[i] / unit) * (right[i] / unit);
  return size > 0 ? std::sqrt(difference / size) : std::sqrt(difference);
}

inline const char* name(Arithmetic a) {
  return a == Arithmetic::kFloat ? "float" : a == Arithmetic::kMixed ? "mixed" : "double";
}

}  // namespace sherd::fmm::test
