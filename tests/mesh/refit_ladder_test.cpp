// What the ladder of refit() does where lines meet at small angles or pass each other closely, and what it may cost.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/mesh/certificate.h"
#include "engine/mesh/refit.h"
#include "engine/mesh/shapes.h"
#include "engine/mesh/sizing.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

constexpr Real kDegree = std::numbers::pi / 180;

void expect_fit(const SurfaceMesh& piece, const RefitReport& report, const SurfaceMesh& out) {
  ASSERT_TRUE(report.ok) << report.reason;
  const MeshCertificate certificate = certify(out);
  EXPECT_TRUE(certificate.ok()) << certificate.first_defect;
  EXPECT_EQ(certificate.below_1_degree, 0u) << report.strategy;
  EXPECT_GE(report.min_angle, 1);
  EXPECT_LT(std::abs(signed_volume(out) / signed_volume(piece) - 1), 2e-4);  // RefitOptions::max_volume_change
}

// A block of 4 by 1 by 2 whose top is one plane of two cracks: the second takes a wedge that starts in its middle.
SurfaceMesh block_with_wedge(Real angle) {
  const Real w = 3 * std::tan(angle / 2);
  SurfaceMesh mesh;
  for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{4, 0, 0}, Vec3{4, 0, 2}, Vec3{0, 0, 2}, Vec3{0, 1, 0}, Vec3{4, 1, 0},
                        Vec3{4, 1, 2}, Vec3{0, 1, 2}, Vec3{1, 1, 1}, Vec3{4, 1, 1 - w}, Vec3{4, 1, 1 + w}})
    mesh.vertices.push_back(p);
  const std::uint32_t tip = 8, right = 9, left = 10;
  // The top, seen from above; its wedge first.
  mesh.add_triangle(tip, left, right);
  for (const Triangle& t :
       {Triangle{4, 8, 5}, Triangle{5, 8, 9}, Triangle{8, 7, 6}, Triangle{8, 6, 10}, Triangle{4, 7, 8}})
    mesh.add_triangle(t[0], t[1], t[2]);
  mesh.faces.kind.assign(6, FaceKind::kCrack), mesh.faces.crack.assign(6, 1), mesh.faces.crack[0] = 2;
  for (const Triangle& t : {Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 4, 5}, Triangle{0, 5, 1},
                            Triangle{3, 2, 6}, Triangle{3, 6, 7}, Triangle{0, 3, 7}, Triangle{0, 7, 4},
                            Triangle{1, 5, 9}, Triangle{1, 9, 10}, Triangle{1, 10, 6}, Triangle{1, 6, 2}})
    mesh.add_triangle(t[0], t[1], t[2]);
  return with_edges_halved(mesh, 0.25);
}

TEST(RefitLadder, LinesThatMeetAtHalfADegreeAndLessAreJoinedUntilTheyAreFarEnoughApart) {
  for (const Real degrees : {0.5, 0.2, 0.05}) {
    const SurfaceMesh piece = block_with_wedge(degrees * kDegree);
    ASSERT_TRUE(certify(piece).ok());
    SurfaceMesh out;
    expect_fit(piece, refit(piece, {.edge_length = 0.25}, out), out);
  }
}

// Sections, each a triangle or more corners counter-clockwise seen from behind, joined along z and closed at the ends.
SurfaceMesh loft(const std::vector<std::vector<Vec3>>& sections, Real longest) {
  SurfaceMesh mesh;
  const auto n = static_cast<std::uint32_t>(sections[0].size()), count = static_cast<std::uint32_t>(sections.size());
  for (const auto& section : sections)
    for (const Vec3& p : section) mesh.vertices.push_back(p);
  for (std::uint32_t s = 0; s + 1 < count; ++s)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = s * n + i, b = s * n + (i + 1) % n;
      mesh.add_triangle(a, b, b + n), mesh.add_triangle(a, b + n, a + n);
    }
  for (std::uint32_t i = 1; i + 1 < n; ++i) {
    const std::uint32_t last = (count - 1) * n;
    mesh.add_triangle(0, i + 1, i), mesh.add_triangle(last, last + i, last + i + 1);
  }
  return with_edges_halved(mesh, longest);
}

// Two lumps that hang together by a thread of three sides, much thinner than the edges are long: no merging may part
// it.
TEST(RefitLadder, AThreadBetweenTwoLumpsGetsShortEdgesAtItsNeckAlone) {
  for (const Real radius : {0.001, 0.0005}) {
    std::vector<std::vector<Vec3>> sections;
    for (const Real z : {-1.0, 0.0, 1.0}) {
      sections.emplace_back();
      for (int k = 0; k < 3; ++k) {
        const Real r = z == 0 ? radius : 0.5, angle = 120 * k * kDegree;
        sections.back().push_back({r * std::cos(angle), r * std::sin(angle), z});
      }
    }
    const SurfaceMesh piece = loft(sections, 0.25);
    ASSERT_TRUE(certify(piece).ok());
    SurfaceMesh out;
    expect_fit(piece, refit(piece, {.edge_length = 0.25, .edge_per_thin_wall = 0}, out), out);
    EXPECT_LT(out.triangle_count(), 2 * piece.triangle_count());
  }
}

// A blade whose blunt edge narrows to a hair in its middle.
TEST(RefitLadder, ANarrowPlaceOfARimIsFitForTheNextSolve) {
  for (const Real width : {0.004, 0.001}) {
    std::vector<std::vector<Vec3>> sections;
    for (const Real z : {-1.0, 0.1, 1.0}) {
      const Real w = z == 0.1 ? width : 0.1;
      sections.push_back({{0, w / 2, z}, {0, -w / 2, z}, {1, -0.3, z}, {1, 0.3, z}});
    }
    const SurfaceMesh piece = loft(sections, 0.25);
    ASSERT_TRUE(certify(piece).ok());
    SurfaceMesh out;
    expect_fit(piece, refit(piece, {.edge_length = 0.25, .edge_per_thin_wall = 0}, out), out);
  }
}

// A blade whose rim is a triangle: its two lines meet at a corner, at so small an angle that they can only be joined
// for a stretch, which makes the wall end in an edge there.
TEST(RefitLadder, ARimThatStartsAtATinyAngleBecomesAnEdgeThere) {
  for (const Real degrees : {0.9, 0.5}) {
    const Real w = 2 * std::tan(degrees / 2 * kDegree);
    SurfaceMesh mesh;
    for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{0, w, 2}, Vec3{0, -w, 2}, Vec3{1, -0.3, 0}, Vec3{1, 0.3, 0},
                          Vec3{1, -0.3, 2}, Vec3{1, 0.3, 2}})
      mesh.vertices.push_back(p);
    for (const Triangle& t :
         {Triangle{0, 2, 1}, Triangle{0, 1, 6}, Triangle{0, 6, 4}, Triangle{0, 3, 5}, Triangle{0, 5, 2},
          Triangle{3, 4, 6}, Triangle{3, 6, 5}, Triangle{0, 4, 3}, Triangle{2, 5, 6}, Triangle{2, 6, 1}})
      mesh.add_triangle(t[0], t[1], t[2]);
    const SurfaceMesh piece = with_edges_halved(mesh, 0.25);
    ASSERT_TRUE(certify(piece).ok());
    SurfaceMesh out;
    expect_fit(piece, refit(piece, {.edge_length = 0.25, .edge_per_thin_wall = 0}, out), out);
  }
}

// 5 by 1 by 1 m, of elements so long that remeshing replaces them everywhere. Its 22 m^2 make 22 / (0.43 edge^2)
// triangles: 1270 of edge 0.2, 50 of edge 1.
SurfaceMesh long_box() {
  SurfaceMesh box = make_box({1, 1, 1}, 0.1);
  for (std::size_t v = 0; v < box.vertex_count(); ++v) {
    const Vec3 p = box.vertices[v];
    box.vertices.set(v, {5 * p.x, p.y, p.z});
  }
  return box;
}

// No mesh of a box has a least angle above 45 degrees (a triangle with a right angle has one of at most that, and other
// corners of a face are split), so every attempt fails that is made.
TEST(RefitLadder, FinerEdgesThatWouldMultiplyTheTrianglesAreNotTried) {
  SurfaceMesh out;
  const SurfaceMesh box = long_box();
  const RefitReport large = refit(box, {.edge_length = 0.2, .least_angle = 46}, out);
  EXPECT_FALSE(large.ok);
  EXPECT_EQ(out, box);
  // Half the edge length makes 4 times the triangles, a quarter 16 times: both more than most_refinement, 3.
  EXPECT_NE(large.reason.find("fine: some"), std::string::npos) << large.reason;
  EXPECT_NE(large.reason.find("finer: some"), std::string::npos) << large.reason;
  // What is left of the ladder: four attempts around poor triangles, two at tips, four repairs of slivers, two that
  // pinch.
  EXPECT_LE(large.attempts, 12);
  // 50 triangles may become 800.
  const RefitReport small = refit(box, {.edge_length = 1, .least_angle = 46}, out);
  EXPECT_EQ(small.reason.find("fine: some"), std::string::npos) << small.reason;
  EXPECT_GT(small.attempts, large.attempts);
}

}  // namespace
}  // namespace sherd
