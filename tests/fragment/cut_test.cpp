#include "engine/fragment/cut.h"

#include <limits>

#include "engine/mesh/shapes.h"
#include "kernels/core/parallel.h"
#include "tests/fragment/slabs.h"

namespace sherd {
namespace {

// Generic position: nothing coincides with the cube's lattice, so no jitter spoils the closed form.
TEST(Cut, ACubeLosesTheSlabAndNothingElse) {
  const SurfaceMesh body = make_box({1, 1, 1}, 0.25);
  const SurfaceMesh slab = moved(make_box({0.02, 2.3, 2.9}, 5), [](const Vec3& p) { return p + Vec3{0.137, 0, 0}; });
  const CutResult result = cut_of(body, slab);
  expect_good(body, result);
  EXPECT_EQ(result.jitters, 0);
  ASSERT_EQ(result.fragments.size(), 2u);
  EXPECT_NEAR(signed_volume(result.fragments[0]), 0.627, 1e-12);
  EXPECT_NEAR(signed_volume(result.fragments[1]), 0.353, 1e-12);
  EXPECT_NEAR(result.removed_volume, 0.02, 1e-12);
  // two square walls of the slab and what is left of the cube's sides
  EXPECT_NEAR(surface_area(result.fragments[0]) + surface_area(result.fragments[1]), 6 + 2 - 4 * 0.02, 1e-12);
}

TEST(Cut, AnObliqueSlabTakesItsCrossSectionTimesItsThickness) {
  const SurfaceMesh body = make_box({1, 1, 1}, 0.2);
  // The section of the unit cube with the plane n.x = 0, n = (1,1,1)/sqrt 3, is a hexagon of area 3 sqrt(3)/4; along
  // the normal at distance s its area is 3 sqrt(3)/4 - 3 sqrt(3) s^2, so the slab's volume is exact.
  const Real t = 0.02;
  SlabShape shape;
  shape.normal = {1, 1, 1}, shape.thickness = t, shape.cells = 5;
  const CutResult result = cut_of(body, make_slab(shape));
  expect_good(body, result);
  ASSERT_EQ(result.fragments.size(), 2u);
  const Real r3 = std::sqrt(3.0), expected = 0.75 * r3 * t - 3 * r3 * t * t * t / 12;
  // a jitter of 1e-7 h moves each wall by at most that: 2 x 1.3 m^2 x 4e-8 m
  EXPECT_NEAR(result.removed_volume, expected, result.jitters > 0 ? 1e-7 : 1e-12);
}

TEST(Cut, ASlabThatMissesChangesNoBit) {
  for (SurfaceMesh body : {make_sphere(1, 0.4), make_hollow_sphere(1, 0.5, 0.3)}) {
    number_sources(body);
    SlabShape shape;
    shape.centre = {3, 0, 0};
    const CutResult result = cut_of(body, make_slab(shape));
    expect_good(body, result);
    ASSERT_EQ(result.fragments.size(), 1u);
    EXPECT_EQ(result.fragments[0], body);
    EXPECT_NEAR(result.removed_volume, 0, 1e-12);
  }
}

TEST(Cut, ANotchLeavesOneFragmentAndTakesAWedge) {
  const SurfaceMesh body = make_box({1, 1, 1}, 0.2);
  SlabShape shape;
  shape.wedge = true, shape.thickness = 0.03, shape.cells = 4, shape.half_u = 0.6, shape.half_v = 1.1;
  shape.normal = {0, 0, 1};  // u along x for this normal: the tip is the line x = centre - half_u
  shape.centre = {0.43, 0.011, 0.07};
  const CutResult result = cut_of(body, make_slab(shape));
  expect_good(body, result);
  ASSERT_EQ(result.fragments.size(), 1u);
  // Over the first cell of length 0.3 the thickness rises linearly, then it is full up to the face x = 0.5.
  const Real tip = shape.centre.x - shape.half_u, ramp = 0.3;
  const Real area = shape.thickness * (0.5 * ramp + (0.5 - tip - ramp));
  EXPECT_NEAR(result.removed_volume, area, 1e-12);
  EXPECT_EQ(report_mesh(result.fragments[0]).genus, 0);
}

TEST(Cut, ASlabThroughTheMiddleOfAHollowSphereOpensTheCavity) {
  const SurfaceMesh body = make_hollow_sphere(1, 0.6, 0.25);
  SlabShape shape;
  shape.normal = {0.3, 0.8, 0.2}, shape.centre = {0.01, 0.02, 0.03};
  const CutResult result = cut_of(body, make_slab(shape));
  expect_good(body, result);
  ASSERT_EQ(result.fragments.size(), 2u);
  for (const SurfaceMesh& f : result.fragments) EXPECT_EQ(report_mesh(f).components, 1u);
}

TEST(Cut, ACapAwayFromTheCavityLeavesTheCavityToTheLargerPiece) {
  const SurfaceMesh body = make_hollow_sphere(1, 0.6, 0.25);
  SlabShape shape;
  shape.normal = {0.3, 0.8, 0.2}, shape.centre = 0.8 * normalized(shape.normal);
  const CutResult result = cut_of(body, make_slab(shape));
  expect_good(body, result);
  ASSERT_EQ(result.fragments.size(), 2u);
  EXPECT_EQ(report_mesh(result.fragments[0]).components, 2u);
  EXPECT_EQ(report_mesh(result.fragments[1]).components, 1u);
}

TEST(Cut, EachCavityGoesWithTheSolidAroundIt) {
  SurfaceMesh body = make_box({4, 2, 2}, 0.5);
  const SurfaceMesh hole = make_sphere(0.3, 0.2);
  Real volume = 32.0 / 2;
  for (const Real x : {-1.4, -0.6, 0.7, 1.5}) {
    const auto first = static_cast<std::uint32_t>(body.vertex_count());
    for (std::size_t i = 0; i < hole.vertex_count(); ++i) body.vertices.push_back(hole.vertices[i] + Vec3{x, 0, 0});
    for (const Triangle& t : hole.triangles) body.add_triangle(first + t[0], first + t[2], first + t[1]);
    volume -= signed_volume(hole);
  }
  EXPECT_NEAR(signed_volume(body), volume, 1e-12);
  SlabShape shape;
  shape.centre = {0.05, 0.01, 0.02}, shape.normal = {1, 0.07, 0.03}, shape.thickness = 0.02;
  const CutResult result = cut_of(body, make_slab(shape));
  expect_good(body, result);
  ASSERT_EQ(result.fragments.size(), 2u);
  for (const SurfaceMesh& f : result.fragments) EXPECT_EQ(report_mesh(f).components, 3u);
}

TEST(Cut, ASlabThroughOneArmOfATorusOpensItWithoutSeparating) {
  const SurfaceMesh body = make_torus(1, 0.3, 0.2);
  SlabShape shape;
  shape.centre = {1.01, 0.02, 0.03}, shape.normal = {0.05, 0.02, 1}, shape.half_u = 0.6, shape.half_v = 0.6;
  const CutResult result = cut_of(body, make_slab(shape));
  expect_good(body, result);
  ASSERT_EQ(result.fragments.size(), 1u);
  EXPECT_EQ(report_mesh(result.fragments[0]).genus, 0);
  shape.centre = {0, 0.01, 0.02}, shape.half_u = shape.half_v = 2;
  EXPECT_EQ(cut_of(body, make_slab(shape)).fragments.size(), 2u);
}

TEST(Cut, ASlabInsideTheBodyBecomesACavity) {
  const SurfaceMesh body = make_sphere(1, 0.3);
  SlabShape shape;
  shape.half_u = shape.half_v = 0.4;
  const SurfaceMesh slab = make_slab(shape);
  const CutResult result = cut_of(body, slab);
  expect_good(body, result);
  ASSERT_EQ(result.fragments.size(), 1u);
  EXPECT_EQ(report_mesh(result.fragments[0]).components, 2u);
  EXPECT_NEAR(result.removed_volume, signed_volume(slab), 1e-12);
}

TEST(Cut, OriginalFacesKeepTheirPlaceAndSourceAndWallsCarryTheCrack) {
  SurfaceMesh body = make_sphere(1, 0.2);
  number_sources(body);
  SlabShape shape;
  shape.wave = 0.1, shape.normal = {0.2, 1, 0.4};
  const SurfaceMesh slab = make_slab(shape);
  const CutResult result = cut_of(body, slab);
  expect_good(body, result);
  std::vector<Real> area(body.triangle_count(), 0);
  std::size_t whole = 0, walls = 0;
  for (const SurfaceMesh& f : result.fragments)
    for (std::size_t t = 0; t < f.triangle_count(); ++t) {
      if (f.faces.kind[t] == FaceKind::kCrack) {
        EXPECT_EQ(f.faces.crack[t], 7);
        EXPECT_EQ(f.faces.source[t], -1);
        ++walls;
        continue;
      }
      EXPECT_EQ(f.faces.crack[t], -1);
      const auto s = static_cast<std::size_t>(f.faces.source[t]);
      const Vec3 normal = normalized(body.area_normal2(s));
      bool same = true;
      for (int k = 0; k < 3; ++k) {
        // Rounded once: off the parent's plane by a few units in the last place of coordinates of size 1.
        EXPECT_LT(std::abs(dot(normal, f.corner(t, k) - body.corner(s, 0))), 1e-15);
        same = same && f.corner(t, k) == body.corner(s, k);
      }
      whole += same;
      area[s] += 0.5 * norm(f.area_normal2(t));
    }
  EXPECT_GT(walls, 100u);
  EXPECT_GT(whole, body.triangle_count() * 3 / 4);
  for (std::size_t s = 0; s < area.size(); ++s) {
    Box box, slab_box = bounding_box(slab);
    for (int k = 0; k < 3; ++k) box.grow(body.corner(s, k));
    const Real full = 0.5 * norm(body.area_normal2(s));
    EXPECT_LT(area[s], full * (1 + 1e-12));
    if (!box.overlaps(slab_box)) {
      EXPECT_NEAR(area[s], full, 1e-12 * full);
    }
  }
}

TEST(Cut, SmallPiecesAreDustAndTheirVolumeIsReported) {
  const SurfaceMesh body = make_box({1, 1, 1}, 0.3);
  SlabShape shape;  // a corner of legs 0.09, minus the slab
  shape.normal = {1, 1, 1}, shape.centre = Vec3{0.47, 0.471, 0.472}, shape.thickness = 0.001;
  const SurfaceMesh slab = make_slab(shape);
  CutOptions options = options_for(body);
  const CutResult both = cut(body, slab, options);
  expect_good(body, both);
  ASSERT_EQ(both.fragments.size(), 2u);
  EXPECT_EQ(both.dust_volume, 0);
  options.min_fragment_volume = 1e-3;
  const CutResult one = cut(body, slab, options);
  expect_good(body, one);
  ASSERT_EQ(one.fragments.size(), 1u);
  EXPECT_NEAR(one.dust_volume, signed_volume(both.fragments[1]), 1e-15);
  options.dust = DustRule::kKeep;
  const CutResult kept = cut(body, slab, options);
  EXPECT_EQ(kept.fragments, both.fragments);
  EXPECT_EQ(kept.dust_volume, 0);
}

// V2, and Euler's formula: each shell counts 2, each handle takes 2 off.
TEST(Cut, EulersNumberFollowsTheCutAndACompleteSlabMustSeparateWhatHasNoHandle) {
  SlabShape shape;
  shape.centre = {1.01, 0.02, 0.03}, shape.normal = {0.05, 0.02, 1}, shape.half_u = shape.half_v = 0.6;
  const SurfaceMesh torus = make_torus(1, 0.3, 0.2);
  CutOptions options = options_for(torus);
  options.complete = true;
  const CutBody body(torus);
  EXPECT_EQ(body.euler(), 0);
  const CutResult opened = cut(body, make_slab(shape), options);  // through one arm: allowed, the torus has a handle
  ASSERT_TRUE(opened.ok) << opened.reason;
  EXPECT_FALSE(opened.separated);
  EXPECT_EQ(opened.euler, 2);

  const CutBody hollow(make_hollow_sphere(1, 0.6, 0.25));
  EXPECT_EQ(hollow.euler(), 4);
  shape.centre = {0.01, 0.02, 0.03}, shape.half_u = shape.half_v = 2;
  const CutResult halves = cut(hollow, make_slab(shape), options);
  ASSERT_TRUE(halves.ok) << halves.reason;
  EXPECT_TRUE(halves.separated);
  EXPECT_EQ(halves.euler, 4);
  for (const SurfaceMesh& f : halves.fragments) EXPECT_EQ(CutBody(f).euler(), 2);

  shape.wedge = true, shape.half_u = 0.6;  // ends inside: not what it was said to be
  const CutResult notch = cut(CutBody(make_sphere(1, 0.3)), make_slab(shape), options);
  EXPECT_FALSE(notch.ok);
  EXPECT_NE(notch.reason.find("complete"), std::string::npos) << notch.reason;
}

TEST(Cut, ABodyWithinTheSlabIsRefused) {
  const CutResult result = cut_of(make_sphere(1, 0.5), make_box({4, 4, 4}, 2));
  EXPECT_FALSE(result.ok);
  EXPECT_FALSE(result.reason.empty());
  EXPECT_TRUE(result.fragments.empty());
}

TEST(Cut, BadOperandsAreRefusedWithAReason) {
  const SurfaceMesh body = make_sphere(1, 0.3);
  SlabShape shape;
  const SurfaceMesh good = make_slab(shape);
  std::vector<std::pair<SurfaceMesh, std::string>> bad;
  SurfaceMesh open = good;
  open.triangles.pop_back();
  bad.emplace_back(open, "closed");
  shape.wave = 0.5, shape.thickness = 2;  // walls far thicker than the waves are wide, and then twisted
  bad.emplace_back(moved(make_slab(shape),
                         [](const Vec3& p) {
                           return Vec3{p.x * std::cos(3 * p.y), p.y, p.z * std::sin(2 * p.x)};
                         }),
                   "");
  SurfaceMesh nan = good;
  nan.vertices.x[3] = std::numeric_limits<Real>::quiet_NaN();
  bad.emplace_back(nan, "finite");
  SurfaceMesh index = good;
  index.triangles[0][0] = 100000;
  bad.emplace_back(index, "range");
  SurfaceMesh reversed = good;
  for (Triangle& t : reversed.triangles) std::swap(t[0], t[1]);
  bad.emplace_back(reversed, "volume");
  bad.emplace_back(SurfaceMesh{}, "empty");
  for (const auto& [slab, word] : bad) {
    const CutResult result = cut_of(body, slab);
    EXPECT_FALSE(result.ok);
    EXPECT_NE(result.reason.find(word), std::string::npos) << result.reason;
    EXPECT_FALSE(result.reason.empty());
    EXPECT_TRUE(result.fragments.empty());
  }
  EXPECT_FALSE(cut_of(open, good).ok);
}

// Same pieces whatever the unit and the place of the body; a shift by 1e4 costs four digits of the coordinates, so
// volumes of size 1 keep about 1e-16 x 1e4 x area.
TEST(Cut, ScaleAndPlaceOfTheBodyDoNotMatter) {
  const SurfaceMesh body = make_hollow_sphere(1, 0.7, 0.2);
  SlabShape shape;
  shape.wave = 0.1, shape.normal = {0.3, 0.5, 1}, shape.cells = 20;
  const SurfaceMesh slab = make_slab(shape);
  const CutResult reference = cut_of(body, slab);
  expect_good(body, reference);
  for (const Real scale : {1e-3, 1.0, 1e3})
    for (const Real shift : {0.0, 1e4}) {
      const auto map = [&](const Vec3& p) { return scale * (p + Vec3{shift, -shift, 0.5 * shift}); };
      const CutResult result = cut_of(moved(body, map), moved(slab, map));
      expect_good(moved(body, map), result);
      ASSERT_EQ(result.fragments.size(), reference.fragments.size());
      for (std::size_t i = 0; i < result.fragments.size(); ++i)
        EXPECT_NEAR(signed_volume(result.fragments[i]) / (scale * scale * scale), signed_volume(reference.fragments[i]),
                    1e-10);
    }
}

TEST(Cut, ASelfIntersectingSlabIsRefused) {
  // Two crossing slabs in one mesh: closed and of positive volume, but not embedded.
  SlabShape shape;
  SurfaceMesh slab = make_slab(shape);
  shape.normal = {0.2, 1, 0.1};
  const SurfaceMesh second = make_slab(shape);
  const auto first = static_cast<std::uint32_t>(slab.vertex_count());
  for (std::size_t i = 0; i < second.vertex_count(); ++i) slab.vertices.push_back(second.vertices[i]);
  for (const Triangle& t : second.triangles) slab.add_triangle(first + t[0], first + t[1], first + t[2]);
  const CutResult result = cut_of(make_sphere(1, 0.4), slab);
  EXPECT_FALSE(result.ok);
  EXPECT_NE(result.reason.find("intersects itself"), std::string::npos) << result.reason;
}

TEST(Cut, TheSameInputGivesTheSameBitsForAnyNumberOfThreads) {
  const SurfaceMesh body = make_box({1, 1, 1}, 0.25);
  SlabShape shape;  // through lattice points: the jitter takes part
  shape.cells = 16;
  const CutResult a = cut_of(body, make_slab(shape));
  const ThreadLimit one(1);
  const CutResult b = cut_of(body, make_slab(shape));
  expect_good(body, a);
  EXPECT_GT(a.jitters, 0);
  EXPECT_EQ(a.fragments, b.fragments);
  EXPECT_EQ(a.removed_volume, b.removed_volume);
}

// A block with a bore along z through its middle, and beside it a blind hole along y past the middle plane.
SurfaceMesh bored_block() {
  const SurfaceMesh bore = moved(make_box({0.3, 0.3, 2}, 5), [](const Vec3& p) { return p + Vec3{0.011, 0.007, 0}; });
  const SurfaceMesh hole = moved(make_box({0.2, 0.9, 0.2}, 5), [](const Vec3& p) {
    return p + Vec3{0.521, -0.25, 0.003};
  });
  const CutResult once = cut_of(make_box({1.6, 1, 1}, 0.2), bore);
  EXPECT_TRUE(once.ok) << once.reason;
  CutResult twice = cut_of(once.fragments.at(0), hole);
  EXPECT_TRUE(twice.ok) << twice.reason;
  return std::move(twice.fragments.at(0));
}

// With its two sides marked, as thicken() does. In the plane of `shape`, which make_slab() leaves unmarked.
SurfaceMesh sided_slab(const SlabShape& shape) {
  SurfaceMesh slab = make_slab(shape);
  for (std::size_t t = 0; t < slab.triangle_count(); ++t) {
    const Real across = dot(normalized(slab.area_normal2(t)), normalized(shape.normal));
    slab.faces.side[t] = across > 0.5 ? 1 : across < -0.5 ? -1 : 0;
  }
  return slab;
}

// A crack from the bore to the side opens the block's handle; with the blind hole on its way, this becomes a handle of
// its own (the far wall ends in it), and Euler's number says that nothing happened. Two walls say the contrary. A slab
// half in the top face takes a layer off and leaves one.
TEST(Cut, ACrackDoesNothingWhenItLeavesOneWall) {
  const CutBody body(bored_block());
  ASSERT_EQ(body.defect(), "");
  ASSERT_EQ(body.euler(), 0);
  const auto cut_by = [&](const Vec3& centre, const Vec3& normal, Real u, Real v) {
    SlabShape shape;
    shape.centre = centre, shape.normal = normal, shape.half_u = u, shape.half_v = v, shape.cells = 6;
    CutResult c = cut(body, sided_slab(shape), options_for(body.mesh()));
    EXPECT_TRUE(c.ok) << c.reason;
    EXPECT_FALSE(c.separated);
    return c;
  };
  // y = 0.013: x from within the bore outwards; all of z.
  const CutResult opened = cut_by({-0.513, 0.013, 0}, {0, 1, 0}, 0.45, 0.9);
  EXPECT_EQ(opened.euler, 2);
  EXPECT_FALSE(does_nothing(body, opened, 7));
  const CutResult past_hole = cut_by({0.513, 0.013, 0}, {0, 1, 0}, 0.45, 0.9);
  EXPECT_EQ(past_hole.euler, 0);
  EXPECT_FALSE(does_nothing(body, past_hole, 7));
  const CutResult planed = cut_by({0.003, 0.002, 0.5}, {0, 0, 1}, 1.3, 1.2);
  EXPECT_EQ(planed.euler, 0);
  EXPECT_TRUE(does_nothing(body, planed, 7));
}

}  // namespace
}  // namespace sherd
