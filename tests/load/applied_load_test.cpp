// Laws of loads without contact: force and moment are met on any mesh, tractions are those of the textbook.
#include "engine/load/applied_load.h"

#include <gtest/gtest.h>

#include <numbers>

#include "engine/load/inertia_relief.h"
#include "engine/load/surface_load.h"
#include "engine/mesh/shapes.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

const Box kRightEnd{{0.49, -1, -1}, {0.51, 1, 1}};
const Box kTopMiddle{{-0.037, 0, -1}, {0.041, 1, 1}};

Resultant applied(const SurfaceMesh& mesh, const AppliedLoad& load, const Vec3& origin) {
  Load out;
  EXPECT_GT(add_traction(mesh, spread(mesh, load), out), 0);
  return resultant(mesh, out, origin);
}

TEST(AppliedLoad, MeetsForceAndMomentOnAnyMesh) {
  const Vec3 force{300, -20, 7}, moment{4, -11, 2};
  for (const Real edge : {0.05, 0.031, 0.11})
    for (const Box& region : {kRightEnd, kTopMiddle}) {
      const SurfaceMesh bar = make_bar(1, 0.2, 0.15, edge);
      const AppliedLoad load{region, {}, force, moment};
      const Vec3 centre = spread(bar, load).centre;
      const Resultant r =
          applied(bar, load, centre);  // the force goes through the centroid, so the moment is the couple
      EXPECT_LT(norm(r.force - force), 1e-12 * norm(force));
      EXPECT_LT(norm(r.moment - moment), 1e-12 * norm(moment));
    }
}

TEST(AppliedLoad, RegionsMeshesCutAcrossStayWhereTheBoxIs) {
  // The loaded area and its centroid follow the box, not the faces: to the second order of the edge over the box,
  // here edges of half the box's length.
  const Real exact = 0.5 * (kTopMiddle.low.x + kTopMiddle.high.x), length = kTopMiddle.high.x - kTopMiddle.low.x;
  for (const Real edge : {0.04, 0.02, 0.013}) {
    const SurfaceMesh bar = make_bar(1, 0.2, 0.15, edge);
    const AppliedLoad load{kTopMiddle, {0, 1, 0}, {0, -100, 0}, {}};
    const AppliedTraction t = spread(bar, load);
    EXPECT_NEAR(t.centre.x, exact, 0.1 * edge);
    EXPECT_NEAR(t.centre.y, 0.1, 1e-12);  // only faces that look up, however much of the sides the box holds
    EXPECT_NEAR(-100 / t.uniform.y, length * 0.15, 1e-9);  // shares are exact areas
  }
}

TEST(AppliedLoad, ACoupleOnAShaftsEndIsTheTractionOfItsTorsion) {
  const Real radius = 0.1, torque = 50;
  const SurfaceMesh shaft = make_cylinder(radius, 1, 0.02);
  const Box box = bounding_box(shaft);
  const Box end{{box.low.x, box.high.y - 1e-6, box.low.z}, {box.high.x, box.high.y + 1e-6, box.high.z}};
  const AppliedTraction t = spread(shaft, {end, {0, 1, 0}, {}, {0, torque, 0}});
  EXPECT_LT(norm(t.uniform), 1e-12);
  // tau = T r / J with J = pi R^4 / 2; the polygon of 0.02 edges has 2 (edge / R)^2 / 12 less: 1 % with a margin of 2.
  const Real polar = std::numbers::pi * std::pow(radius, 4) / 2;
  EXPECT_NEAR(t.twist.y, torque / polar, 0.02 * torque / polar);
  EXPECT_LT(std::hypot(t.twist.x, t.twist.z), 1e-9 * t.twist.y);
}

TEST(AppliedLoad, OppositePullsNeedNoInertiaAndOneAloneIsBalancedByIt) {
  const SurfaceMesh bar = make_bar(1, 0.2, 0.15, 0.05);
  const MassProperties mass = mass_properties(bar, 2000);
  const Box left{{-0.51, -1, -1}, {-0.49, 1, 1}};
  SurfaceLoad pull;
  pull.applied = {spread(bar, {kRightEnd, {}, {1000, 0, 0}, {}}), spread(bar, {left, {}, {-1000, 0, 0}, {}})};
  const Load balanced = make_load(bar, mass, pull);
  EXPECT_LT(norm(balanced.body_force.constant) * mass.volume, 1e-9);
  EXPECT_NEAR(total_force(bar, balanced), 2000, 1e-9);
  pull.applied.pop_back();
  const Load alone = make_load(bar, mass, pull);
  EXPECT_NEAR(alone.body_force.constant.x * mass.volume, -1000, 1e-9);
  EXPECT_LT(norm(alone.net_force) + norm(alone.net_moment), 1e-9);
}

TEST(AppliedLoad, ARegionOffTheSurfaceIsRefused) {
  const SurfaceMesh bar = make_bar(1, 0.2, 0.15, 0.05);
  EXPECT_THROW(spread(bar, {{{0.6, -1, -1}, {0.7, 1, 1}}, {}, {1, 0, 0}, {}}), InputError);
  EXPECT_THROW(spread(bar, {kRightEnd, {-1, 0, 0}, {1, 0, 0}, {}}), InputError);
}

}  // namespace
}  // namespace sherd
