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

}  // namespace
}  // namespace sherd
