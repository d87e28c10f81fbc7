// The design's T13: whatever step of a cut fails, and however, the body is as it was and the next cut works.
#include "kernels/core/fault.h"
#include "engine/fracture/thicken.h"
#include "engine/mesh/shapes.h"
#include "tests/fragment/slabs.h"

namespace sherd {
namespace {

struct Trial {
  SurfaceMesh body, slab;
};

// A piece comes off, a notch stays one piece, and a slab in the lattice needs jitter and clean-up.
std::vector<Trial> trials() {
  SlabShape shape, notch;
  shape.normal = {0.3, 0.8, 0.5}, shape.wave = 0.1, shape.centre = {0.01, 0.02, 0.03};
  notch.wedge = true, notch.thickness = 0.03, notch.half_u = 0.6, notch.half_v = 1.1;
  notch.normal = {0, 0, 1}, notch.centre = {0.43, 0.011, 0.07};
  return {{make_hollow_sphere(1, 0.5, 0.3), make_slab(shape)},
          {make_box({1, 1, 1}, 0.2), make_slab(notch)},
          {make_box({1, 1, 1}, 0.25), make_slab({})}};
}

TEST(CutFault, AFaultAtAnyStepLeavesTheBodyBitIdentical) {
  std::size_t points = 0;
  for (const Trial& trial : trials()) {
    const CutOptions options = options_for(trial.body);
    const CutBody body(trial.body);
    const SurfaceMesh before = body.mesh();
    std::size_t count = 0;
    CutResult reference;
    {
      const FaultPlan counting(FaultPlan::kNever);
      reference = cut(body, trial.slab, options);
      count = counting.seen();
    }
    ASSERT_TRUE(reference.ok) << reference.reason;
    for (std::size_t n = 0; n < count; ++n) {
      {
        const FaultPlan plan(n);
        EXPECT_THROW(cut(body, trial.slab, options), FaultInjected);
      }
      EXPECT_EQ(body.mesh(), before);
      EXPECT_EQ(cut(body, trial.slab, options).fragments, reference.fragments);
    }
    points += count;
  }
  EXPECT_GT(points, 24u);  // eight steps in each of the three, one more for every fragment and jitter
}

TEST(CutFault, AfterAFaultInTheThickeningTheSameSheetGivesTheSameSlab) {
  CrackSheet sheet;
  for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}})
    sheet.position.push_back(p), sheet.normal.push_back({0, 0, 1}), sheet.state.push_back(NodeState::kExited);
  sheet.triangles = {{0, 1, 2}};
  std::string reason;
  const auto whole = thicken(sheet, 0.1, 0, reason);
  ASSERT_TRUE(whole) << reason;
  {
    const FaultPlan plan(0);
    EXPECT_THROW(thicken(sheet, 0.1, 0, reason), FaultInjected);
  }
  EXPECT_EQ(*thicken(sheet, 0.1, 0, reason), *whole);
}

}  // namespace
}  // namespace sherd
