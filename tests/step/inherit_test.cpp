// What fragments inherit: mass and momenta to rounding.
#include "engine/step/inherit.h"

#include <gtest/gtest.h>

#include "engine/fragment/cut.h"
#include "engine/mesh/shapes.h"

namespace sherd {
namespace {

Body moving_box() {
  Body b;
  b.id = b.parent = BodyId{3};
  b.mesh = std::make_shared<SurfaceMesh>(make_box({0.3, 0.2, 0.25}, 0.05));
  b.density = 2000;
  b.mass = mass_properties(*b.mesh, b.density);
  b.pose = {{4, 1, -2}, normalized(Quat{0.3, 0.5, -0.2, 0.7})};
  b.velocity = {1.5, -4, 0.3};
  b.angular_velocity = {5, 2, -9};
  return b;
}

TEST(InheritMotion, ConservesMassMomentumAndAngularMomentumAcrossACut) {
  const Body parent = moving_box();
  SurfaceMesh slab = make_box({0.004, 0.5, 0.5}, 0.1);
  for (std::size_t i = 0; i < slab.vertex_count(); ++i) slab.vertices.add(i, {0.031, 0.002, 0.0013});
  const CutResult c = cut(*parent.mesh, slab, {0.05, 1, 1e-6});
  ASSERT_TRUE(c.ok) << c.reason;
  ASSERT_EQ(c.fragments.size(), 2u);
  std::vector<Body> fragments(2, parent);
  for (std::size_t k = 0; k < 2; ++k) fragments[k].mesh = std::make_shared<SurfaceMesh>(c.fragments[k]);
  inherit_motion(parent, fragments);
  const Momenta before = momenta(parent);
  Momenta after;
  for (const Body& f : fragments) {
    after += momenta(f);
    EXPECT_GT(f.density, parent.density);  // makes up for the slab
  }
  EXPECT_NEAR(after.mass, before.mass, 1e-13 * before.mass);
  EXPECT_LT(norm(after.linear - before.linear), 1e-12 * norm(before.linear));
  EXPECT_LT(norm(after.angular - before.angular), 1e-12 * norm(before.angular));
  // Every point keeps its place.
  const Vec3 x{0.1, 0.05, -0.08};
  EXPECT_LT(distance(to_world(fragments[0], x), to_world(parent, x)), 1e-14);
}

}  // namespace
}  // namespace sherd
