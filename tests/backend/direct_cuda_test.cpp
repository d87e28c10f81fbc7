// The device adds up what the host does. Skipped where there is no device.
#include <gtest/gtest.h>

#include "kernels/backend/direct_cuda.h"
#include "tests/fmm/pairs_reference.h"

namespace sherd::fmm {
namespace {

template <class T>
class CudaPairSums : public testing::Test {
 protected:
  void SetUp() override {
    if (cuda_device().empty()) GTEST_SKIP() << "no CUDA device";
  }
  static std::vector<std::vector<T>> on_device(PairSum sum, const test::Cloud<T>& cloud) {
    std::vector<std::vector<T>> out(pair_shape(sum).outputs, std::vector<T>(cloud.x[0].size()));
    T* columns[kMaxOutputs]{};
    for (std::size_t k = 0; k < out.size(); ++k) columns[k] = out[k].data();
    cuda_pair_sum<T>(sum, cloud.sources(), cloud.targets(), cloud.constants, columns);
    return out;
  }
};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(CudaPairSums, Numbers);

TYPED_TEST(CudaPairSums, AreTheFormulasAndTheHostsSums) {
  using T = TypeParam;
  Random random(1);
  const T none[3]{};
  // A pair's error twice (device, host) and the rounding of up to 300 additions, of the sum of the terms' sizes.
  const double tolerance = sizeof(T) == 4 ? 4e-6 : 4e-14;
  for (const PairSum sum : test::all_sums())
    for (const auto& [targets, sources] : {std::pair{16, 1}, {32, 130}, {144, 300}}) {
      const test::Cloud<T> cloud(static_cast<std::size_t>(targets), static_cast<std::size_t>(sources), random);
      const auto device = this->on_device(sum, cloud);
      const auto host =
          test::evaluate<T>(sum, best_instructions(), cloud.sources(), cloud.targets(), cloud.constants, none);
      for (std::size_t i = 0; i < cloud.x[0].size(); ++i) {
        const test::Expected e = test::reference(sum, cloud, i, none);
        for (std::size_t k = 0; k < device.size(); ++k) {
          const double allowed = tolerance * static_cast<double>(e.size[k]);
          ASSERT_NEAR(static_cast<double>(device[k][i]), static_cast<double>(e.value[k]), allowed)
              << "sum " << static_cast<int>(sum) << " number " << k;
          ASSERT_NEAR(static_cast<double>(device[k][i]), static_cast<double>(host[k][i]), allowed);
        }
      }
    }
}

TYPED_TEST(CudaPairSums, CoincidentPairsAddNothing) {
  using T = TypeParam;
  Random random(2);
  test::Cloud<T> cloud(16, 200, random);
  for (int k = 0; k < 3; ++k) std::fill(cloud.y[k].begin(), cloud.y[k].end(), cloud.x[k][3]);
  for (const PairSum sum : test::all_sums())
    for (const auto& column : this->on_device(sum, cloud)) EXPECT_EQ(column[3], T(0));
}

TYPED_TEST(CudaPairSums, TwoRunsGiveTheSameBits) {
  Random random(3);
  const test::Cloud<TypeParam> cloud(1000, 1000, random);
  EXPECT_EQ(this->on_device(PairSum::kElasticGradient, cloud), this->on_device(PairSum::kElasticGradient, cloud));
}

}  // namespace
}  // namespace sherd::fmm
