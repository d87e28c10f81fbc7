// Cracks that are told where to run go there, separate, and are meshed well on the way (the paper's Figure 8).
#include "engine/fracture/guide.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "engine/fragment/cut.h"
#include "engine/mesh/load.h"
#include "engine/mesh/validate.h"
#include "tests/fracture/crack_support.h"

namespace sherd {
namespace {

constexpr Real kStrength = 2;  // Pa; any above Specimen::options().propagation_strength

// What the paper's Figure 8 shows of a crack surface.
struct Followed {
  GrowthResult growth;
  Real worst = 0, rms = 0;          // distance of the sheet's nodes inside the body from the guide, of h
  Real min_angle = 180;             // degrees
  Real below_15 = 0;                // part of the triangles with an angle below 15 degrees
  Real edge_ratio = 1;              // longest edge of all over the shortest
  std::vector<SurfaceMesh> pieces;  // after the cut
};

void measure_triangles(const CrackSheet& sheet, Followed& f) {
  Real shortest = 1e300, longest = 0;
  std::size_t narrow = 0;
  for (const Triangle& t : sheet.triangles) {
    Real least = 180;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = sheet.position[t[k]], u = sheet.position[t[(k + 1) % 3]] - p,
                 v = sheet.position[t[(k + 2) % 3]] - p;
      least = std::min(least, std::atan2(norm(cross(u, v)), dot(u, v)) * 180 / std::numbers::pi);
      shortest = std::min(shortest, norm(u)), longest = std::max(longest, norm(u));
    }
    f.min_angle = std::min(f.min_angle, least);
    narrow += least < 15;
  }
  f.below_15 = static_cast<Real>(narrow) / static_cast<Real>(sheet.triangles.size());
  f.edge_ratio = longest / shortest;
}

Followed follow(const Specimen& body, const GuideSpec& spec, std::size_t which = 0) {
  Followed f;
  const Guide guide(spec, body.bvh, body.mesh, body.h);
  const std::vector<CrackSeed> seeds = guide.seeds(kStrength);
  if (which >= seeds.size()) return f;
  f.growth = grow_crack(body.bvh, GuideField(guide, seeds[which], kStrength), seeds[which], body.options());
  const CrackSheet& sheet = f.growth.sheet;
  if (sheet.triangles.empty()) return f;
  measure_triangles(sheet, f);
  const GuideDeviation off = deviation(sheet, guide);
  f.worst = off.largest / body.h, f.rms = off.rms / body.h;
  std::string reason;
  const auto slab = thicken(sheet, body.options().thickness, 0, reason);
  if (!slab) return f;
  const CutResult cut_result = cut(body.mesh, *slab, {.edge_length = body.h});
  if (cut_result.ok) f.pieces = cut_result.fragments;
  return f;
}

// The graph of a function over a square, `n` by `n` parts; the plane z = 0 turned so that its normal is `up`.
template <class F>
SurfaceMesh graph(Real half, int n, const Vec3& up, const F& height) {
  SurfaceMesh mesh;
  const Vec3 z = normalized(up), x = normalized(cross(std::abs(z.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, z)),
             y = cross(z, x);
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const Real u = half * (2.0 * i / n - 1), v = half * (2.0 * j / n - 1);
      mesh.vertices.push_back(u * x + v * y + height(u, v) * z);
    }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      mesh.add_triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      mesh.add_triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  return mesh;
}

const Specimen& ball() {
  static const Specimen specimen(make_sphere(1, 0.1));
  return specimen;
}

// Curved guides are followed by chords of half an edge and smoothed over two edges: an error of order h / radius edges,
// below a quarter edge on guides of radius 6 h and more.
void expect_followed(const Followed& f, std::size_t pieces) {
  EXPECT_EQ(f.growth.ladder_level, 0) << f.growth.reason;
  EXPECT_EQ(f.pieces.size(), pieces);
  EXPECT_LT(f.worst, 0.25);
  EXPECT_LT(f.rms, 0.1);
  EXPECT_GT(f.min_angle, 8);
  EXPECT_LT(f.below_15, 0.01);
  EXPECT_LT(f.edge_ratio, 10);
}

TEST(Guide, APlaneIsFollowedToRoundingAndSeparates) {
  for (const Vec3& normal : {Vec3{1, 0, 0}, Vec3{1, 0.4, 0.2}, Vec3{-0.3, 1, 0.6}}) {
    const GuidePlane plane{{0.25, 0.1, -0.1}, normalized(normal)};
    const Followed f = follow(ball(), plane);
    expect_followed(f, 2);
    EXPECT_EQ(f.growth.outcome, GrowthOutcome::kComplete);
    EXPECT_LT(f.worst, 1e-9);
    // The smaller cap of the sphere, less half the slab; the mesh is inscribed: its volume is 0.5 % short.
    const Real d = std::abs(dot(plane.point, plane.normal));
    EXPECT_NEAR(signed_volume(f.pieces.back()), std::numbers::pi * (1 - d) * (1 - d) * (2 + d) / 3, 0.03);
  }
}

TEST(Guide, CurvedSurfacesAreFollowedWithinAPartOfAnEdge) {
  const auto bowl = [](Real u, Real v) { return 0.4 * (u * u + v * v) - 0.2; };
  const auto waves = [](Real u, Real v) { return 0.1 * std::sin(3 * u) * std::cos(2 * v); };
  expect_followed(follow(ball(), graph(1.5, 60, {1, 0.2, 0.1}, bowl)), 2);
  expect_followed(follow(ball(), graph(1.5, 60, {1, 0.2, 0.1}, waves)), 2);
}

TEST(Guide, TheFinerTheMeshTheNearerTheCrack) {
  const SurfaceMesh bowl = graph(1.5, 60, {1, 0.2, 0.1}, [](Real u, Real v) { return 0.5 * (u * u + v * v) - 0.2; });
  const Specimen fine(make_sphere(1, 0.05));
  const Followed at_h = follow(ball(), bowl), at_half = follow(fine, bowl);
  // In edges of each mesh the error is of order h / radius: in metres it falls four times.
  EXPECT_LT(at_half.rms * fine.h, 0.4 * at_h.rms * ball().h);
}

TEST(Guide, ALineOnTheSurfaceIsSweptInward) {
  GuidePolyline wave{.points = {}, .inward = {0, 0, -1}};
  for (int i = 0; i <= 40; ++i) {
    const Real x = -1.3 + 2.6 * i / 40, y = 0.1 * std::sin(4 * x);
    wave.points.push_back({x, y, std::sqrt(std::max(0.0, 1 - x * x - y * y))});
  }
  const Followed f = follow(ball(), wave);
  expect_followed(f, 2);
  EXPECT_EQ(f.growth.outcome, GrowthOutcome::kComplete);
}

TEST(Guide, AKinkIsRoundedOverAnEdge) {
  const GuidePolyline kink{.points = {{-1.3, -0.3, 0}, {0, 0.3, 0.95}, {1.3, -0.3, 0}}, .inward = {0, 0, -1}};
  const Followed f = follow(ball(), kink);
  EXPECT_EQ(f.pieces.size(), 2u);
  EXPECT_LT(f.worst, 1);
  // Two edges of the sheet's twenty are off, by less than an edge falling to none: sqrt(2 / 20 / 3) = 0.18.
  EXPECT_LT(f.rms, 0.18);
}

// Around a ring a front comes back towards its seed: steered by where the seed lies instead of by where it is going, it
// would turn across the guide, and further the further off it is (10 edges off on these two bowls).
TEST(Guide, AFrontSteersWhereItIsGoing) {
  const Specimen ring(make_torus(1, 0.4, 0.08));
  const struct {
    Vec3 centre, up;
    Real bend;
  } bowls[] = {{{0.2962, 0.1889, 0.4110}, {0.2626, -0.9366, -0.2319}, 0.4412},
               {{-0.3891, -0.1119, -0.3018}, {0.0352, -0.9194, 0.3917}, 0.184}};
  for (const auto& b : bowls) {
    SurfaceMesh bowl = graph(4, 80, b.up, [&](Real u, Real v) { return b.bend * (u * u + v * v); });
    for (std::size_t v = 0; v < bowl.vertex_count(); ++v) bowl.vertices.set(v, bowl.vertices[v] + b.centre);
    const Followed f = follow(ring, bowl);
    EXPECT_EQ(f.growth.outcome, GrowthOutcome::kComplete) << f.growth.reason;
    EXPECT_EQ(f.growth.ladder_level, 0) << f.growth.reason;
    EXPECT_LT(f.worst, 0.25);
    EXPECT_LT(f.rms, 0.1);
  }
}

TEST(Guide, ACrackEndsAtItsDepthAndAtTheGuidesBorder) {
  const Real depth = 0.5, h = ball().h;
  const GuidePlane plane{{0, 1, 0}, {1, 0, 0}, depth};
  const Followed f = follow(ball(), plane);
  EXPECT_EQ(f.growth.outcome, GrowthOutcome::kArrested);
  EXPECT_EQ(f.pieces.size(), 1u);
  Real deepest = 1;
  for (std::size_t v = 0; v < f.growth.sheet.position.size(); ++v) {
    if (!ball().bvh.inside(f.growth.sheet.position[v])) continue;
    deepest = std::min(deepest, f.growth.sheet.position[v].y);
    EXPECT_LT(std::abs(f.growth.sheet.position[v].x), 1e-9);
  }
  EXPECT_NEAR(deepest, 1 - depth, 0.5 * h);  // fronts stop within half a step; the mesh is inscribed

  const Followed patch = follow(ball(), graph(0.4, 8, {0, 0, 1}, [](Real, Real) { return 0; }));
  EXPECT_TRUE(patch.growth.sheet.triangles.empty()) << "a guide inside the body alone has no start";
  SurfaceMesh edge = graph(0.4, 8, {0, 0, 1}, [](Real, Real) { return 0; });
  for (std::size_t v = 0; v < edge.vertex_count(); ++v) edge.vertices.set(v, edge.vertices[v] + Vec3{0.9, 0, 0});
  const Followed notch = follow(ball(), edge);
  EXPECT_EQ(notch.growth.outcome, GrowthOutcome::kArrested);
  for (std::size_t v = 0; v < notch.growth.sheet.position.size(); ++v)
    EXPECT_GT(notch.growth.sheet.position[v].x, 0.5 - 0.5 * h);
}

TEST(Guide, APinnedGuideMeansTheSamePlaceInEveryPiece) {
  const GuidePlane deep{{0, 1, 0}, {1, 0, 0.2}, 0.4};
  const GuideSpec pin = pinned(deep, ball().bvh);
  const Followed halves = follow(ball(), GuidePlane{{0, 0, 0}, {0, 1, 0}});
  ASSERT_EQ(halves.pieces.size(), 2u);
  for (const SurfaceMesh& piece : halves.pieces) {
    const Specimen half(piece);
    const bool upper = bounding_box(piece).high.y > 0.5;
    EXPECT_EQ(Guide(pin, half.bvh, half.mesh, ball().h).seeds(1).size(), upper ? 1u : 0u);
  }
  EXPECT_EQ(follow(ball(), pin).growth.outcome, GrowthOutcome::kArrested);
  EXPECT_TRUE(std::holds_alternative<GuidePlane>(pinned(GuidePlane{{0, 1, 0}, {1, 0, 0}}, ball().bvh)));
}

TEST(Guide, EachCurveOnTheSurfaceGetsASeed) {
  const Specimen ring(make_torus(1, 0.3, 0.1));
  const GuidePlane plane{{0, 0, 0}, {1, 0, 0}};
  const Guide guide(plane, ring.bvh, ring.mesh, ring.h);
  const auto seeds = guide.seeds(kStrength);
  ASSERT_EQ(seeds.size(), 2u);
  EXPECT_LT(seeds[0].position.z * seeds[1].position.z, 0);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LT(std::abs(seeds[i].position.x), 1e-12);
    const Followed f = follow(ring, plane, i);
    EXPECT_EQ(f.growth.outcome, GrowthOutcome::kComplete);
    EXPECT_EQ(f.pieces.size(), 1u) << "one cut opens the ring";
  }
  EXPECT_TRUE(Guide(GuidePlane{{5, 0, 0}, {1, 0, 0}}, ring.bvh, ring.mesh, ring.h).seeds(1).empty());
}

TEST(Guide, APlaneAlongTheSurfaceHasNoDepthAndNoSeed) {
  const Specimen box(make_box({1, 1, 1}, 0.2));
  EXPECT_TRUE(Guide(GuidePlane{{0, 0.5, 0}, {0, 1, 0}, 0.1}, box.bvh, box.mesh, box.h).seeds(1).empty());
  EXPECT_FALSE(notch_wedge(GuidePlane{{0, 0.5, 0}, {0, 1, 0}, 0.1}, box.bvh, 0.05, box.h));
}

// The volume a wedge takes from the body it is cut from.
Real taken(const Specimen& body, const NotchSpec& notch, Real width) {
  const auto wedge = notch_wedge(notch, body.bvh, width, body.h);
  if (!wedge) return -1;
  EXPECT_TRUE(is_valid(report_mesh(*wedge, {.count_self_intersections = true})));
  const CutResult result = cut(body.mesh, *wedge, {.edge_length = body.h});
  EXPECT_TRUE(result.ok) << result.reason;
  if (!result.ok || result.fragments.size() != 1) return -1;
  return signed_volume(body.mesh) - signed_volume(result.fragments[0]);
}

TEST(NotchWedge, TakesAPrismOutOfABar) {
  const Specimen bar(make_box({4, 1, 0.7}, 0.1));
  const Real width = 0.08, depth = 0.3, prism = 0.5 * width * depth;
  EXPECT_NEAR(taken(bar, GuidePlane{{0.03, -0.5, 0}, {1, 0, 0}, depth}, width), prism * 0.7, 1e-6 * prism);
  // Across the same side, drawn past its edges.
  const GuidePolyline line{{{0.03, -0.5, -0.5}, {0.03, -0.5, 0.5}}, {0, 1, 0}, depth};
  EXPECT_NEAR(taken(bar, line, width), prism * 0.7, 1e-6 * prism);
  // Half across: ends with a wall.
  const GuidePolyline half{{{0.03, -0.5, -0.5}, {0.03, -0.5, 0}}, {0, 1, 0}, depth};
  EXPECT_NEAR(taken(bar, half, width), prism * 0.35, 1e-6 * prism);
  // Aslant: the prism's base stays, its length grows.
  const Vec3 slanted = normalized(Vec3{1, 0, 0.5});
  EXPECT_NEAR(taken(bar, GuidePlane{{0.03, -0.5, 0}, slanted, depth}, width), prism * 0.7 / slanted.x, 1e-5 * prism);
}

TEST(NotchWedge, MitresABentLine) {
  const Specimen block(make_box({2, 1, 2}, 0.1));
  const Real width = 0.06, depth = 0.2;
  const GuidePolyline bent{{{-0.5, 0.5, 0.013}, {0.017, 0.5, 0.3}, {0.5, 0.5, -0.1}}, {0, -1, 0}, depth};
  const Real length = distance(bent.points[0], bent.points[1]) + distance(bent.points[1], bent.points[2]);
  // Cross-section times length of the middle line; what the mitre takes outside the bend it leaves inside.
  EXPECT_NEAR(taken(block, bent, width), 0.5 * width * depth * length, 1e-6 * length);
}

Specimen bunny() {
  LoadLog log;
  return Specimen(load_mesh(SHERD_SHARED "/meshes/dev/bunny_5k.ply", {}, log));
}

TEST(Guide, CutsTheBunnyAsOnFigure8) {
  if (!std::filesystem::exists(SHERD_SHARED "/meshes/dev/bunny_5k.ply")) GTEST_SKIP();
  const Specimen body = bunny();
  const Box box = bounding_box(body.mesh);
  const Vec3 centre = box.centre();
  const Real size = box.diagonal();
  Followed f = follow(body, GuidePlane{centre, normalized(Vec3{1, 0.2, 0.1})});
  expect_followed(f, 2);
  EXPECT_LT(f.worst, 1e-6);
  SurfaceMesh bowl = graph(size, 80, {1, 0.2, 0.1}, [&](Real u, Real v) { return 1.5 / size * (u * u + v * v); });
  for (std::size_t v = 0; v < bowl.vertex_count(); ++v) bowl.vertices.set(v, bowl.vertices[v] + centre);
  f = follow(body, bowl);
  expect_followed(f, 2);
}

}  // namespace
}  // namespace sherd
