#include <gtest/gtest.h>

#include "engine/fracture/sheet_quality.h"
#include "tests/fracture/crack_support.h"

namespace sherd {
namespace {

const Specimen& sphere() {
  static const Specimen body(make_sphere(1, 0.12));
  return body;
}
const Specimen& cube() {
  static const Specimen body(make_box({1, 1, 1}, 0.08));
  return body;
}
const Specimen& hollow() {
  static const Specimen body(make_hollow_sphere(1, 0.5, 0.1));
  return body;
}

GrowthResult grow(const Specimen& body, const CrackField& field, const Vec3& near) {
  return grow_crack(body.bvh, field, body.seed_at(body.nearest_vertex(near), field), body.options());
}

bool same_sheet(const CrackSheet& a, const CrackSheet& b) {
  return a.position == b.position && a.normal == b.normal && a.state == b.state && a.triangles == b.triangles;
}

TEST(GrowCrack, ConstantFieldCutsASphereInAPlanarDisk) {
  const FunctionField field(constant_direction({1, 0, 0}));
  const GrowthResult r = grow(sphere(), field, {0, 1, 0});
  ASSERT_EQ(r.outcome, GrowthOutcome::kComplete) << r.reason;
  EXPECT_EQ(r.ladder_level, 0);
  EXPECT_EQ(check_grown(r, sphere(), sphere().options().thickness), "");
  const Real x = sphere().mesh.vertices[sphere().nearest_vertex({0, 1, 0})].x;
  // Directions stay perpendicular to e to rounding in each of some 100 steps.
  for (std::size_t v = 0; v < r.sheet.position.size(); ++v) EXPECT_NEAR(r.sheet.position[v].x, x, 1e-12);
  // The section of the inscribed polyhedron is smaller than the circle's by about h^2 / (6 R^2) = 0.3 %, the clipped
  // area by another h^2 / (16 R^2); 1 % covers both.
  EXPECT_NEAR(r.area, M_PI * (1 - x * x), 0.01 * M_PI);
  // A chord of the circle is shorter than its arc by h^2 / (24 R^2) = 0.06 %, the circle of the polyhedron by 0.15 %.
  EXPECT_NEAR(r.length, 2 * M_PI * std::sqrt(1 - x * x), 0.005 * 2 * M_PI);
}

TEST(GrowCrack, ConstantFieldCutsACubeInAUnitSquare) {
  const FunctionField field(constant_direction({0, 0, 1}));
  const GrowthResult r = grow(cube(), field, {0.5, 0.1, 0.03});
  ASSERT_EQ(r.outcome, GrowthOutcome::kComplete) << r.reason;
  EXPECT_EQ(check_grown(r, cube(), cube().options().thickness), "");
  // Flat faces and sheet: the clipped area is exact but for triangles around the four corners, divided to h / 16.
  EXPECT_NEAR(r.area, 1.0, 1e-4);
  EXPECT_NEAR(r.length, 4.0, 1e-2);  // corners cut by up to h / 16 each
}

TEST(GrowCrack, SignOfTheEigenvectorDoesNotMatter) {
  const auto f = noisy_direction({0.9, 0.3, 0.1}, 0.3, 8 * sphere().h, 5);
  const FunctionField plus(f), minus(f, -1);
  const GrowthResult a = grow(sphere(), plus, {0, 1, 0}), b = grow(sphere(), minus, {0, 1, 0});
  EXPECT_EQ(a.outcome, b.outcome);
  EXPECT_EQ(a.steps, b.steps);
  EXPECT_EQ(a.area, b.area);
  EXPECT_TRUE(same_sheet(a.sheet, b.sheet));
}

TEST(GrowCrack, TwoRunsAreBitwiseEqual) {
  const FunctionField field(rotating_direction({1, 0, 0}, {0, 1, 0}, {0, 1, 0}, 0.6));
  const GrowthResult a = grow(hollow(), field, {0, 1, 0}), b = grow(hollow(), field, {0, 1, 0});
  EXPECT_EQ(a.steps, b.steps);
  EXPECT_TRUE(same_sheet(a.sheet, b.sheet));
}

TEST(GrowCrack, SheetFollowsARotatingField) {
  // e(y) turns about z: the exact surface through the seed has slope dx/dy = -tan(rate y) and no z component.
  constexpr Real kRate = 0.5;
  const FunctionField field(rotating_direction({1, 0, 0}, {0, 0, 1}, {0, 1, 0}, kRate));
  const GrowthResult r = grow(sphere(), field, {0, 1, 0});
  ASSERT_EQ(r.outcome, GrowthOutcome::kComplete) << r.reason;
  EXPECT_EQ(r.ladder_level, 0);
  EXPECT_EQ(check_grown(r, sphere(), sphere().options().thickness), "");
  const Vec3 seed = sphere().mesh.vertices[sphere().nearest_vertex({0, 1, 0})];
  // e = (cos, sin, 0)(rate y): e . (dx, dy) = 0, so x = ln cos(rate y) / rate + constant. The front steps forward along
  // the tangent at its start (explicit Euler): error <= path x step x curvature / 2 = 2 x 0.5 h x 0.5 / 2 = 0.25 h.
  const auto exact = [&](Real y) { return std::log(std::cos(kRate * y) / std::cos(kRate * seed.y)) / kRate + seed.x; };
  for (std::size_t v = 0; v < r.sheet.position.size(); ++v)
    EXPECT_NEAR(r.sheet.position[v].x, exact(r.sheet.position[v].y), 0.25 * sphere().h + 1e-9);
}

TEST(GrowCrack, StopsWhereStressFallsBelowTheStrength) {
  constexpr Real kFloor = 0.2;  // strength 0.5 is reached at y = kFloor
  const FunctionField field([](const Vec3& p) {
    return PrincipalStress{0.5 * std::exp(2 * (p.y - kFloor)), {1, 0, 0}};
  });
  const GrowthResult r = grow(sphere(), field, {0, 1, 0});
  ASSERT_EQ(r.outcome, GrowthOutcome::kArrested) << r.reason;
  EXPECT_EQ(check_grown(r, sphere(), sphere().options().thickness), "");
  // A node learns its stress where it stands: it stops at most one step (0.8 h) past the line; exited nodes lie up to
  // 0.15 h / 0.3 farther along the surface.
  Real lowest = 1;
  for (std::size_t v = 0; v < r.sheet.position.size(); ++v) lowest = std::min(lowest, r.sheet.position[v].y);
  EXPECT_GT(lowest, kFloor - 1.3 * sphere().h);
  EXPECT_LT(lowest, kFloor + 0.1 * sphere().h);
  std::string reason;
  const auto slab = thicken(r.sheet, 0.01, 1, reason);
  ASSERT_TRUE(slab) << reason;
  EXPECT_LT(signed_volume(*slab), 0.01 * sheet_area(r.sheet));  // zero thickness at the front
}

TEST(GrowCrack, ARefusedSheetClimbsTheLadderAndTheReasonsAreKept) {
  const FunctionField field(constant_direction({1, 0, 0}));
  GrowthOptions o = sphere().options();
  const CrackSeed seed = sphere().seed_at(sphere().nearest_vertex({0, 1, 0}), field);
  int asked = 0;
  o.accept = [&](const CrackSheet& sheet) {
    EXPECT_EQ(check_sheet(sheet), "");
    return ++asked < 3 ? "refusal " + std::to_string(asked) : std::string();
  };
  const GrowthResult r = grow_crack(sphere().bvh, field, seed, o);
  ASSERT_EQ(r.outcome, GrowthOutcome::kComplete);
  EXPECT_EQ(r.ladder_level, 2);
  EXPECT_EQ(r.rungs.reason, (std::array<std::string, kRungCount>{"refusal 1", "refusal 2"}));
  EXPECT_EQ(r.reason, "refusal 1");
  o.accept = [](const CrackSheet&) { return "never"; };
  const GrowthResult never = grow_crack(sphere().bvh, field, seed, o);
  EXPECT_EQ(never.outcome, GrowthOutcome::kFailed);
  for (const std::string& reason : never.rungs.reason) EXPECT_EQ(reason, "never");
}

TEST(GrowCrack, AFieldOfStrengthStopsTheCrackWhereTheNumberWould) {
  class Layer final : public ScalarField {
   public:
    Real at(const Vec3& x) const override { return x.y > 0.2 ? 0.5 : 2; }
    Real lower() const override { return 0.5; }
    Real upper() const override { return 2; }
  } const layer;
  const FunctionField field(constant_direction({1, 0, 0}));
  GrowthOptions o = sphere().options();
  o.propagation_field = &layer;
  const CrackSeed seed = sphere().seed_at(sphere().nearest_vertex({0, 1, 0}), field);
  const GrowthResult r = grow_crack(sphere().bvh, field, seed, o);
  ASSERT_EQ(r.outcome, GrowthOutcome::kArrested) << r.reason;
  Real lowest = 1;
  for (std::size_t v = 0; v < r.sheet.position.size(); ++v) lowest = std::min(lowest, r.sheet.position[v].y);
  EXPECT_GT(lowest, 0.2 - 1.3 * sphere().h);  // one step past the layer and the overshoot
  EXPECT_LT(lowest, 0.2 + 0.1 * sphere().h);
}

TEST(GrowCrack, ResumedCrackEndsAsTheUninterruptedOne) {
  const auto base = rotating_direction({1, 0, 0}, {0, 0, 1}, {0, 1, 0}, 0.3);
  const FunctionField full(base);
  const FunctionField decaying([&](const Vec3& p) {
    PrincipalStress s = base(p);
    s.value = p.y > 0.1 ? 1 : 0.1;
    return s;
  });
  const GrowthResult whole = grow(sphere(), full, {0, 1, 0}), half = grow(sphere(), decaying, {0, 1, 0});
  ASSERT_EQ(whole.outcome, GrowthOutcome::kComplete) << whole.reason;
  ASSERT_EQ(half.outcome, GrowthOutcome::kArrested) << half.reason;
  const GrowthResult rest = resume_crack(sphere().bvh, full, half.sheet, sphere().options());
  ASSERT_EQ(rest.outcome, GrowthOutcome::kComplete) << rest.reason;
  EXPECT_EQ(check_grown(rest, sphere(), sphere().options().thickness), "");
  EXPECT_EQ(border_loops(rest.sheet).size(), border_loops(whole.sheet).size());
  EXPECT_NEAR(rest.area, whole.area, 0.01 * whole.area);  // both follow the same surface to 0.25 h in position
}

TEST(GrowCrack, ArmsAroundACavityMeet) {
  const FunctionField field(constant_direction({1, 0, 0}));
  const GrowthResult r = grow(hollow(), field, {0, 1, 0});
  ASSERT_EQ(r.outcome, GrowthOutcome::kComplete) << r.reason;
  EXPECT_EQ(r.ladder_level, 0);
  EXPECT_EQ(check_grown(r, hollow(), hollow().options().thickness), "");
  EXPECT_EQ(border_loops(r.sheet).size(), 2u);  // outside and cavity
  // The seed's offset x cancels: (1 - x^2) - (0.25 - x^2). Chords of the two circles: h^2 / (6 r^2) and clipping, the
  // inner circle's relative error being four times larger.
  EXPECT_NEAR(r.area, M_PI * (1 - 0.25), 0.015 * M_PI);
}

TEST(GrowCrack, SeedsAtCornersAndEdgesCrackOrAreRefused) {
  int cracks = 0;
  for (const Vec3& place : {Vec3{0.5, 0.5, 0.5}, Vec3{0.5, 0.5, 0}, Vec3{-0.5, 0.5, 0.1}, Vec3{-0.5, -0.5, 0.5}})
    for (const Vec3& e : {Vec3{1, 0, 0}, Vec3{0, 1, 1}, Vec3{1, -1, 0}, Vec3{1, 1, 1}, Vec3{0.2, 0.5, -0.7}}) {
      const FunctionField field(constant_direction(e));
      const GrowthResult r = grow(cube(), field, place);
      EXPECT_NE(r.outcome, GrowthOutcome::kFailed) << r.reason;
      if (r.outcome == GrowthOutcome::kRejectedSeed)
        EXPECT_FALSE(r.reason.empty());
      else
        EXPECT_EQ(check_grown(r, cube(), cube().options().thickness), "");
      cracks += r.outcome == GrowthOutcome::kComplete;
    }
  EXPECT_GE(cracks, 10);
}

TEST(GrowCrack, BadInputIsAnOutcomeNotAnException) {
  const Real nan = std::nan("");
  const FunctionField good(constant_direction({1, 0, 0}));
  const FunctionField bad([nan](const Vec3&) { return PrincipalStress{nan, {nan, nan, nan}}; });
  const CrackSeed seed = sphere().seed_at(0, good);
  GrowthOptions o = sphere().options();
  EXPECT_EQ(grow_crack(sphere().bvh, good, sphere().seed_at(0, bad), o).outcome, GrowthOutcome::kRejectedSeed);
  // Stress that is not a number never reaches the strength: the first fan is all there is.
  EXPECT_EQ(grow_crack(sphere().bvh, bad, seed, o).outcome, GrowthOutcome::kArrested);
  EXPECT_EQ(resume_crack(sphere().bvh, good, CrackSheet{}, o).outcome, GrowthOutcome::kRejectedSeed);
  o.max_steps = 2;
  EXPECT_EQ(grow_crack(sphere().bvh, good, seed, o).outcome, GrowthOutcome::kFailed);
  o = sphere().options();
  o.edge_length = 0;
  const GrowthResult r = grow_crack(sphere().bvh, good, seed, o);
  EXPECT_EQ(r.outcome, GrowthOutcome::kFailed);
  EXPECT_FALSE(r.reason.empty());
}

TEST(GrowCrack, AsksTheFieldOncePerStep) {
  const FunctionField field(constant_direction({1, 0, 0}));
  const CrackSeed seed = sphere().seed_at(sphere().nearest_vertex({0, 1, 0}), field);
  field.batches = 0;
  const GrowthResult r = grow_crack(sphere().bvh, field, seed, sphere().options());
  EXPECT_LE(field.batches, static_cast<std::size_t>(r.steps));
}

TEST(GrowCrack, EigenvectorsThatFlipFromPointToPointDoNotMatter) {
  // T7: noise of growing amplitude; each point's sign is as good as random.
  for (const Real amplitude : {0.0, 0.3, 1.0}) {
    const auto base = noisy_direction({0.9, 0.3, 0.1}, amplitude, 8 * sphere().h, 5);
    const FunctionField plain(base);
    const FunctionField flipping([&](const Vec3& p) {
      PrincipalStress s = base(p);
      if (std::fmod(std::abs(1e3 * (p.x + 2 * p.y + 3 * p.z)), 2) < 1) s.direction = -s.direction;
      return s;
    });
    const CrackSeed seed = sphere().seed_at(sphere().nearest_vertex({0, 1, 0}), plain);
    const GrowthResult a = grow_crack(sphere().bvh, plain, seed, sphere().options());
    const GrowthResult b = grow_crack(sphere().bvh, flipping, seed, sphere().options());
    EXPECT_EQ(a.outcome, b.outcome);
    EXPECT_TRUE(same_sheet(a.sheet, b.sheet)) << amplitude;
    EXPECT_EQ(check_grown(a, sphere(), sphere().options().thickness), "") << amplitude;
  }
}

// T10: e turns by 2, 6 and 12 radians over the body's diagonal, along the crack: a helicoid's arms, which must not
// spiral on.
void expect_ends_in_a_helicoid(const Specimen& body) {
  for (const Real turn : {2.0, 6.0, 12.0}) {
    const Real rate = turn / bounding_box(body.mesh).diagonal();
    const FunctionField field(rotating_direction({1, 0, 0}, {0, 1, 0}, {0, 1, 0}, rate));
    const GrowthResult r = grow(body, field, {0, 1, 0});
    EXPECT_EQ(check_grown(r, body, body.options().thickness), "") << turn;
    EXPECT_NE(r.outcome, GrowthOutcome::kFailed) << turn << ": " << r.reason;
  }
}

TEST(GrowCrack, FieldsNoSurfaceFollowsEndInAValidSheet) {
  expect_ends_in_a_helicoid(sphere());
}

TEST(SlowGrowCrack, FieldsNoSurfaceFollowsEndInAValidSheetAroundACavity) {
  expect_ends_in_a_helicoid(hollow());
}

TEST(GrowCrack, ACrackPlaneWithinAFaceOfTheBodyIsRefused) {
  const FunctionField field(constant_direction({1, 0, 0}));
  const GrowthResult r = grow(cube(), field, {0.5, 0.5, 0});
  EXPECT_EQ(r.outcome, GrowthOutcome::kRejectedSeed);
  EXPECT_FALSE(r.reason.empty());
}

TEST(GrowCrack, InnerTrianglesAreWellShaped) {
  // Random fields leave triangles of 1 degree and less on the way; flips and smoothing take them out of the inside.
  const FunctionField field(noisy_direction({0.9, 0.3, 0.1}, 0.3, 8 * sphere().h, 5));
  const GrowthResult r = grow(sphere(), field, {0, 1, 0});
  ASSERT_EQ(r.outcome, GrowthOutcome::kComplete) << r.reason;
  const SheetQuality q = sheet_quality(r.sheet);
  EXPECT_EQ(q.triangles, r.sheet.triangles.size());
  EXPECT_GT(q.mean_angle, 30);  // of at most 60
  EXPECT_GT(q.least_angle, 5);
  EXPECT_EQ(q.below_10 > 0, q.least_angle < 10);
}

TEST(SheetQuality, IsThatOfItsTriangles) {
  CrackSheet sheet;
  // An equilateral triangle of side 2 and, on one of its sides, a right one with the other leg 2 / sqrt(3).
  const Real s = std::sqrt(3.0);
  for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{2, 0, 0}, Vec3{1, s, 0}, Vec3{0, -2 / s, 0}}) sheet.position.push_back(p);
  sheet.triangles = {{0, 1, 2}, {0, 3, 1}};
  const SheetQuality q = sheet_quality(sheet);
  EXPECT_EQ(q.triangles, 2u);
  EXPECT_NEAR(q.least_angle, 30, 1e-12);
  EXPECT_NEAR(q.mean_angle, 45, 1e-12);
  // A right triangle has r = (a + b - c) / 2 and R = c / 2: with c = 4 / sqrt(3) the ratio is s - 1.
  EXPECT_NEAR(q.mean_radius_ratio, 0.5 * (1 + s - 1), 1e-15);
  EXPECT_NEAR(q.edge_ratio, 2, 1e-15);
  EXPECT_EQ(q.below_10, 0u);
  EXPECT_EQ(sheet_quality({}).triangles, 0u);
}

}  // namespace
}  // namespace sherd
