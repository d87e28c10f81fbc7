// A load is only left unsolved when it cannot start a crack: tension_bound() lies above the solved tension.
#include "tools/campaign/load_bounds.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace sherd::campaign {
namespace {

// A body skips a load when the bound is below its strength, so a load of any size on a body of any strength is missed
// exactly when its tension exceeds its bound: both grow with the load in the same proportion.
void expect_none_above(const std::vector<BoundResult>& results) {
  fmt::print("{}", to_text(results));
  for (const BoundResult& r : results) {
    ASSERT_TRUE(r.solved) << r.body << " load " << r.load << ": " << r.reason;
    EXPECT_LE(r.tension, r.bound) << r.body << " load " << r.load;
  }
}

TEST(LoadBounds, NoTensionExceedsItsBound) {
  std::vector<BoundBody> bodies = bound_bodies();
  bodies.resize(10);
  expect_none_above(check_bounds(bodies, 8, 1));
}

TEST(SlowLoadBounds, OfAThousandRandomLoadsNoCrackIsMissed) {
  const std::vector<BoundBody> bodies = bound_bodies();
  const std::size_t loads = 2 * (1000 / bodies.size() + 1);  // and as many near one of them
  const std::vector<BoundResult> results = check_bounds(bodies, loads, 1000);
  EXPECT_GE(results.size(), 2000u);
  expect_none_above(results);
}

}  // namespace
}  // namespace sherd::campaign
