// Laws of the direct sum.
#include "kernels/fmm/direct.h"

#include <gtest/gtest.h>

#include <limits>

#include "kernels/core/error.h"
#include "kernels/core/parallel.h"
#include "tests/fmm/pairs_reference.h"

namespace sherd::fmm {
namespace {

using test::Cloud;

struct Problem {
  Cloud<double> cloud;
  Vec3Column sources, targets, normals;
  std::vector<double> strengths;

  Problem(std::size_t target_count, std::size_t source_count, std::uint64_t seed, double scale = 1)
      : cloud(make(target_count, source_count, seed, scale)) {
    sources = column(cloud.y), targets = column(cloud.x), normals = column(cloud.normal);
  }
  static Cloud<double> make(std::size_t targets, std::size_t sources, std::uint64_t seed, double scale) {
    Random random(seed);
    return {targets, sources, random, scale};
  }
  static Vec3Column column(const std::vector<double> (&v)[3]) {
    Vec3Column c;
    c.x = v[0], c.y = v[1], c.z = v[2];
    return c;
  }
  DirectSum direct(PairSum sum, Precision precision) {
    strengths.clear();
    for (std::size_t k = 0; k < pair_shape(sum).strengths; ++k)
      strengths.insert(strengths.end(), cloud.strength[k].begin(), cloud.strength[k].end());
    return {.sum = sum,
            .sources = sources,
            .strengths = strengths,
            .targets = targets,
            .constants = cloud.constants,
            .precision = precision,
            .target_normals = &normals};
  }
};

std::vector<double> solve(const DirectSum& d) {
  std::vector<double> out(pair_shape(d.sum).outputs * (d.subset ? d.subset->size() : d.targets.size()), 7.0);
  direct_sum(d, out);
  return out;
}

TEST(DirectSum, EverySumIsItsFormulaInBothPrecisions) {
  Problem p(150, 700, 1);
  const double none[3]{};
  for (const PairSum sum : test::all_sums())
    for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
      const auto out = solve(p.direct(sum, precision));
      for (std::size_t i = 0; i < 150; ++i) {
        const test::Expected e = test::reference(sum, p.cloud, i, none);
        // Relative to the terms' sizes. Float: pairs to 1e-6, and distances wrong by 1e-7 of a tile (size 1), which
        // among 700 sources in a box of side 2 are closer than 0.02 only rarely: 3 * 1e-7 / 0.02 of the closest term.
        const double relative = precision == Precision::kFloat ? 1.5e-5 : 2e-14;
        for (std::size_t k = 0; k < pair_shape(sum).outputs; ++k)
          ASSERT_NEAR(out[k * 150 + i], static_cast<double>(e.value[k]), relative * static_cast<double>(e.size[k]))
              << "sum " << static_cast<int>(sum) << " number " << k;
      }
    }
}

TEST(DirectSum, SingleAgreesWithDoubleInAnyUnitOfLengthAndStrength) {
  for (const double length : {1e-9, 1e9})
    for (const double strength : {1e-20, 1e25})
      for (const PairSum sum : test::all_sums()) {
        Problem p(40, 300, 2, length);
        for (auto& column : p.cloud.strength)
          for (double& s : column) s *= strength;
        // Normals are numbers of size 1; w enters with one power of the length more.
        const std::size_t normal = sum == PairSum::kElasticValue ? 6 : sum == PairSum::kElasticGradient ? 9 : 1;
        if (sum == PairSum::kElasticValue || sum == PairSum::kElasticGradient || sum == PairSum::kDipoleValue ||
            sum == PairSum::kDipoleGradient)
          for (std::size_t k = normal; k < normal + 3; ++k)
            for (double& s : p.cloud.strength[k]) s /= strength;
        if (sum == PairSum::kElasticValue || sum == PairSum::kElasticGradient)
          for (std::size_t k = normal - 3; k < normal; ++k)
            for (double& s : p.cloud.strength[k]) s *= length;
        const auto a = solve(p.direct(sum, Precision::kFloat)), b = solve(p.direct(sum, Precision::kDouble));
        for (std::size_t k = 0; k < pair_shape(sum).outputs; ++k) {
          double difference = 0, size = 0;
          for (std::size_t i = k * 40; i < (k + 1) * 40; ++i) {
            ASSERT_TRUE(std::isfinite(a[i]));
            difference += (a[i] - b[i]) * (a[i] - b[i]), size += b[i] * b[i];
          }
          EXPECT_LT(std::sqrt(difference / size), 1e-5) << "sum " << static_cast<int>(sum) << " number " << k;
        }
      }
}

TEST(DirectSum, ClosePairsKeepSinglePrecisionFarFromTheOrigin) {
  // Clusters of size 1e-4 (one tile each) in a box of size 1e3 about (1e6, 0, 0): coordinates in float would be
  // worthless.
  Problem p(256, 256, 3, 1e-4);
  for (std::size_t i = 0; i < 256; ++i) {
    const Vec3 centre{1e6 + (i < 128 ? 0 : 1e3), 0, 0};
    p.sources.set(i, p.sources[i] + centre), p.targets.set(i, p.targets[i] + centre);
  }
  const auto a = solve(p.direct(PairSum::kKelvinGradient, Precision::kFloat)),
             b = solve(p.direct(PairSum::kKelvinGradient, Precision::kDouble));
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference += (a[i] - b[i]) * (a[i] - b[i]), size += b[i] * b[i];
  EXPECT_LT(std::sqrt(difference / size), 1e-5);
}

TEST(DirectSum, TheSameBitsForAnyNumberOfThreads) {
  Problem p(1000, 500, 4);
  for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
    const DirectSum d = p.direct(PairSum::kElasticValue, precision);
    std::vector<double> one, two;
    {
      const ThreadLimit limit(1);
      one = solve(d);
    }
    {
      const ThreadLimit limit(2);
      two = solve(d);
    }
    EXPECT_EQ(one, two);
  }
}

TEST(DirectSum, ASubsetReceivesWhatItReceivesAmongAll) {
  Problem p(300, 400, 5);
  const std::vector<std::uint32_t> subset{299, 0, 17, 17, 140};
  for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
    DirectSum d = p.direct(PairSum::kKelvinTraction, precision);
    const auto all = solve(d);
    d.subset = subset;
    const auto some = solve(d);
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < subset.size(); ++i) EXPECT_EQ(some[k * 5 + i], all[k * 300 + subset[i]]);
  }
}

TEST(DirectSum, InstructionSetsAgree) {
  Problem p(100, 300, 6);
  for (const PairSum sum : test::all_sums())
    for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
      DirectSum d = p.direct(sum, precision);
      const auto best = solve(d);
      double size = 0;
      for (const double v : best) size = std::max(size, std::abs(v));
      for (const Instructions i : test::available()) {
        d.instructions = i;
        const auto other = solve(d);
        // Coordinates are the same, so only the pairs' errors differ; the largest number stands for the largest term.
        for (std::size_t k = 0; k < best.size(); ++k)
          ASSERT_NEAR(other[k], best[k], (precision == Precision::kFloat ? 4e-6 : 4e-14) * size);
      }
    }
}

TEST(DirectSum, WithoutSourcesIsZeroAndWithoutTargetsEmpty) {
  Problem none(10, 0, 7), nowhere(0, 10, 8);
  for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
    EXPECT_EQ(solve(none.direct(PairSum::kKelvinStress, precision)), std::vector<double>(60, 0.0));
    EXPECT_TRUE(solve(nowhere.direct(PairSum::kKelvinStress, precision)).empty());
  }
}

TEST(DirectSum, OnePointIsZeroOnItself) {
  Problem p(1, 1, 9);
  p.targets = p.sources;
  for (const Precision precision : {Precision::kFloat, Precision::kDouble})
    for (const PairSum sum : test::all_sums())
      for (const double v : solve(p.direct(sum, precision))) EXPECT_EQ(v, 0);
}

TEST(DirectSum, RefusesWhatDoesNotFit) {
  Problem p(4, 4, 10);
  const DirectSum good = p.direct(PairSum::kKelvinTraction, Precision::kFloat);
  std::vector<double> out(12), strange = p.strengths;
  const auto refused = [&](const DirectSum& d) { EXPECT_THROW(direct_sum(d, out), InputError); };
  direct_sum(good, out);
  const auto refused_after = [&](const auto& change) {
    DirectSum d = good;
    change(d);
    refused(d);
  };
  const std::vector<std::uint32_t> beyond{4};
  strange[5] = std::numeric_limits<double>::quiet_NaN();
  refused_after([&](DirectSum& d) { d.strengths = d.strengths.first(11); });
  refused_after([&](DirectSum& d) { d.target_normals = nullptr; });
  refused_after([&](DirectSum& d) { d.subset = beyond; });
  refused_after([&](DirectSum& d) { d.strengths = strange; });
  p.targets.y[2] = std::numeric_limits<double>::infinity();
  refused(good);
}

}  // namespace
}  // namespace sherd::fmm
