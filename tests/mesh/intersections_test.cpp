#include "engine/mesh/intersections.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/mesh/shapes.h"
#include "kernels/core/parallel.h"
#include "kernels/core/random.h"
#include "remesh_shared.h"

namespace sherd {
namespace {

using Corners = std::array<Vec3, 3>;

Vec3 random_point(Random& random) {
  return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

Corners random_triangle(Random& random) {
  const Vec3 centre = 0.5 * random_point(random);
  return {centre + random_point(random), centre + random_point(random), centre + random_point(random)};
}

// Minimum distance of two triangles by alternating projection between the convex sets: an independent oracle; it
// converges to the distance, so a clear answer is one well above 0 or exactly reaching it.
Real distance_by_alternating_projection(const Corners& a, const Corners& b) {
  Vec3 p = (a[0] + a[1] + a[2]) / 3.0;
  Real d = 0;
  for (int i = 0; i < 3000; ++i) {
    // nearest point by sampling-free barycentric projection: on the plane, then on the edges
    const auto nearest = [](const Vec3& x, const Corners& t) {
      Vec3 best = t[0];
      Real best_d = 1e300;
      const auto take = [&](const Vec3& y) {
        if (distance2(x, y) < best_d) best_d = distance2(x, y), best = y;
      };
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 e = t[(k + 1) % 3] - t[k];
        take(t[k] + e * std::clamp(dot(x - t[k], e) / norm2(e), 0.0, 1.0));
      }
      const Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
      const Vec3 y = x - n * (dot(x - t[0], n) / norm2(n));
      bool in = true;
      for (std::size_t k = 0; k < 3; ++k) in = in && dot(cross(t[(k + 1) % 3] - t[k], y - t[k]), n) >= 0;
      if (in) take(y);
      return best;
    };
    const Vec3 q = nearest(p, b);
    p = nearest(q, a);
    d = distance(p, q);
  }
  return d;
}

void shift_vertices(SurfaceMesh& mesh, const Vec3& by) {
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) mesh.vertices.add(i, by);
}

void append(SurfaceMesh& mesh, const SurfaceMesh& other) {
  const auto base = static_cast<std::uint32_t>(mesh.vertex_count());
  for (std::size_t i = 0; i < other.vertex_count(); ++i) mesh.vertices.push_back(other.vertices[i]);
  for (const Triangle& t : other.triangles) mesh.add_triangle(base + t[0], base + t[1], base + t[2]);
}

TEST(TriangleIntersection, AgreesWithConvexDistanceOnRandomPairs) {
  Random random(11);
  int hits = 0, misses = 0;
  for (int i = 0; i < 400; ++i) {
    const Corners a = random_triangle(random), b = random_triangle(random);
    const bool meet = triangles_intersect(a, b);
    const Real d = distance_by_alternating_projection(a, b);
    // Disjoint pairs converge linearly to their distance > 0. Crossing pairs tend to 0, sublinearly at worst.
    if (d > 0.05) {
      EXPECT_FALSE(meet) << i;
    } else if (d < 1e-9) {
      EXPECT_TRUE(meet) << i;
    }
    (meet ? hits : misses)++;
  }
  EXPECT_GT(hits, 40);
  EXPECT_GT(misses, 40);
}

TEST(TriangleIntersection, IsTheSameForAllCornerOrdersAndBothArguments) {
  Random random(12);
  for (int i = 0; i < 300; ++i) {
    Corners a = random_triangle(random), b = random_triangle(random);
    if (i % 3 == 0)  // coplanar pairs
      for (std::size_t k = 0; k < 3; ++k) a[k].z = b[k].z = 0.25;
    const bool meet = triangles_intersect(a, b);
    std::array<std::size_t, 3> order{0, 1, 2};
    do {
      const Corners c{b[order[0]], b[order[1]], b[order[2]]};
      EXPECT_EQ(triangles_intersect(a, c), meet);
      EXPECT_EQ(triangles_intersect(c, a), meet);
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

TEST(TriangleIntersection, TouchingCountsAndTheSmallestGapDoesNot) {
  const Corners a{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};
  const auto spike = [](Real z) { return Corners{Vec3{0.25, 0.25, z}, Vec3{0, 0, 1}, Vec3{1, 1, 1}}; };
  EXPECT_TRUE(triangles_intersect(a, spike(0)));
  EXPECT_FALSE(triangles_intersect(a, spike(0x1p-60)));
  EXPECT_TRUE(triangles_intersect(a, spike(-0x1p-60)));
  // coplanar: a corner on an edge, and a corner one ulp beyond it
  const Real one_up = std::nextafter(1.0, 2.0);
  EXPECT_TRUE(triangles_intersect(a, {Vec3{1, 0, 0}, Vec3{2, 0, 0}, Vec3{2, 1, 0}}));
  EXPECT_FALSE(triangles_intersect(a, {Vec3{one_up, 0, 0}, Vec3{2, 0, 0}, Vec3{2, 1, 0}}));
  // one coplanar triangle inside the other
  EXPECT_TRUE(triangles_intersect(a, {Vec3{0.1, 0.1, 0}, Vec3{0.2, 0.1, 0}, Vec3{0.1, 0.2, 0}}));
}

TEST(TriangleIntersection, SharedVertexCountsOnlyWhatLiesBeyondIt) {
  const Corners a{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};
  const Triangle ia{0, 1, 2}, ib{0, 3, 4};
  EXPECT_FALSE(triangles_intersect(ia, a, ib, {Vec3{0, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, -1, 0}}));
  EXPECT_FALSE(triangles_intersect(ia, a, ib, {Vec3{0, 0, 0}, Vec3{1, 1, 1}, Vec3{0, 1, 1}}));
  EXPECT_TRUE(triangles_intersect(ia, a, ib, {Vec3{0, 0, 0}, Vec3{1, 1, 1}, Vec3{1, 1, -1}}));  // through the inside
  EXPECT_TRUE(triangles_intersect(ia, a, ib, {Vec3{0, 0, 0}, Vec3{0.2, 0.2, 1}, Vec3{0.2, 0.2, -1}}));  // edge b cuts a
  EXPECT_TRUE(triangles_intersect(ia, a, ib, {Vec3{0, 0, 0}, Vec3{2, 2, 0}, Vec3{3, 2, 0}}));     // coplanar overlap
  EXPECT_FALSE(triangles_intersect(ia, a, ib, {Vec3{0, 0, 0}, Vec3{-2, 2, 0}, Vec3{-3, 2, 0}}));  // coplanar, apart
}

TEST(TriangleIntersection, SharedEdgeCountsOnlyAFlatFold) {
  const Corners a{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};
  const Triangle ia{0, 1, 2}, ib{1, 0, 3};
  EXPECT_FALSE(triangles_intersect(ia, a, ib, {a[1], a[0], Vec3{0, -1, 0}}));
  EXPECT_TRUE(triangles_intersect(ia, a, ib, {a[1], a[0], Vec3{5, 3, 0}}));
  EXPECT_FALSE(triangles_intersect(ia, a, ib, {a[1], a[0], Vec3{5, 3, 0x1p-50}}));
  EXPECT_TRUE(triangles_intersect(ia, a, {2, 1, 0}, {a[2], a[1], a[0]}));
}

// Triangles of small integers in the plane z = x + 2 y: pairs of one plane, which touch often. Their projections along
// z meet as they do, and integers decide that exactly: closed triangles are apart when an edge of one has the other
// strictly outside; those with one vertex in common meet in more when an edge of one from there lies between those of
// the other.
TEST(TriangleIntersection, PairsOfOnePlaneAgreeWithIntegerArithmetic) {
  using Point = std::array<long, 2>;
  const auto turn = [](const Point& a, const Point& b, const Point& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  };
  Random random(9);
  const auto point = [&] {
    const auto coordinate = [&] { return static_cast<long>(random.uniform(-6, 7)); };
    const long x = coordinate();
    return Point{x, coordinate()};
  };
  using Flat = std::array<Point, 3>;
  const auto triangle = [&](const Flat& t) {
    Corners c;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto x = static_cast<Real>(t[k][0]), y = static_cast<Real>(t[k][1]);
      c[k] = {x, y, x + 2 * y};
    }
    return c;
  };
  const auto has_outside = [&](const Flat& t, const Flat& u) {
    for (std::size_t k = 0; k < 3; ++k)
      if (std::all_of(u.begin(), u.end(), [&](const Point& p) { return turn(t[k], t[(k + 1) % 3], p) < 0; }))
        return true;
    return false;
  };
  const auto between = [&](const Flat& t, const Point& p) {
    return turn(t[0], t[1], p) >= 0 && turn(t[0], p, t[2]) >= 0;
  };
  int met[2] = {0, 0}, apart[2] = {0, 0};
  for (int i = 0; i < 20000; ++i) {
    Flat a{point(), point(), point()}, b{point(), point(), point()};
    const bool shared = i % 2 == 1;
    if (shared) b[0] = a[0];
    if (turn(a[0], a[1], a[2]) < 0) std::swap(a[1], a[2]);
    if (turn(b[0], b[1], b[2]) < 0) std::swap(b[1], b[2]);
    if (turn(a[0], a[1], a[2]) == 0 || turn(b[0], b[1], b[2]) == 0) continue;
    const bool expected = shared ? between(a, b[1]) || between(a, b[2]) || between(b, a[1]) || between(b, a[2])
                                 : !has_outside(a, b) && !has_outside(b, a);
    ++(expected ? met : apart)[shared ? 1 : 0];
    const bool found = triangles_intersect({0, 1, 2}, triangle(a), {shared ? 0u : 3u, 4, 5}, triangle(b));
    ASSERT_EQ(found, expected) << i;
  }
  for (int k = 0; k < 2; ++k) EXPECT_GT(std::min(met[k], apart[k]), 1000);  // both answers are asked for
}

TEST(SelfIntersections, GeneratedSolidsHaveNone) {
  EXPECT_EQ(count_self_intersections(make_sphere(1, 0.15)), 0u);
  EXPECT_EQ(count_self_intersections(make_box({1, 2, 3}, 0.2)), 0u);
  EXPECT_EQ(count_self_intersections(make_dinner_plate(1, 0.04, 0.05)), 0u);
  EXPECT_EQ(count_self_intersections(make_hollow_sphere(1, 0.7, 0.2)), 0u);
}

TEST(SelfIntersections, AgreeWithAllPairsAndTheLimitTruncates) {
  SurfaceMesh mesh = make_sphere(1, 0.25), other = mesh;
  shift_vertices(other, {0.913, 0.377, 0.1931});
  append(mesh, other);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> expected, found;
  for (std::uint32_t i = 0; i < mesh.triangle_count(); ++i)
    for (std::uint32_t j = i + 1; j < mesh.triangle_count(); ++j)
      if (faces_intersect(mesh, i, j)) expected.emplace_back(i, j);
  ASSERT_GT(expected.size(), 50u);
  EXPECT_EQ(count_self_intersections(mesh, std::numeric_limits<std::size_t>::max(), &found), expected.size());
  EXPECT_EQ(found, expected);
  EXPECT_EQ(count_self_intersections(mesh, 7, &found), 7u);
  EXPECT_TRUE(std::equal(found.begin(), found.end(), expected.begin()));
  const ThreadLimit one(1);
  EXPECT_EQ(count_self_intersections(mesh, std::numeric_limits<std::size_t>::max(), &found), expected.size());
  EXPECT_EQ(found, expected);
}

TEST(SelfIntersections, SharedMeshesHaveTheCountsOfAnIndependentTool) {
  // Counts of the meshes' manifest (another library's exact test on the same files).
  const std::pair<const char*, std::size_t> known[] = {{"broken/two_spheres_overlap.ply", 162},
                                                       {"broken/shell_coincident.ply", 16580},
                                                       {"broken/bunny_open.ply", 0},
                                                       {"dev/nefertiti_20k.ply", 2},
                                                       {"dev/bunny_20k.ply", 0},
                                                       {"analytic/goblet_64.ply", 0}};
  for (const auto& [name, count] : known) {
    SurfaceMesh mesh;
    if (!test::read_shared_ply(name, mesh)) GTEST_SKIP() << name << " is not here";
    EXPECT_EQ(count_self_intersections(mesh), count) << name;
  }
}

}  // namespace
}  // namespace sherd
