// Laws of a planned sum: it is the direct sum to the tolerance asked for. Leaf sizes are forced so that few points
// already have a far field.
#include "kernels/fmm/plan.h"

#include <gtest/gtest.h>

#include "kernels/fmm/accuracy.h"
#include "tests/fmm/pairs_reference.h"
#include "tests/fmm/plan_support.h"

namespace sherd::fmm {
namespace {

using test::plan_case;
using test::PlanCase;
using test::relative_error;

constexpr Arithmetic kArithmetics[] = {Arithmetic::kFloat, Arithmetic::kMixed, Arithmetic::kDouble};

bool is_value(PairSum s) {
  return output_power(s, 0) == 1 && pair_shape(s).outputs <= 3;
}

// Values meet the tolerance. A derivative is as smooth as the surfaces resolve: it loses the factor that one more power
// of (box / distance) brings, 4 measured at most; dipoles are derivatives in the source.
double allowed_factor(PairSum s) {
  return is_value(s) && first_normal(s) == pair_shape(s).strengths ? 1 : 4;
}

TEST(Plan, EverySumMeetsItsToleranceInEveryArithmetic) {
  const Vec3Column sphere = sphere_points(5000, 1), volume = random_points(5000, 2, {1, 1, 1});
  for (const Vec3Column* p : {&sphere, &volume})
    for (const PairSum sum : test::all_sums()) {
      PlanCase c = plan_case(sum, *p, *p);
      const auto right = c.direct();
      for (const Arithmetic a : kArithmetics) {
        c.options.arithmetic = a;
        const Plan plan = c.plan();
        ASSERT_GT(plan.statistics().far_pairs, 500);
        ASSERT_LT(plan.statistics().direct_pairs, 0.5 * 5000 * 5000);
        EXPECT_LT(relative_error(c.apply(plan), right), 1e-4 * allowed_factor(sum))
            << "sum " << static_cast<int>(sum) << " " << test::name(a) << (p == &sphere ? " sphere" : " volume");
      }
    }
}

TEST(Plan, EveryToleranceIsMetAndUsed) {
  const Vec3Column points = sphere_points(9000, 3);
  PlanCase c = plan_case(PairSum::kLaplaceValue, points, points);
  const auto right = c.direct();
  double before = 1;
  std::size_t rank = 0;
  for (const double tolerance : {1e-2, 1e-3, 3e-4, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9}) {
    c.options.tolerance = tolerance;
    const Plan plan = c.plan();
    const double error = relative_error(c.apply(plan), right);
    EXPECT_LT(error, tolerance);
    // Not by doing more than was asked: an error of a hundredth of the tolerance would be paid for in vain.
    EXPECT_GT(error, 0.01 * tolerance);
    EXPECT_LT(error, before);
    EXPECT_GT(plan.statistics().rank[0], rank);
    before = error, rank = plan.statistics().rank[0];
  }
}

TEST(Plan, KelvinHoldsForAnyRatioOfItsConstants) {
  const Vec3Column points = sphere_points(4000, 4);
  for (const auto& [a, b] :
       {std::pair{1.0, 1.0}, {1.0, 0.0}, {0.0, 1.0}, {10.0, 1.0}, {0.5, 1.0}, {-3.0, 1.0}, {7.0, 1.0}}) {
    PlanCase c = plan_case(PairSum::kKelvinValue, points, points);
    c.constants.a = a, c.constants.b = b;
    // Where the Kelvin field of ratio 2 and a Laplace field make up the sum, both have their errors, and for opposite
    // signs their sum is smaller than either.
    EXPECT_LT(relative_error(c.apply(), c.direct()), a < 0 ? 3e-4 : a < 1 ? 2e-4 : 1e-4) << a << " / " << b;
  }
}

TEST(Plan, TargetsNeedNotBeTheSources) {
  const Vec3Column sources = sphere_points(5000, 5);
  for (const Vec3Column& targets :
       {random_points(3000, 6, {2, 2, 2}, {-1, -1, -1}), random_points(200, 7, {0.3, 0.3, 0.3}, {0.5, 0.5, 0.5}),
        random_points(2000, 8, {1, 1, 1}, {4, 0, 0}), random_points(7, 8, {9, 9, 9})})
    for (const PairSum sum : {PairSum::kKelvinValue, PairSum::kKelvinStress, PairSum::kDipoleValue}) {
      PlanCase c = plan_case(sum, sources, targets, 40);
      // Among the sources the nearest ones, summed exactly, make up most of the sum. Apart from them the error of the
      // far field is measured against itself: 2 times the tolerance, and 40 times that of derivatives.
      const bool apart = targets.size() != 3000;
      EXPECT_LT(relative_error(c.apply(), c.direct()),
                1e-4 * (apart ? (allowed_factor(sum) > 1 ? 50 : 2) : allowed_factor(sum)))
          << static_cast<int>(sum) << " at " << targets.size();
    }
}

TEST(Plan, DipolesOnASmoothSurfaceWithASmoothDensity) {
  // The double layer of a body. On a sphere (r . n) / l^3 = -1 / 2 l: boxes cancel what a box of dipoles may cause, so
  // that the error is a few times the tolerance, not less.
  const Vec3Column points = sphere_points(6000, 9);
  PlanCase c = plan_case(PairSum::kDipoleValue, points, points);
  c.source_normals = points;
  for (std::size_t i = 0; i < points.size(); ++i)
    c.strengths[i] = 1 + points.x[i] * points.y[i] + 0.5 * std::sin(3 * points.z[i]);
  EXPECT_LT(relative_error(c.apply(), c.direct()), 4e-4);
}

TEST(Plan, IsLinearInTheStrengths) {
  const Vec3Column points = sphere_points(3000, 10);
  for (const PairSum sum : {PairSum::kKelvinValue, PairSum::kElasticGradient}) {
    PlanCase c = plan_case(sum, points, points, 50);
    const Plan plan = c.plan();
    const auto a = c.strengths, b = test::random_numbers(a.size(), 11);
    const auto of_a = c.apply(plan);
    c.strengths = b;
    const auto of_b = c.apply(plan);
    for (std::size_t i = 0; i < a.size(); ++i) c.strengths[i] = 3 * a[i] - 0.7 * b[i];
    auto expected = of_a;
    for (std::size_t i = 0; i < of_a.size(); ++i) expected[i] = 3 * of_a[i] - 0.7 * of_b[i];
    // Rounding, amplified by the inverse on the surface, whose smallest singular values are 1e-10 of the largest but
    // carry as little of the potential.
    EXPECT_LT(relative_error(c.apply(plan), expected), 1e-11);
    std::fill(c.strengths.begin(), c.strengths.end(), 0.0);
    for (const double v : c.apply(plan)) ASSERT_EQ(v, 0);
  }
}

TEST(Plan, SetsTogetherGiveWhatEachGivesAlone) {
  // Rounding only, as above. Graded points, so that every kind of work has sets.
  Vec3Column points = sphere_points(2500, 12);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (i % 2 == 0) points.set(i, Vec3{1, 0, 0} + (points[i] - Vec3{1, 0, 0}) * 1e-3);
  for (const PairSum sum : {PairSum::kKelvinStress, PairSum::kElasticValue, PairSum::kDipoleGradient}) {
    PlanCase c = plan_case(sum, points, points, 40);
    const Plan plan = c.plan();
    std::vector<double> all, expected;
    for (const double scale : {1.0, 1e-6, 1e5}) {
      c.strengths = test::random_numbers(c.strengths.size(), static_cast<std::uint64_t>(20 + std::log10(scale)));
      for (double& s : c.strengths) s *= scale;
      all.insert(all.end(), c.strengths.begin(), c.strengths.end());
      const auto alone = c.apply(plan);
      expected.insert(expected.end(), alone.begin(), alone.end());
    }
    std::vector<double> together(expected.size());
    plan.apply(all, together, 3);
    const std::size_t n = expected.size() / 3;
    for (std::size_t set = 0; set < 3; ++set) {
      const auto part = [&](const std::vector<double>& v) {
        return std::vector<double>(v.begin() + static_cast<std::ptrdiff_t>(set * n),
                                   v.begin() + static_cast<std::ptrdiff_t>((set + 1) * n));
      };
      EXPECT_LT(relative_error(part(together), part(expected)), 1e-11) << set;
    }
  }
}

// Outputs of a sum whose lengths, strengths and constants are multiplied.
std::vector<double> scaled(PlanCase c, double length, double strength, double constant) {
  for (Vec3Column* p : {&c.sources, &c.targets})
    for (std::vector<Real>* x : {&p->x, &p->y, &p->z})
      for (Real& v : *x) v *= length;
  for (double& s : c.strengths) s *= strength;
  c.constants.a *= constant, c.constants.b *= constant, c.constants.c *= constant;
  return c.apply();
}

TEST(Plan, PowersOfTwoScaleExactlyInAnyArithmetic) {
  const Vec3Column points = sphere_points(1500, 12);
  for (const Arithmetic a : kArithmetics)
    for (const PairSum sum : {PairSum::kLaplaceValue, PairSum::kKelvinTraction, PairSum::kDipoleValue}) {
      const PlanCase c = plan_case(sum, points, points, 40, a);
      const double power = output_power(sum, 0) + (sum == PairSum::kDipoleValue ? 1 : 0);
      const auto one = c.apply();
      for (const double length : {0x1p-30, 0x1p30})
        for (const double strength : {0x1p-30, 0x1p30})
          for (const double constant : {0x1p-30, 0x1p30}) {
            const auto other = scaled(c, length, strength, constant);
            const double factor = strength * constant / std::pow(length, power);
            for (std::size_t i = 0; i < one.size(); ++i) ASSERT_EQ(other[i], one[i] * factor);
          }
    }
}

TEST(Plan, UnitsDoNotMatter) {
  const Vec3Column points = sphere_points(2500, 13);
  const PlanCase c = plan_case(PairSum::kKelvinStress, points, points, 40, Arithmetic::kFloat);
  const auto right = c.direct();
  for (const double length : {1e-9, 1e9})
    for (const double other : {1e-9, 1e9}) {
      auto out = scaled(c, length, other, 1 / (other * other));
      for (double& v : out) v *= length * length * other;
      EXPECT_LT(relative_error(out, right), 1e-4);
    }
}

TEST(SlowPlan, LargeSurfacesMeetTheirTolerance) {
  const Vec3Column points = sphere_points(220332, 14);
  std::vector<std::uint32_t> some;
  Random random(15);
  for (int i = 0; i < 1000; ++i) some.push_back(static_cast<std::uint32_t>(random.next() % points.size()));
  for (const PairSum sum : {PairSum::kKelvinValue, PairSum::kLaplaceValue, PairSum::kElasticValue})
    for (const auto& [arithmetic, tolerance] : {std::pair{Arithmetic::kFloat, 1e-4},
                                                {Arithmetic::kDouble, 1e-4},
                                                {Arithmetic::kMixed, 1e-4},
                                                {Arithmetic::kDouble, 1e-6}}) {
      PlanCase c = plan_case(sum, points, points, 0, arithmetic, tolerance);
      const auto out = c.apply();
      c.targets.clear();
      std::vector<double> picked;
      for (const std::uint32_t i : some) c.targets.push_back(points[i]);
      for (std::size_t k = 0; k < pair_shape(sum).outputs; ++k)
        for (const std::uint32_t i : some) picked.push_back(out[k * points.size() + i]);
      EXPECT_LT(relative_error(picked, c.direct()), tolerance) << static_cast<int>(sum) << test::name(arithmetic);
    }
}

}  // namespace
}  // namespace sherd::fmm
