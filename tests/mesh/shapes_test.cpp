#include "engine/mesh/shapes.h"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>

#include "engine/mesh/validate.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

constexpr Real kPi = std::numbers::pi;

struct NamedShape {
  const char* name;
  std::function<SurfaceMesh(Real)> make;  // of the edge length
  Real edge;                              // a coarse one
  std::size_t components;
  int genus;
};

std::vector<NamedShape> all_shapes() {
  return {{"box",
           [](Real e) {
             return make_box({1, 2, 3}, e);
           },
           0.5, 1, 0},
          {"coarse box",
           [](Real e) {
             return make_box({1, 1, 1}, e);
           },
           5, 1, 0},
          {"plate", [](Real e) { return make_plate(1, 0.7, 0.02, e); }, 0.1, 1, 0},
          {"bar", [](Real e) { return make_bar(4, 1, 2, e); }, 0.5, 1, 0},
          {"sphere", [](Real e) { return make_sphere(0.5, e); }, 0.3, 1, 0},
          {"hollow sphere", [](Real e) { return make_hollow_sphere(1, 0.5, e); }, 0.3, 2, 0},
          {"thin hollow sphere", [](Real e) { return make_hollow_sphere(1, 0.95, e); }, 0.3, 2, 0},
          {"cylinder", [](Real e) { return make_cylinder(0.5, 2, e); }, 0.3, 1, 0},
          {"needle cylinder", [](Real e) { return make_cylinder(0.01, 1, e); }, 0.3, 1, 0},
          {"dinner plate", [](Real e) { return make_dinner_plate(0.13, 0.005, e); }, 0.03, 1, 0},
          {"goblet", [](Real e) { return make_goblet(0.2, 0.04, 0.0015, e); }, 0.015, 1, 0},
          {"wide goblet", [](Real e) { return make_goblet(0.1, 0.1, 0.003, e); }, 0.015, 1, 0},
          {"torus", [](Real e) { return make_torus(1, 0.3, e); }, 0.3, 1, 1},
          {"tumbler", [](Real e) { return make_tumbler(0.1, 0.035, 0.003, e); }, 0.012, 1, 0},
          {"thick tumbler", [](Real e) { return make_tumbler(0.05, 0.05, 0.01, e); }, 0.015, 1, 0},
          {"vase", [](Real e) { return make_vase(0.25, 0.07, 0.005, e); }, 0.02, 1, 0},
          {"round vase", [](Real e) { return make_vase(0.1, 0.1, 0.01, e); }, 0.02, 1, 0},
          {"figurine", [](Real e) { return make_figurine(0.2, e); }, 0.02, 1, 0},
          {"twisted column", [](Real e) { return make_twisted_column(0.1, 0.3, 2, e); }, 0.03, 1, 0}};
}

TEST(Shapes, AreValidSolidsAtEveryEdgeLength) {
  for (const NamedShape& shape : all_shapes())
    for (const Real factor : {3.0, 1.0, 0.5, 0.2}) {
      if (factor > 1 && std::string(shape.name) == "thin hollow sphere")
        continue;  // refused: facets deeper than the wall
      const SurfaceMesh mesh = shape.make(factor * shape.edge);
      const MeshReport r = report_mesh(mesh, {.count_self_intersections = factor >= 0.5});
      EXPECT_TRUE(is_valid(r)) << shape.name << " at " << factor << "\n" << to_text(r);
      EXPECT_EQ(r.components, shape.components) << shape.name;
      EXPECT_EQ(r.genus, shape.genus) << shape.name;
      EXPECT_EQ(r.unused_vertices, 0u) << shape.name;
      EXPECT_EQ(r.needle_triangles, 0u) << shape.name;
      EXPECT_EQ(mesh.faces.kind.size(), mesh.triangle_count());
    }
}

// Where no thin wall forces slim triangles, the mean edge follows the wish (the right isosceles triangles of a box have
// mean edge 1.14 e) and no angle is below 15 degrees.
TEST(Shapes, EdgesFollowTheWishedLength) {
  for (const NamedShape& shape : all_shapes()) {
    const std::string name = shape.name;
    if (name != "box" && name != "bar" && name != "sphere" && name != "cylinder" && name != "torus") continue;
    const Real edge = 0.25 * shape.edge;
    const MeshReport r = report_mesh(shape.make(edge));
    EXPECT_NEAR(r.mean_edge / edge, 1.05, 0.15) << name;
    EXPECT_GT(r.min_angle, 15.0) << name;
    EXPECT_LT(r.max_edge, 2 * edge) << name;
  }
}

// Inscribed facets of edge e miss a volume fraction of order (e/R)^2: halving e divides the error by 4 (3 to 5 with
// rounding of the counts).
TEST(Shapes, VolumesConvergeToTheAnalyticWithSecondOrder) {
  const struct {
    const char* name;
    std::function<SurfaceMesh(Real)> make;
    Real exact, edge;
  } cases[] = {{"sphere", [](Real e) { return make_sphere(1, e); }, 4 * kPi / 3, 0.2},
               {"hollow sphere", [](Real e) { return make_hollow_sphere(1, 0.5, e); }, 4 * kPi / 3 * (1 - 0.125), 0.1},
               {"cylinder", [](Real e) { return make_cylinder(1, 3, e); }, 3 * kPi, 0.2},
               {"torus", [](Real e) { return make_torus(1, 0.4, e); }, 2 * kPi * kPi * 0.16, 0.1}};
  for (const auto& c : cases) {
    const Real coarse = c.exact - signed_volume(c.make(c.edge)), fine = c.exact - signed_volume(c.make(0.5 * c.edge));
    EXPECT_GT(coarse, 0) << c.name;
    EXPECT_LT(coarse, 0.05 * c.exact) << c.name;
    EXPECT_NEAR(coarse / fine, 4.0, 1.0) << c.name;
  }
  // Boxes are exact: a few roundings of sums of about 100 terms.
  EXPECT_NEAR(signed_volume(make_box({1, 2, 3}, 0.3)), 6.0, 1e-12);
  EXPECT_NEAR(signed_volume(make_plate(1, 0.5, 0.01, 0.1)), 0.005, 1e-14);
}

// The plate's wall volume is about its mid-surface area times the thickness (Pappus); the fine mesh is within 2 %.
TEST(Shapes, DinnerPlateHasUniformWall) {
  const Real radius = 0.13, t = 0.005, bend = 0.2 * radius, rise = kPi / 6;
  const Real flat = 0.6 * radius, r1 = flat + bend * std::sin(rise), r2 = radius - 0.5 * t;
  const Real bent = 2 * kPi * bend * (flat * rise + bend * (1 - std::cos(rise)));
  const Real exact =
      t * (kPi * flat * flat + bent + kPi * (r2 * r2 - r1 * r1) / std::cos(rise)) + 2 * kPi * r2 * 0.125 * kPi * t * t;
  EXPECT_NEAR(signed_volume(make_dinner_plate(radius, t, 0.002)), exact, 0.02 * exact);
}

// Of a conical wall between parallel lines (Pappus) and the bottom disc; the fine mesh is within 2 %, of which the
// rounded lip and foot are half.
TEST(Shapes, ATumblersWallIsUniformAndItsBottomTwiceAsThick) {
  const Real height = 0.1, radius = 0.035, wall = 0.003, half = 0.5 * wall;
  const Real r0 = 0.75 * radius - half, r1 = radius - half, rise = height - wall;
  const Real slant = std::hypot(rise, r1 - r0), side = kPi * (r0 + r1) * slant * wall;
  const Real inner = r0 - half + (1.5 * wall / rise) * (r1 - r0);
  const Real exact = side + kPi * inner * inner * 2 * wall;
  EXPECT_NEAR(signed_volume(make_tumbler(height, radius, wall, 0.002)), exact, 0.02 * exact);
}

// A twist moves every horizontal section as a whole: the area of each, and so the volume, stays but for the facets of
// the curved sides, which err by order (turn edge / height)^2.
TEST(Shapes, ATwistKeepsTheVolumeToSecondOrder) {
  const auto error = [](Real edge) { return std::abs(signed_volume(make_twisted_column(0.1, 0.3, 2, edge)) - 0.003); };
  EXPECT_LT(error(0.01), 0.01 * 0.003);
  EXPECT_NEAR(error(0.02) / error(0.01), 4, 1);
}

TEST(Shapes, StandWhereTheirHeaderSays) {
  for (const SurfaceMesh& mesh : {make_tumbler(0.1, 0.035, 0.003, 0.01), make_vase(0.1, 0.035, 0.003, 0.01),
                                  make_figurine(0.1, 0.01), make_twisted_column(0.05, 0.1, 1, 0.01)}) {
    EXPECT_NEAR(bounding_box(mesh).low.y, 0.0, 1e-15);
    EXPECT_NEAR(bounding_box(mesh).high.y, 0.1, 1e-4);
  }
  // Rings have a vertex on the x axis or half a segment beside it: facets take at most 1 - cos(pi / 18) of the radius.
  EXPECT_NEAR(bounding_box(make_tumbler(0.1, 0.035, 0.003, 0.01)).high.x, 0.035, 0.035 * 0.016);
  EXPECT_NEAR(bounding_box(make_vase(0.1, 0.035, 0.003, 0.004)).high.x, 0.035, 0.035 * 0.016);
  EXPECT_NEAR(bounding_box(make_figurine(0.1, 0.004)).high.x, 0.0305, 1e-4);
  const Box plate = bounding_box(make_dinner_plate(0.13, 0.005, 0.01));
  EXPECT_EQ(plate.low.y, 0.0);
  const Box goblet = bounding_box(make_goblet(0.2, 0.04, 0.0015, 0.004));
  EXPECT_EQ(goblet.low.y, 0.0);
  EXPECT_NEAR(goblet.high.y, 0.2, 1e-4);
  EXPECT_NEAR(goblet.high.x, 0.04, 1e-6);
  const Box box = bounding_box(make_bar(4, 1, 2, 0.3));
  EXPECT_EQ(box.low, (Vec3{-2, -0.5, -1}));
  EXPECT_EQ(box.high, (Vec3{2, 0.5, 1}));
}

TEST(Shapes, AreDeterministic) {
  for (const NamedShape& shape : all_shapes()) EXPECT_EQ(shape.make(shape.edge), shape.make(shape.edge)) << shape.name;
}

TEST(Shapes, RefuseWhatIsNoSolid) {
  EXPECT_THROW(make_box({1, 0, 1}, 0.1), InputError);
  EXPECT_THROW(make_box({1, 1, 1}, -1), InputError);
  EXPECT_THROW(make_box({1, 1, 1}, 1e-9), InputError);
  EXPECT_THROW(make_sphere(std::nan(""), 0.1), InputError);
  EXPECT_THROW(make_hollow_sphere(1, 1.5, 0.1), InputError);
  EXPECT_THROW(make_hollow_sphere(1, 0.99, 1), InputError);
  EXPECT_THROW(make_torus(1, 1.1, 0.1), InputError);
  EXPECT_THROW(make_dinner_plate(0.1, 0.05, 0.01), InputError);
  EXPECT_THROW(make_goblet(0.2, 0.04, 0.01, 0.01), InputError);
  EXPECT_THROW(make_tumbler(0.1, 0.03, 0.007, 0.01), InputError);
  EXPECT_THROW(make_vase(0.1, 0.03, 0.005, 0.01), InputError);
  EXPECT_THROW(make_figurine(-1, 0.01), InputError);
  EXPECT_THROW(make_twisted_column(0.1, 0.1, 7, 0.01), InputError);
}

}  // namespace
}  // namespace sherd
