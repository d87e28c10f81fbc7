// The exact layer below the cut: orientations of crossings, triangulation of one cut face, piercing.
#include <algorithm>

#include "engine/fragment/face_triangulation.h"
#include "engine/fragment/piercing.h"
#include "engine/mesh/shapes.h"
#include "kernels/core/predicates.h"
#include "tests/fragment/slabs.h"

namespace sherd {
namespace {

const std::array<Vec3, 3> kFace{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};

// Crossing of a vertical edge with the plane z = 0: exactly (x, y, 0) whatever its two ends are.
ArrangementPoint vertical_crossing(Real x, Real y, Real below, Real above) {
  return make_crossing({x, y, -below}, {x, y, above}, kFace);
}

TEST(ArrangementPoint, ACrossingLiesWithinItsErrorBoundOfTheExactOne) {
  Random random(31);
  for (int i = 0; i < 2000; ++i) {
    const Real x = random.uniform(-1, 1), y = random.uniform(-1, 1);
    const ArrangementPoint p = vertical_crossing(x, y, random.uniform(1e-9, 1), random.uniform(1e-9, 1));
    EXPECT_LE(std::abs(p.position.x - x), p.error);
    EXPECT_LE(std::abs(p.position.y - y), p.error);
    EXPECT_LE(std::abs(p.position.z), p.error);
    EXPECT_LT(p.error, 1e-14);  // some tens of units in the last place of coordinates of size 1
  }
}

// The exact positions are known doubles, so orient2d is the oracle; the third point lies on or next to the others'
// line.
TEST(ArrangementPoint, OrientationOfCrossingsIsExactOnAndNextToALine) {
  Random random(32);
  int seen[3] = {0, 0, 0};
  for (int i = 0; i < 3000; ++i) {
    // coordinates of 20 bits, so that the midpoint is exact
    const auto coordinate = [&] { return static_cast<Real>(random.next() % (1u << 20)) * 0x1p-20; };
    Real x[3] = {coordinate(), coordinate(), 0}, y[3] = {coordinate(), coordinate(), 0};
    x[2] = 0.5 * (x[0] + x[1]), y[2] = 0.5 * (y[0] + y[1]);
    if (i % 3 == 1) x[2] = std::nextafter(x[2], 2.0);
    if (i % 3 == 2) y[2] = std::nextafter(y[2], 2.0);
    std::vector<ArrangementPoint> points;
    for (int k = 0; k < 3; ++k)
      points.push_back(vertical_crossing(x[k], y[k], random.uniform(0.1, 1), random.uniform(0.1, 1)));
    const std::vector<std::uint8_t> unknown;
    PlanarOrientation orient(kFace, points, unknown);
    const int expected = orient2d(x[0], y[0], x[1], y[1], x[2], y[2]);
    ++seen[expected + 1];
    ASSERT_EQ(orient(0, 1, 2), expected);
    ASSERT_EQ(orient(1, 0, 2), -expected);
  }
  for (int n : seen) EXPECT_GT(n, 500);
}

TEST(FaceTriangulation, AClosedLoopSeparatesItsInsideFromTheRest) {
  FaceArrangement face;
  for (const Vec3& c : kFace) face.points.push_back(make_vertex(c));
  const int n = 12;
  for (int i = 0; i < n; ++i) {
    const Real a = 2 * 3.14159265358979 * i / n;
    face.points.push_back(vertical_crossing(0.3 + 0.2 * std::cos(a), 0.3 + 0.2 * std::sin(a), 1, 1));
    face.segments.push_back({static_cast<std::uint32_t>(3 + i), static_cast<std::uint32_t>(3 + (i + 1) % n)});
  }
  const FaceTriangulation result = triangulate_face(face);
  ASSERT_TRUE(result.ok) << result.reason;
  // Euler: 15 points, 3 on the hull: 2 * 15 - 2 - 3 triangles; the loop runs counter-clockwise, its inside is left.
  ASSERT_EQ(result.triangles.size(), 25u);
  Real area[2] = {0, 0};
  for (std::size_t t = 0; t < result.triangles.size(); ++t) {
    const auto& v = result.triangles[t];
    const Vec3 a = face.points[v[0]].position, b = face.points[v[1]].position, c = face.points[v[2]].position;
    const Real twice = cross(b - a, c - a).z;
    EXPECT_GT(twice, 0);
    area[static_cast<std::size_t>(result.right[t])] += 0.5 * twice;
  }
  EXPECT_NEAR(area[0], 0.5 * n * 0.04 * std::sin(2 * 3.14159265358979 / n), 1e-13);
  EXPECT_NEAR(area[0] + area[1], 0.5, 1e-14);
}

TEST(FaceTriangulation, ContradictingSidesAreRefused) {
  FaceArrangement face;
  for (const Vec3& c : kFace) face.points.push_back(make_vertex(c));
  for (const Real y : {0.1, 0.3}) {  // two chords across the face, both with the strip between them on the left
    face.points.push_back(make_crossing({0, 0, 0}, {0, 1, 0}, {Vec3{0, y, 0}, Vec3{1, y, 0}, Vec3{0, y, 1}}));
    face.points.push_back(make_crossing({1, 0, 0}, {0, 1, 0}, {Vec3{0, y, 0}, Vec3{1, y, 0}, Vec3{0, y, 1}}));
  }
  face.segments = {{3, 4}, {6, 5}};
  EXPECT_TRUE(triangulate_face(face).ok);
  face.segments = {{3, 4}, {5, 6}};
  EXPECT_FALSE(triangulate_face(face).ok);
}

TEST(Pierce, TouchingAndCoplanarMeshesAreCoincidencesAndGenericOnesAreNot) {
  const CutOperand body(make_box({1, 1, 1}, 2));
  const auto shifted = [](const Vec3& by) {
    return CutOperand(moved(make_box({1, 1, 1}, 2), [by](const Vec3& p) { return p + by; }));
  };
  EXPECT_EQ(pierce(body, shifted({1, 0.3, 0.2})).status, PierceStatus::kCoincidence);  // faces touch
  EXPECT_EQ(pierce(body, shifted({1, 1, 0.2})).status, PierceStatus::kCoincidence);    // edges touch
  EXPECT_EQ(pierce(body, shifted({1, 1, 1})).status, PierceStatus::kCoincidence);      // vertices touch
  EXPECT_EQ(pierce(body, shifted({0.5, 0, 0})).status, PierceStatus::kCoincidence);    // coplanar sides
  EXPECT_EQ(pierce(body, shifted({1.5, 0, 0})).status, PierceStatus::kOk);             // apart
  const Piercing crossing = pierce(body, shifted({0.31, 0.23, 0.17}));
  ASSERT_EQ(crossing.status, PierceStatus::kOk);
  // Two unit cubes shifted along all axes: each has three edges through the other (and face diagonals).
  EXPECT_GE(crossing.crossings.size(), 6u);
  EXPECT_EQ(crossing.segments.size(), crossing.crossings.size());
}

TEST(Pierce, ExactParityAgreesWithTheDistanceFromACentre) {
  const CutOperand hollow(make_hollow_sphere(1, 0.5, 0.2));
  Random random(33);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p{random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2)};
    const Real r = norm(p);
    // inscribed triangles with edges of 0.2 lie up to 0.2^2 / 6 below their sphere
    if (std::abs(r - 1) < 0.02 || std::abs(r - 0.5) < 0.02) continue;
    bool decided = false;
    EXPECT_EQ(inside_exact(hollow, p, decided), r < 1 && r > 0.5);
    EXPECT_TRUE(decided);
  }
}

}  // namespace
}  // namespace sherd
