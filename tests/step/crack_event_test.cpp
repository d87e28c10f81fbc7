// The laws of an event's cracks under given stress fields: a crack either ends in valid pieces or leaves everything as
// it was; volume is accounted for; stopped cracks stay; one bad crack never stops the others.
#include "engine/step/crack_event.h"

#include <gtest/gtest.h>

#include <cmath>
#include <new>
#include <numbers>

#include "engine/fracture/synthetic_fields.h"
#include "engine/mesh/certificate.h"
#include "engine/mesh/shapes.h"
#include "engine/step/guided_event.h"
#include "engine/step/refit_piece.h"
#include "kernels/core/error.h"
#include "kernels/core/fault.h"
#include "tests/fracture/helicoid.h"

namespace sherd {
namespace {

constexpr Real kEdge = 0.15, kThickness = 1e-3;

// A bar along x, 3 by 1 by 1.
struct Bar {
  std::shared_ptr<const SurfaceMesh> mesh = std::make_shared<SurfaceMesh>(make_bar(3, 1, 1, 0.2));
  RootScale root{kEdge, signed_volume(*mesh), bounding_box(*mesh).diagonal(), 0};
  Solid solid{mesh, root};
  FractureOptions options;
  FractureResult result;

  Bar() {
    options.fields = {constant_field(1), constant_field(1), constant_field(kThickness)};
    options.net_section = false;
    options.min_fragment_volume = 1e-6;
    result.volume_before = root.volume;
  }
};

CrackSeed seed_below(Real x) {
  return {{x, -0.5, 0.013}, {0, -1, 0}, {2, {1, 0, 0}}, kNone};
}

// Tension along x below the height `stop`, none above.
FunctionField tension_below(Real stop) {
  return FunctionField([stop](const Vec3& x) { return PrincipalStress{x.y < stop ? 2.0 : 0.0, {1, 0, 0}}; });
}

void expect_valid(const FractureResult& result) {
  for (const FragmentShape& shape : result.shapes)
    for (const auto& mesh : {shape.clean, shape.shown}) {
      const MeshCertificate c = certify(*mesh);
      EXPECT_TRUE(c.ok()) << c.first_defect;
    }
}

void expect_balance(FractureResult& result) {
  measure(result);
  const Real rest = result.volume_before - result.removed_volume - result.dust_volume + result.remeshing_volume;
  EXPECT_NEAR(result.volume_after, rest, 1e-12 * result.volume_before);
}

TEST(CrackEvent, ACrackThroughGivesTwoPiecesAndItsRecordSaysAll) {
  Bar bar;
  bar.options.first_crack_id = 7, bar.options.generation = 2;
  const FunctionField field = tension_below(10);
  const CrackSeed seed = seed_below(0.21);
  CrackEvent event(bar.solid, bar.options, bar.result);
  event.start(field, {&seed, 1});
  event.finish();
  ASSERT_EQ(bar.result.shapes.size(), 2u);
  expect_valid(bar.result), expect_balance(bar.result);
  ASSERT_EQ(bar.result.cracks.size(), 1u);
  const CrackRecord& c = bar.result.cracks[0];
  EXPECT_EQ(c.outcome, "complete");
  EXPECT_EQ(c.id, 7);
  EXPECT_EQ(bar.result.next_crack_id, 8);
  EXPECT_EQ(c.generation, 2);
  EXPECT_EQ(c.seed, seed.position);
  EXPECT_EQ(c.stress, 2);
  EXPECT_EQ(c.ladder_level, 0);
  EXPECT_GT(c.steps, 3);
  EXPECT_EQ(c.fragments, 2u);
  // A plane across a flat box: area and outline are exact but for rounding of the sheet's border.
  EXPECT_NEAR(c.area, 1, 1e-3);
  EXPECT_NEAR(c.length, 4, 0.02);
  EXPECT_NEAR(c.removed_volume, kThickness * 1, 1e-5 * kThickness + 1e-3 * kThickness);
  EXPECT_LT(c.volume_error, 1e-13);
}

TEST(CrackEvent, AStoppedCrackRemovesNothingAndIsShownAsANotch) {
  Bar bar;
  const FunctionField field = tension_below(0.1);
  const CrackSeed seed = seed_below(0.21);
  CrackEvent event(bar.solid, bar.options, bar.result);
  event.start(field, {&seed, 1});
  event.finish();
  ASSERT_EQ(bar.result.shapes.size(), 1u);
  const FragmentShape& shape = bar.result.shapes[0];
  EXPECT_EQ(shape.clean, bar.mesh);  // the very mesh: stress goes on being solved on it
  ASSERT_EQ(shape.partial.size(), 1u);
  expect_valid(bar.result), expect_balance(bar.result);
  const CrackRecord& c = bar.result.cracks[0];
  EXPECT_EQ(c.outcome, "arrested");
  EXPECT_EQ(c.removed_volume, 0);
  EXPECT_EQ(bar.result.removed_volume, 0);
  // The notch tapers to nothing at its front, over the last row of the sheet (up to an edge).
  EXPECT_LT(bar.result.notch_volume, kThickness * c.area);
  EXPECT_GT(bar.result.notch_volume, kThickness * (c.area - kEdge * 1.3));
}

// Across the bar's height inside the strip |z| < half, none elsewhere.
FunctionField lift(Real half) {
  return FunctionField([half](const Vec3& x) { return PrincipalStress{std::abs(x.z) < half ? 2.0 : 0.0, {0, 1, 0}}; });
}

CrackSeed seed_at_end() {
  return {{1.5, -0.217, 0.013}, {1, 0, 0}, {2, {0, 1, 0}}, kNone};
}

TEST(CrackEvent, ACrackEndsAtAStoppedOneAndGoesOnOnceThatGoesThrough) {
  for (const bool wide : {true, false}) {
    Bar bar;
    const CrackSeed notch = seed_below(0.21), across = seed_at_end();
    CrackEvent event(bar.solid, bar.options, bar.result);
    event.start(tension_below(0.1), {&notch, 1});
    event.start(lift(wide ? 10 : 0.2), {&across, 1});
    event.finish();
    ASSERT_EQ(bar.result.cracks.size(), 2u);
    EXPECT_EQ(bar.result.cracks[1].outcome, "arrested") << bar.result.cracks[1].reason;
    EXPECT_EQ(bar.result.cracks[1].met, std::vector<std::int32_t>{bar.result.cracks[0].id});
    // From the bar's end to the notch, over the bar's width or the strip's (to an edge on either side).
    EXPECT_NEAR(bar.result.cracks[1].area, (1.5 - 0.21) * (wide ? 1 : 0.4), wide ? 0.05 : (1.5 - 0.21) * 2 * kEdge);
    ASSERT_EQ(bar.result.shapes.size(), 1u);
    ASSERT_EQ(bar.result.shapes[0].partial.size(), 2u);
    expect_valid(bar.result), expect_balance(bar.result);

    bar.solid.partial = bar.result.shapes[0].partial;
    FractureResult later;
    later.volume_before = bar.root.volume;
    bar.options.first_crack_id = bar.result.next_crack_id;
    CrackEvent next(bar.solid, bar.options, later);
    next.resume(FunctionField([](const Vec3& x) {
                  return PrincipalStress{std::abs(x.x - 0.21) < 0.1 ? 2.0 : 0.0, {1, 0, 0}};
                }),
                false);
    next.finish();
    EXPECT_EQ(later.cracks[0].outcome, "complete");
    EXPECT_EQ(later.cracks[0].cause, CrackCause::kResumed);
    // The wide one had only the notch's wall to reach; the narrow one stays, in one of the two pieces.
    ASSERT_EQ(later.shapes.size(), wide ? 3u : 2u);
    std::size_t stopped = 0;
    for (const FragmentShape& shape : later.shapes) stopped += shape.partial.size();
    EXPECT_EQ(stopped, wide ? 0u : 1u);
    expect_valid(later), expect_balance(later);
  }
}

// The ring of a stopped crack closes and cuts the torus; its wing goes on to the ring's wall and, without stress where
// it began, stops there.
TEST(CrackEvent, TheWingOfARingGoesOnInThePieceItLiesIn) {
  const auto mesh = std::make_shared<SurfaceMesh>(helicoid::torus().mesh);
  const RootScale root{helicoid::torus().h, signed_volume(*mesh), bounding_box(*mesh).diagonal(), 0};
  Solid solid{mesh, root};
  FractureOptions options;
  options.fields = {constant_field(0.5), constant_field(0.5), constant_field(kThickness)};
  options.net_section = false, options.first_crack_id = 1;
  solid.partial = {{helicoid::strip(), 0, {}}};
  FractureResult result;
  result.volume_before = root.volume;
  CrackEvent event(solid, options, result);
  event.resume(FunctionField(helicoid::helicoids()), false);
  event.finish();
  ASSERT_EQ(result.cracks.size(), 2u);
  EXPECT_EQ(result.cracks[0].outcome, "complete") << result.cracks[0].reason;
  EXPECT_EQ(result.cracks[0].ladder_level, 0);
  EXPECT_EQ(result.cracks[1].outcome, "arrested") << result.cracks[1].reason;
  ASSERT_EQ(result.shapes.size(), 2u);
  EXPECT_EQ(result.shapes[0].partial.size() + result.shapes[1].partial.size(), 1u);
  expect_valid(result), expect_balance(result);
}

// Throws from the n-th call on.
class FailingField final : public CrackField {
 public:
  FailingField(const CrackField& field, int calls, std::function<void()> fail)
      : field_(field), calls_(calls), fail_(std::move(fail)) {}
  void principal_stress(const Vec3Column& points, std::vector<PrincipalStress>& out) const override {
    if (calls_-- <= 0) fail_();
    field_.principal_stress(points, out);
  }

 private:
  const CrackField& field_;
  mutable int calls_;
  std::function<void()> fail_;
};

TEST(CrackEvent, WhateverIsThrownDropsThatCrackAlone) {
  const FunctionField good = tension_below(10);
  const std::vector<std::pair<std::string, std::function<void()>>> failures = {
      {"a broken invariant", [] { throw InternalError("a broken invariant"); }},
      {"an input", [] { throw InputError("an input"); }},
      {std::bad_alloc().what(), [] { throw std::bad_alloc(); }}};
  for (const auto& [reason, fail] : failures)
    for (const int calls : {0, 4}) {
      Bar bar;
      const SurfaceMesh before = *bar.mesh;
      const FailingField bad(good, calls, fail);
      const CrackSeed first = seed_below(-0.8), second = seed_below(0.21);
      CrackEvent event(bar.solid, bar.options, bar.result);
      event.start(bad, {&first, 1});
      EXPECT_FALSE(bar.result.changed);
      EXPECT_EQ(*bar.mesh, before);
      ASSERT_EQ(bar.result.cracks.size(), 1u);
      EXPECT_EQ(bar.result.cracks[0].outcome, "failed");
      EXPECT_EQ(bar.result.cracks[0].reason, reason);
      event.start(good, {&second, 1});  // the run goes on
      event.finish();
      EXPECT_EQ(bar.result.shapes.size(), 2u);
      EXPECT_EQ(bar.result.cracks[1].outcome, "complete");
    }
}

// T13 at the level of the event: a fault at any point of thickening and cutting leaves the pieces that were there.
TEST(CrackEvent, AFaultAnywhereInACutLeavesThePiecesAsTheyWere) {
  const FunctionField field = tension_below(10);
  const CrackSeed first = seed_below(-0.8), second = seed_below(0.21);
  std::size_t points = 0;  // of a crack that goes through
  {
    Bar bar;
    CrackEvent event(bar.solid, bar.options, bar.result);
    event.start(field, {&first, 1});
    const FaultPlan plan(FaultPlan::kNever);
    event.start(field, {&second, 1});
    points = plan.seen();
  }
  EXPECT_GT(points, 5u);
  for (std::size_t at = 0; at < points; ++at) {
    Bar bar;
    CrackEvent event(bar.solid, bar.options, bar.result);
    event.start(field, {&first, 1});
    {
      const FaultPlan plan(at);
      event.start(field, {&second, 1});
    }
    ASSERT_EQ(bar.result.cracks.size(), 2u);
    const CrackRecord& c = bar.result.cracks[1];
    event.finish();
    expect_valid(bar.result), expect_balance(bar.result);
    EXPECT_EQ(bar.result.shapes.size(), c.outcome == "complete" ? 3u : 2u) << at;
    EXPECT_EQ(c.reason.empty(), c.outcome == "complete") << at;
  }
  EXPECT_GT(points, 1u);
}

TEST(CrackEvent, SeedsNearACrackOfTheEventStartNothing) {
  Bar bar;
  const FunctionField field = tension_below(10);
  const std::vector<CrackSeed> seeds = {seed_below(0.21), seed_below(0.21 + 1.5 * kEdge), seed_below(-0.9)};
  CrackEvent event(bar.solid, bar.options, bar.result);
  event.start(field, seeds);
  event.finish();
  EXPECT_EQ(bar.result.cracks.size(), 2u);
  EXPECT_EQ(bar.result.shapes.size(), 3u);
  expect_valid(bar.result), expect_balance(bar.result);
}

TEST(CrackEvent, CracksAndPiecesKeepToTheirLimits) {
  const FunctionField field = tension_below(10);
  const std::vector<CrackSeed> seeds = {seed_below(0.21), seed_below(-0.9), seed_below(1.1)};
  for (const auto& [cracks, pieces, expected] : {std::array<std::size_t, 3>{2, 10, 3}, {8, 2, 2}, {0, 10, 0}}) {
    Bar bar;
    bar.options.max_cracks = static_cast<int>(cracks), bar.options.max_pieces = pieces;
    CrackEvent event(bar.solid, bar.options, bar.result);
    event.start(field, seeds);
    event.finish();
    EXPECT_EQ(bar.result.shapes.size(), expected);
  }
}

TEST(CrackEvent, DustIsDroppedAndCountedOrKept) {
  // A slice of 0.03 at the bar's end: 0.01 of the volume.
  const FunctionField field = tension_below(10);
  const CrackSeed seed = seed_below(1.47);
  for (const DustRule rule : {DustRule::kDrop, DustRule::kKeep}) {
    Bar bar;
    bar.options.min_fragment_volume = 0.05, bar.options.dust = rule;
    CrackEvent event(bar.solid, bar.options, bar.result);
    event.start(field, {&seed, 1});
    event.finish();
    ASSERT_EQ(bar.result.cracks.size(), 1u);
    EXPECT_EQ(bar.result.cracks[0].outcome, "complete") << bar.result.cracks[0].reason;
    expect_valid(bar.result), expect_balance(bar.result);
    EXPECT_EQ(bar.result.shapes.size(), rule == DustRule::kDrop ? 1u : 2u);
    const Real dust = rule == DustRule::kDrop ? 0.03 - 0.5 * kThickness : 0;
    EXPECT_NEAR(bar.result.dust_volume, dust, 1e-4);
    EXPECT_EQ(bar.result.cracks[0].dust_volume, bar.result.dust_volume);
  }
}

TEST(RefitPiece, ASmallPieceGetsShorterEdgesSoThatItCanCrackOn) {
  const RootScale root{kEdge, 3, 3.3, 0};
  EXPECT_EQ(piece_edge_length(make_box({1, 1, 1}, 0.2), root), kEdge);
  for (const Vec3& size : {Vec3{0.4, 0.3, 0.3}, Vec3{0.5, 0.1, 0.5}, Vec3{0.9, 0.2, 0.1}}) {
    const SurfaceMesh piece = make_box(size, 0.2);
    EXPECT_LT(piece_edge_length(piece, root), 0.9 * kEdge);
    SurfaceMesh fit;
    const RefitReport report = refit_piece(piece, root, fit);
    ASSERT_TRUE(report.ok) << report.reason;
    EXPECT_TRUE(certify(fit).ok());
    // Meshes of the target edge have up to a third fewer triangles than equilateral ones would be.
    EXPECT_GT(fit.triangle_count(), static_cast<std::size_t>(kLeastTriangles) * 2 / 3);
    EXPECT_LT(fit.triangle_count(), static_cast<std::size_t>(kLeastTriangles) * 3);
  }
}

TEST(CrackEvent, StrengthFieldsDecideWhereACrackStops) {
  // The same tension everywhere; the upper half is stronger than it.
  class Halves final : public ScalarField {
    Real at(const Vec3& x) const override { return x.y > 0.1 ? 3 : 1; }
    Real lower() const override { return 1; }
    Real upper() const override { return 3; }
  };
  Bar bar;
  bar.options.fields.propagation_strength = std::make_shared<Halves>();
  const FunctionField field = tension_below(10);
  const CrackSeed seed = seed_below(0.21);
  CrackEvent event(bar.solid, bar.options, bar.result);
  event.start(field, {&seed, 1});
  event.finish();
  ASSERT_EQ(bar.result.cracks.size(), 1u);
  EXPECT_EQ(bar.result.cracks[0].outcome, "arrested") << bar.result.cracks[0].reason;
  EXPECT_NEAR(bar.result.cracks[0].area, 0.6, kEdge);
}

// Up along x = 0 to the bar's middle plane, and back down at `turn` degrees from where it came.
SurfaceMesh hairpin(Real turn) {
  const Real a = turn * std::numbers::pi / 180;
  SurfaceMesh guide;
  for (const Vec3& p : {Vec3{0, -1, 0}, Vec3{0, 0, 0}, Vec3{2 * std::sin(a), -2 * std::cos(a), 0}})
    for (const Real z : {-1.0, 1.0}) guide.vertices.push_back(p + Vec3{0, 0, z});
  for (const std::uint32_t i : {0U, 2U}) guide.add_triangle(i, i + 2, i + 3), guide.add_triangle(i, i + 3, i + 1);
  return guide;
}

TEST(CrackAlong, ItsRecordSaysHowFarFromItsGuideItRanAndHowWellItIsMeshed) {
  Bar bar;
  const Vec3 normal = normalized(Vec3{1, 0.3, 0});
  bar.result = crack_along(bar.solid, GuidePlane{{0.2, 0, 0}, normal}, bar.options);
  ASSERT_EQ(bar.result.cracks.size(), 1u);
  const CrackRecord& c = bar.result.cracks[0];
  EXPECT_EQ(c.outcome, "complete") << c.reason;
  ASSERT_TRUE(c.off_guide);
  EXPECT_LE(c.off_guide->rms, c.off_guide->largest);
  EXPECT_LT(c.off_guide->largest, 1e-9 * kEdge);  // a plane is followed to rounding
  EXPECT_GT(c.sheet.triangles, 50u);
  EXPECT_GT(c.sheet.least_angle, 5);
  EXPECT_GT(c.sheet.mean_radius_ratio, 0.6);
}

TEST(CrackAlong, AGuideThatNoCrackCanTurnWithFailsWithThatReasonAndNothingChanges) {
  Bar bar;
  bar.result = crack_along(bar.solid, hairpin(25), bar.options);
  ASSERT_FALSE(bar.result.cracks.empty());
  const CrackRecord& c = bar.result.cracks[0];
  EXPECT_EQ(c.outcome, "failed");
  EXPECT_NE(c.reason.find("leaves its guide by"), std::string::npos) << c.reason;
  EXPECT_FALSE(c.off_guide);
  EXPECT_EQ(c.sheet.triangles, 0u);
}

}  // namespace
}  // namespace sherd
