#include <filesystem>

#include "engine/mesh/bvh.h"
#include "engine/mesh/load.h"
#include "engine/mesh/shapes.h"
#include "tests/fragment/slabs.h"

namespace sherd {
namespace {

SlabShape random_slab(Random& random, Real size) {
  SlabShape s;
  s.normal = normalized(Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
  s.centre = 0.3 * size * Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  s.half_u = s.half_v = 2 * size;
  s.cells = 4 + static_cast<int>(random.next() % 24);
  s.thickness = size * std::pow(10.0, random.uniform(-5, -1.5));
  s.wave = random.next() % 2 ? 0.0 : random.uniform(0, 0.1) * size;
  s.wave_number = random.uniform(1, 5) / size;
  s.phase = random.uniform(0, 6);
  s.wedge = random.next() % 3 == 0;
  return s;
}

struct Shape {
  const char* name;
  SurfaceMesh mesh;
  Real size;
};

std::vector<Shape> shapes() {
  return {{"sphere", make_sphere(1, 0.25), 1},        {"cube", make_box({1, 1, 1}, 0.125), 0.5},
          {"plate", make_plate(3, 3, 0.1, 0.1), 1.5}, {"hollow", make_hollow_sphere(1, 0.8, 0.2), 1},
          {"torus", make_torus(1, 0.3, 0.2), 1},      {"dinner plate", make_dinner_plate(0.15, 0.004, 0.01), 0.15}};
}

TEST(SlowCut, TwoHundredRandomSlabsLeaveOnlyValidBodies) {
  Random random(20);
  const auto bodies = shapes();
  for (int i = 0; i < 200; ++i) {
    const Shape& body = bodies[static_cast<std::size_t>(i) % bodies.size()];
    SCOPED_TRACE(std::string(body.name) + " " + std::to_string(i));
    expect_good(body.mesh, cut_of(body.mesh, make_slab(random_slab(random, body.size))));
  }
}

TEST(SlowCut, FourCutsInARowStayValid) {
  Random random(21);
  const auto bodies = shapes();
  for (int i = 0; i < 24; ++i) {
    const Shape& shape = bodies[static_cast<std::size_t>(i) % bodies.size()];
    SurfaceMesh body = shape.mesh;
    for (int generation = 0; generation < 4; ++generation) {
      SCOPED_TRACE(std::string(shape.name) + " " + std::to_string(i) + " generation " + std::to_string(generation));
      CutResult result = cut_of(body, make_slab(random_slab(random, shape.size)));
      expect_good(body, result);
      if (!result.ok) break;
      body = std::move(result.fragments[0]);
    }
  }
}

// The set law itself, by another way: ray parity in doubles. Points nearer than 1e-6 to a surface are left out, the
// jitter being 1e-7 of the edge.
TEST(CutOracle, APointIsInAFragmentExactlyWhenItIsInTheBodyAndNotInTheSlab) {
  Random random(22);
  const auto bodies = shapes();
  int counted[2] = {0, 0};
  for (const Shape& body : bodies)
    for (int i = 0; i < 3; ++i) {
      SCOPED_TRACE(body.name);
      SlabShape shape = random_slab(random, body.size);
      shape.thickness = 0.1 * body.size;
      const SurfaceMesh slab = make_slab(shape);
      CutOptions options = options_for(body.mesh);
      options.min_fragment_volume = 0;
      const CutResult result = cut(body.mesh, slab, options);
      expect_good(body.mesh, result);
      const TriangleBvh in_body(body.mesh), in_slab(slab);
      std::vector<TriangleBvh> in_fragment;
      for (const SurfaceMesh& f : result.fragments) in_fragment.emplace_back(f);
      const Box box = bounding_box(body.mesh);
      for (int k = 0; k < 500; ++k) {
        const Vec3 p{random.uniform(box.low.x, box.high.x), random.uniform(box.low.y, box.high.y),
                     random.uniform(box.low.z, box.high.z)};
        const Real close = 1e-6 * body.size;
        if (in_body.closest(p, close).face != kNone || in_slab.closest(p, close).face != kNone) continue;
        const bool expected = in_body.inside(p) && !in_slab.inside(p);
        int count = 0;
        for (const TriangleBvh& f : in_fragment) count += f.inside(p);
        ASSERT_EQ(count, expected ? 1 : 0);
        ++counted[expected];
      }
    }
  EXPECT_GT(counted[0], 1000);
  EXPECT_GT(counted[1], 1000);
}

TEST(SlowCut, RandomSlabsThroughAScannedSurfaceLeaveOnlyValidBodies) {
  const std::string path = std::string(SHERD_SHARED) + "/meshes/dev/bunny_5k.ply";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is absent";
  LoadLog log;
  const SurfaceMesh body = load_mesh(path, {}, log);
  ASSERT_TRUE(is_valid(report_mesh(body, {true, 10})));
  const Box box = bounding_box(body);
  Random random(23);
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE(i);
    SlabShape shape = random_slab(random, 0.4 * box.diagonal());
    shape.centre += box.centre();
    expect_good(body, cut_of(body, make_slab(shape)));
  }
}

}  // namespace
}  // namespace sherd
