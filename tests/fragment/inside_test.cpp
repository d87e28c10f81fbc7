// The design's T17: inside() of the tree against exact parity, and rays through vertices and edges.
#include "engine/fragment/cut_body.h"
#include "engine/mesh/shapes.h"
#include "kernels/core/parallel.h"
#include "tests/fragment/slabs.h"

namespace sherd {
namespace {

std::vector<SurfaceMesh> bodies() {
  std::vector<SurfaceMesh> all = {make_box({1, 1, 1}, 0.125), make_hollow_sphere(1, 0.6, 0.2), make_torus(1, 0.3, 0.15),
                                  make_plate(2, 2, 0.05, 0.1)};
  SlabShape notch;  // walls a thousandth apart
  notch.wedge = true, notch.thickness = 1e-3, notch.half_u = 0.6, notch.half_v = 1.1;
  notch.normal = {0, 0, 1}, notch.centre = {0.43, 0.011, 0.07};
  all.push_back(cut_of(all[0], make_slab(notch)).fragments.at(0));
  return all;
}

// Uniform in the box, and off a random point of a random face by 0.1 to 1e-5 of its edge.
Vec3 query(const SurfaceMesh& mesh, const Box& box, Random& random) {
  if (random.next() % 2 == 0)
    return {random.uniform(box.low.x, box.high.x), random.uniform(box.low.y, box.high.y),
            random.uniform(box.low.z, box.high.z)};
  const std::size_t t = random.next() % mesh.triangle_count();
  Real a = random.uniform(), b = random.uniform();
  if (a + b > 1) a = 1 - a, b = 1 - b;
  const Vec3 c = mesh.corner(t, 0), u = mesh.corner(t, 1) - c, v = mesh.corner(t, 2) - c;
  const Real off = std::pow(10.0, random.uniform(-5, -1)) * norm(u) * (random.next() % 2 ? 1 : -1);
  return c + a * u + b * v + off * normalized(mesh.area_normal2(t));
}

TEST(SlowInside, AMillionQueriesAgreeWithExactParity) {
  constexpr std::size_t kQueries = 200000;
  for (const SurfaceMesh& mesh : bodies()) {
    const CutBody body(mesh);
    const Box box = body.bvh().box();
    Random random(41);
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < kQueries; ++i) points.push_back(query(mesh, box, random));
    const auto wrong = parallel_sum<std::size_t>(kQueries, 1024, [&](std::size_t i) -> std::size_t {
      bool decided = false;
      const bool exact = inside_exact(body.operand(), points[i], decided);
      return !decided || body.bvh().inside(points[i]) != exact;
    });
    EXPECT_EQ(wrong, 0u);
  }
}

// Aimed in exact arithmetic of small dyadic numbers, so that each ray does pass its vertex or its edge's middle.
TEST(Inside, RaysThroughVerticesAndEdgesCrossTheSurfaceAsOftenAsTheirStartIsInside) {
  const CutBody cube(make_box({1, 1, 1}, 0.125));
  Random random(42);
  std::vector<TriangleBvh::Hit> hits;
  int tested = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto dyadic = [&] { return (static_cast<Real>(random.next() % 97) - 48) / 64; };
    const Vec3 p{dyadic(), dyadic(), dyadic()};
    bool decided = false;
    const bool on_surface = cube.bvh().closest(p, 1e-6).face != kNone;
    if (on_surface) continue;
    const bool inside = inside_exact(cube.operand(), p, decided);
    ASSERT_TRUE(decided);
    const auto v = cube.mesh().triangles[random.next() % cube.mesh().triangle_count()];
    const Vec3 a = cube.mesh().vertices[v[0]], b = cube.mesh().vertices[v[1]];
    for (const Vec3& target : {a, 0.5 * (a + b)}) {
      cube.bvh().all_hits(p, target - p, 0, std::numeric_limits<Real>::infinity(), hits);
      EXPECT_EQ(hits.size() % 2 == 1, inside);
      ++tested;
    }
  }
  EXPECT_GT(tested, 30000);
}

}  // namespace
}  // namespace sherd
