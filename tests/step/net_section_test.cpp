// The net-section rule: a stopped crack goes through exactly when its ligament cannot bear the section's tension.
#include "engine/fracture/net_section.h"

#include <gtest/gtest.h>

#include "engine/mesh/shapes.h"

namespace sherd {
namespace {

// Tension along x: `surface` at the bottom of a bar, falling linearly with height to `top`.
class LinearField final : public CrackField {
 public:
  LinearField(Real bottom, Real top) : bottom_(bottom), top_(top) {}
  void principal_stress(const Vec3Column& points, std::vector<PrincipalStress>& out) const override {
    out.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      out[i] = {bottom_ + (top_ - bottom_) * (points[i].y + 0.5), {1, 0, 0}};  // bar: -0.5 <= y <= 0.5
  }

 private:
  Real bottom_, top_;
};

struct Grown {
  GrowthResult result;
  GrowthOptions options;
};

Grown grow_from_below(const TriangleBvh& bar, const CrackField& field) {
  Grown g;
  g.options.edge_length = 0.15, g.options.propagation_strength = 1, g.options.thickness = 1e-3;
  const CrackSeed seed{{0.03, -0.5, 0.01}, {0, -1, 0}, {10, {1, 0, 0}}, kNone};
  g.result = grow_crack(bar, field, seed, g.options);
  return g;
}

TEST(NetSection, LigamentStressIsTheTensionOfTheSectionOverItsArea) {
  const TriangleBvh bar(make_bar(3, 1, 1, 0.2));
  const LinearField field(10, -4);  // below 1 above y = 0.143: stops there
  const Grown g = grow_from_below(bar, field);
  ASSERT_EQ(g.result.outcome, GrowthOutcome::kArrested) << g.result.reason;
  const NetSection net = net_section(bar, field, g.result.sheet, g.options);
  ASSERT_TRUE(net.complete);
  const Real stopped = area_inside(g.result.sheet, bar);
  // Section tension 3 (mean of 10 and -4, area 1) over what the crack left.
  EXPECT_NEAR(net.stress, 3 / (1 - stopped), 0.1 * 3 / (1 - stopped));  // sheet of h = 0.15 on a unit section
  EXPECT_NEAR(net.through.area, 1, 0.03);
}

TEST(NetSection, ASectionInCompressionHolds) {
  const TriangleBvh bar(make_bar(3, 1, 1, 0.2));
  const LinearField field(6, -20);
  const Grown g = grow_from_below(bar, field);
  ASSERT_EQ(g.result.outcome, GrowthOutcome::kArrested) << g.result.reason;
  EXPECT_LT(net_section(bar, field, g.result.sheet, g.options).stress, 0);
}

}  // namespace
}  // namespace sherd
