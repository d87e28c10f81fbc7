// Cracks that come round a handle and meet their own flank.
#include <gtest/gtest.h>

#include "engine/fracture/attempt.h"
#include "engine/fracture/close_ring.h"
#include "tests/fracture/helicoid.h"

namespace sherd {
namespace {

using namespace helicoid;

TEST(RingOfACrack, IsAllButWhatLiesBeyondTheFront) {
  const FunctionField field(helicoids());
  const GrowthOptions o = torus().options();
  Growth g(torus().bvh, field, o, o.edge_length, o.overshoot * o.edge_length);
  const CrackSheet whole = strip();
  ASSERT_EQ(check_topology(whole), "");
  g.restart(whole);
  const std::optional<Ring> ring = close_ring(g);
  ASSERT_TRUE(ring);
  ASSERT_EQ(ring->wings.size(), 1u);
  const CrackSheet &wing = ring->wings[0], &rest = ring->sheet;
  EXPECT_EQ(check_topology(rest), "");
  EXPECT_EQ(check_topology(wing), "");
  // On the front's side everything from the far edge of the gap on, on the other what comes before its near edge. The
  // gap reaches 2.2 h from the front, at most as much along the strip; a triangle of 0.1 rad more goes on either side,
  // and the same arc is longest seen from the axis at the inner border.
  const Real gap = 2.2 * o.edge_length / kInner + 2 * kStep, sector = 0.5 * (kOuter * kOuter - kInner * kInner);
  EXPECT_GT(sheet_area(rest), sector * (kTurn - gap));
  EXPECT_LT(sheet_area(rest), 1.01 * sector * kTurn);  // 1.01: a helicoid is steeper than its shadow
  EXPECT_GT(sheet_area(wing), sector * (kPast - gap));
  EXPECT_LT(sheet_area(wing), 1.01 * sector * kPast);
  for (const std::uint32_t v : rest.front.at(0)) EXPECT_NE(rest.state[v], NodeState::kInterior);
}

TEST(RingOfACrack, ClosesAndLeavesTheWingToGoOn) {
  const FunctionField field(helicoids());
  const GrowthOptions o = torus().options();
  Attempt attempt(torus().bvh, field, o, 0);
  attempt.growth().restart(strip());
  attempt.growth().reference_stress = 1, attempt.growth().seed_normal = {0, 1, 0};
  GrowthResult r;
  do {
    while (attempt.step()) {
    }
    r = attempt.finish();
  } while (r.outcome == GrowthOutcome::kFailed && attempt.retreat());
  ASSERT_EQ(r.outcome, GrowthOutcome::kComplete) << r.reason;
  EXPECT_EQ(r.retreats, 1);
  EXPECT_EQ(check_growth(r, torus().bvh, o), "");
  ASSERT_EQ(r.wings.size(), 1u);
  EXPECT_EQ(check_topology(r.wings[0]), "");
  EXPECT_EQ(r.sheet.front.size(), 2u);  // an annulus
}

TEST(RingOfACrack, NeedsAFrontAlongTheFlank) {
  const FunctionField field(helicoids());
  const GrowthOptions o = torus().options();
  Growth g(torus().bvh, field, o, o.edge_length, o.overshoot * o.edge_length);
  CrackSheet alone = strip();
  for (NodeState& s : alone.state)
    if (s == NodeState::kActive) s = NodeState::kExited;
  for (NodeState& s : alone.state)
    if (s == NodeState::kArrested) s = NodeState::kExited;
  g.restart(alone);
  EXPECT_FALSE(close_ring(g));
}

}  // namespace
}  // namespace sherd
