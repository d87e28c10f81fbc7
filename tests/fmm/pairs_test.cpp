// Laws of the sums over pairs of points, on every instruction set that this processor runs.
#include <gtest/gtest.h>

#include <limits>

#include "kernels/fmm/pairs.h"
#include "tests/fmm/pairs_reference.h"

namespace sherd::fmm {
namespace {

using test::Cloud;
using test::Expected;

// Relative to the sum of the terms' sizes: what pairs.h promises a pair, plus the rounding of up to n additions.
template <class T>
double tolerance(std::size_t n) {
  const double pair = sizeof(T) == 4 ? 1e-6 : 1e-14, rounding = static_cast<double>(std::numeric_limits<T>::epsilon());
  return pair + rounding * std::sqrt(static_cast<double>(n));
}

template <class T>
void expect_reference(PairSum sum, Instructions instructions, const Cloud<T>& cloud, const T shift[3]) {
  const auto out = test::evaluate<T>(sum, instructions, cloud.sources(), cloud.targets(), cloud.constants, shift);
  for (std::size_t i = 0; i < cloud.x[0].size(); ++i) {
    const Expected e = test::reference(sum, cloud, i, shift);
    for (std::size_t k = 0; k < out.size(); ++k) {
      const double error = static_cast<double>(std::abs(static_cast<test::Long>(out[k][i]) - e.value[k]));
      ASSERT_LE(error, tolerance<T>(cloud.y[0].size()) * static_cast<double>(e.size[k]))
          << "sum " << static_cast<int>(sum) << " instructions " << static_cast<int>(instructions) << " number " << k
          << " target " << i;
    }
  }
}

template <class T>
class PairSums : public testing::Test {};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(PairSums, Numbers);

TYPED_TEST(PairSums, EverySumIsItsFormulaWithShiftAndAnyNumberOfSourcesAndTargets) {
  using T = TypeParam;
  Random random(1);
  const T shift[3] = {T(0.25), T(-0.5), T(0.125)};
  for (const PairSum sum : test::all_sums())
    for (const Instructions instructions : test::available())
      for (const auto& [targets, sources] :
           {std::pair{16, 0}, {16, 1}, {16, 17}, {32, 5}, {48, 130}, {0, 9}, {80, 300}})
        expect_reference<T>(sum, instructions,
                            Cloud<T>(static_cast<std::size_t>(targets), static_cast<std::size_t>(sources), random),
                            shift);
}

TYPED_TEST(PairSums, CloseAndDistantPairsKeepTheirRelativeAccuracy) {
  using T = TypeParam;
  Random random(2);
  const T none[3]{};
  // One source: nothing hides the error of a pair. Distances from 1e-6 to 1e6.
  for (const PairSum sum : test::all_sums())
    for (const Instructions instructions : test::available())
      for (int n = 0; n < 20; ++n) {
        Cloud<T> cloud(16, 1, random);
        for (int k = 0; k < 3; ++k)
          for (std::size_t i = 0; i < 16; ++i) {
            const double distance = std::pow(10.0, random.uniform(-6, 6));
            cloud.x[k][i] = static_cast<T>(static_cast<double>(cloud.y[k][0]) + distance * random.uniform(-1, 1));
          }
        expect_reference<T>(sum, instructions, cloud, none);
      }
}

TEST(PairSumsInDouble, AnyScaleFromNanometresToLightYearsKeepsTheAccuracy) {
  Random random(3);
  const double none[3]{};
  for (const double scale : {1e-30, 1e-12, 1e-9, 1e9, 1e16, 1e30})
    for (const PairSum sum : test::all_sums())
      for (const Instructions instructions : test::available())
        expect_reference<double>(sum, instructions, Cloud<double>(16, 40, random, scale), none);
}

TYPED_TEST(PairSums, CoincidentPairsAddNothing) {
  using T = TypeParam;
  Random random(4);
  const T none[3]{};
  for (const PairSum sum : test::all_sums())
    for (const Instructions instructions : test::available()) {
      Cloud<T> cloud(32, 32, random);
      for (int k = 0; k < 3; ++k) cloud.y[k] = cloud.x[k];
      expect_reference<T>(sum, instructions, cloud, none);
      // All sources at one target: exact zeros there.
      for (int k = 0; k < 3; ++k) std::fill(cloud.y[k].begin(), cloud.y[k].end(), cloud.x[k][7]);
      for (const auto& column :
           test::evaluate<T>(sum, instructions, cloud.sources(), cloud.targets(), cloud.constants, none))
        EXPECT_EQ(column[7], T(0));
    }
}

TYPED_TEST(PairSums, SumsAreAddedToWhatIsThere) {
  using T = TypeParam;
  Random random(5);
  const T none[3]{};
  const Cloud<T> cloud(16, 20, random);
  for (const PairSum sum : test::all_sums())
    for (const Instructions instructions : test::available()) {
      const auto once = test::evaluate<T>(sum, instructions, cloud.sources(), cloud.targets(), cloud.constants, none);
      auto twice = once;
      T* columns[kMaxOutputs]{};
      for (std::size_t k = 0; k < twice.size(); ++k) columns[k] = twice[k].data();
      pair_function<T>(sum, instructions)(cloud.sources(), cloud.targets(), none, cloud.constants, columns);
      for (std::size_t k = 0; k < twice.size(); ++k)
        for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(twice[k][i], 2 * once[k][i]);  // a + a is exact
    }
}

TYPED_TEST(PairSums, ATargetsBitsDoNotDependOnItsPlaceAmongOthers) {
  using T = TypeParam;
  Random random(6);
  const T none[3]{};
  const Cloud<T> cloud(80, 200, random);
  for (const PairSum sum : test::all_sums())
    for (const Instructions instructions : test::available()) {
      const auto all = test::evaluate<T>(sum, instructions, cloud.sources(), cloud.targets(), cloud.constants, none);
      for (const std::size_t from : {std::size_t{0}, std::size_t{5}, std::size_t{61}}) {
        PairTargets<T> part = cloud.targets();
        part.count = 16;
        for (int k = 0; k < 3; ++k) part.x[k] += from, part.normal[k] += from;
        const auto some = test::evaluate<T>(sum, instructions, cloud.sources(), part, cloud.constants, none);
        for (std::size_t k = 0; k < all.size(); ++k)
          for (std::size_t i = 0; i < 16; ++i) ASSERT_EQ(some[k][i], all[k][from + i]);
      }
    }
}

// The sum of `value` at 16 targets, moved by d along axis k.
std::vector<std::vector<double>> moved(PairSum value, const Cloud<double>& cloud, int k, double d) {
  double shift[3]{};
  shift[k] = d;
  return test::evaluate<double>(value, best_instructions(), cloud.sources(), cloud.targets(), cloud.constants, shift);
}

TEST(PairSumsInDouble, GradientsAreTheDerivativesOfTheValues) {
  struct Pair {
    PairSum value, gradient;
    std::size_t values, first;  // numbers of the value; where its gradient starts
  };
  Random random(7);
  Cloud<double> cloud(16, 30, random);
  for (auto& c : cloud.x[0]) c += 3;  // distances >= 1: fifth derivatives and sums of the order of 30 * 100
  const double h = 1e-3;              // fourth-order differences: 3e3 h^4 / 30 = 1e-10, rounding 30 * 1e-16 / h = 3e-12
  const double none[3]{};
  for (const Pair& p : {Pair{PairSum::kLaplaceValue, PairSum::kLaplaceGradient, 1, 1},
                        Pair{PairSum::kDipoleValue, PairSum::kDipoleGradient, 1, 1},
                        Pair{PairSum::kKelvinValue, PairSum::kKelvinGradient, 3, 0}}) {
    const auto g = test::evaluate<double>(p.gradient, best_instructions(), cloud.sources(), cloud.targets(),
                                          cloud.constants, none);
    for (int k = 0; k < 3; ++k) {
      const auto a = moved(p.value, cloud, k, h), b = moved(p.value, cloud, k, -h), c = moved(p.value, cloud, k, 2 * h),
                 d = moved(p.value, cloud, k, -2 * h);
      for (std::size_t m = 0; m < p.values; ++m)
        for (std::size_t i = 0; i < 16; ++i)
          EXPECT_NEAR(g[p.first + 3 * m + static_cast<std::size_t>(k)][i],
                      (8 * (a[m][i] - b[m][i]) - (c[m][i] - d[m][i])) / (12 * h), 1e-9);
    }
  }
}

TYPED_TEST(PairSums, StressIsHookeOfTheGradientAndTractionIsStressTimesNormal) {
  using T = TypeParam;
  Random random(8);
  const T none[3]{};
  Cloud<T> cloud(32, 60, random);
  for (auto& c : cloud.x[1]) c += T(2.5);          // sums of size 60: no close pair outweighs the others
  const double near = 60 * 20 * tolerance<T>(60);  // 60 pairs of up to 20 (lambda, mu, 3 b, f of size 1)
  for (const Instructions instructions : test::available()) {
    const auto run = [&](PairSum sum) {
      return test::evaluate<T>(sum, instructions, cloud.sources(), cloud.targets(), cloud.constants, none);
    };
    const auto g = run(PairSum::kKelvinGradient), s = run(PairSum::kKelvinStress), t = run(PairSum::kKelvinTraction);
    const PairConstants<T>& c = cloud.constants;
    for (std::size_t i = 0; i < 32; ++i) {
      const T trace = c.lambda * (g[0][i] + g[4][i] + g[8][i]);
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(s[k][i], trace + 2 * c.mu * g[4 * k][i], near);
      EXPECT_NEAR(s[3][i], c.mu * (g[5][i] + g[7][i]), near);
      EXPECT_NEAR(s[4][i], c.mu * (g[2][i] + g[6][i]), near);
      EXPECT_NEAR(s[5][i], c.mu * (g[1][i] + g[3][i]), near);
      const T n[3] = {cloud.normal[0][i], cloud.normal[1][i], cloud.normal[2][i]};
      EXPECT_NEAR(t[0][i], s[0][i] * n[0] + s[5][i] * n[1] + s[4][i] * n[2], near);
      EXPECT_NEAR(t[1][i], s[5][i] * n[0] + s[1][i] * n[1] + s[3][i] * n[2], near);
      EXPECT_NEAR(t[2][i], s[4][i] * n[0] + s[3][i] * n[1] + s[2][i] * n[2], near);
    }
  }
}

TYPED_TEST(PairSums, ElasticIsKelvinAndLaplaceAndDipole) {
  using T = TypeParam;
  Random random(9);
  const T none[3]{};
  Cloud<T> cloud(16, 50, random);
  for (auto& c : cloud.x[2]) c += T(2.5);
  const double near = 50 * 20 * tolerance<T>(50);
  for (const Instructions instructions : test::available()) {
    // Row i of the parts: strengths rearranged for the sums of one component.
    const auto part = [&](PairSum sum, std::initializer_list<std::size_t> columns) {
      PairSources<T> s = cloud.sources();
      std::size_t k = 0;
      for (const std::size_t c : columns) s.strength[k++] = cloud.strength[c].data();
      return test::evaluate<T>(sum, instructions, s, cloud.targets(), cloud.constants, none);
    };
    const auto value = part(PairSum::kElasticValue, {0, 1, 2, 3, 4, 5, 6, 7, 8});
    const auto gradient = part(PairSum::kElasticGradient, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11});
    const auto u = part(PairSum::kKelvinValue, {0, 1, 2}), du = part(PairSum::kKelvinGradient, {0, 1, 2});
    for (std::size_t k = 0; k < 3; ++k) {
      const auto w = part(PairSum::kDipoleValue, {3 + k, 6, 7, 8});
      const auto dg = part(PairSum::kLaplaceGradient, {3 + k}), dw = part(PairSum::kDipoleGradient, {6 + k, 9, 10, 11});
      for (std::size_t i = 0; i < 16; ++i) {
        EXPECT_NEAR(value[k][i], u[k][i] + w[0][i], near);
        for (std::size_t m = 0; m < 3; ++m)
          EXPECT_NEAR(gradient[3 * k + m][i], du[3 * k + m][i] + dg[1 + m][i] + dw[1 + m][i], near);
      }
    }
  }
}

TEST(Instructions, ThoseThatAreMissingFallBackToTheBest) {
  for (const PairSum sum : test::all_sums()) {
    EXPECT_EQ(pair_function<float>(sum), pair_function<float>(sum, best_instructions()));
    for (const Instructions i : {Instructions::kAvx2, Instructions::kAvx512})
      if (i > best_instructions()) {
        EXPECT_EQ(pair_function<double>(sum, i), pair_function<double>(sum));
      }
  }
}

}  // namespace
}  // namespace sherd::fmm
