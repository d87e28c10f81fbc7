// The crack campaign in short: the robustness that the design promises, as numbers.
#include "tools/campaign/campaign.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "kernels/core/parallel.h"

namespace sherd::campaign {
namespace {

CampaignOptions of_count(std::size_t count) {
  CampaignOptions o;
  o.count = count;
  return o;
}

std::string first_invalid(const ShapeResult& result) {
  for (const JobResult& j : result.jobs)
    if (!j.report.invalid.empty()) return fmt::format("{} job {}: {}", to_string(j.field), j.index, j.report.invalid);
  return {};
}

// What holds for every crack on every body, whatever its outcome.
void expect_laws(const ShapeResult& result) {
  fmt::print("{}\n", table_row(result.all));
  EXPECT_EQ(result.all.invalid, 0u) << first_invalid(result);
  EXPECT_EQ(result.all.body_changed, 0u);
  EXPECT_GT(result.all.jobs, 0u);
}

class CrackCampaign : public testing::TestWithParam<std::string> {};

TEST_P(CrackCampaign, EveryCrackEndsInValidFragmentsOrLeavesTheBody) {
  const auto specimen = make_specimen(GetParam(), SHERD_SHARED "/meshes/dev");
  if (!specimen) GTEST_SKIP() << "no file for " << GetParam();
  expect_laws(run_shape(*specimen, of_count(2)));
}
INSTANTIATE_TEST_SUITE_P(Shapes, CrackCampaign, testing::ValuesIn(specimen_names()),
                         [](const auto& shape) { return shape.param; });

}  // namespace
}  // namespace sherd::campaign
