// Exact coincidences between slab and body: planes through vertices and edges, coplanar faces, the same cut twice.
#include "engine/mesh/shapes.h"
#include "tests/fragment/slabs.h"

namespace sherd {
namespace {

SurfaceMesh flat_slab(Real x, Real thickness, Real edge) {
  return moved(make_box({thickness, 2, 2}, edge), [x](const Vec3& p) { return p + Vec3{x, 0, 0}; });
}

// Lattice of the cube: multiples of 0.25 from -0.5 on. Jitter of 1e-7 h: the volumes are known to 1e-7.
TEST(CutCoincidence, PlanesThroughVerticesEdgesAndDiagonalsOfTheBody) {
  const SurfaceMesh body = make_box({1, 1, 1}, 0.25);
  for (const Real edge : {3.0, 0.5, 0.25})
    for (const Real x : {0.0, 0.25, 0.0625, -0.25}) {
      const CutResult result = cut_of(body, flat_slab(x, 0.125, edge));
      expect_good(body, result);
      ASSERT_EQ(result.fragments.size(), 2u);
      EXPECT_NEAR(result.removed_volume, 0.125, 1e-7);
    }
}

TEST(CutCoincidence, ASlabWallInTheBodysOwnFacePlane) {
  const SurfaceMesh body = make_box({1, 1, 1}, 0.25);
  for (const Real edge : {3.0, 0.5}) {
    // Its outer wall is coplanar with the face x = 0.5: what the jitter leaves there is dust.
    const CutResult result = cut_of(body, flat_slab(0.4375, 0.125, edge));
    expect_good(body, result);
    ASSERT_EQ(result.fragments.size(), 1u);
    EXPECT_NEAR(result.removed_volume, 0.125, 1e-7);
    EXPECT_LT(result.dust_volume, 1e-7);
  }
}

TEST(CutCoincidence, ASlabThatTouchesFromOutsideTakesAlmostNothing) {
  const SurfaceMesh body = make_box({1, 1, 1}, 0.25);
  const CutResult result = cut_of(body, flat_slab(0.5625, 0.125, 0.5));
  expect_good(body, result);
  ASSERT_EQ(result.fragments.size(), 1u);
  EXPECT_LT(result.removed_volume, 1e-7);
}

TEST(CutCoincidence, ASecondCutAtTheSameOrAShiftedPlaneIsValid) {
  const Real thickness = 0.01;
  const SurfaceMesh body = make_box({1, 1, 1}, 0.25);
  for (const Real edge : {3.0, 0.3}) {
    const CutResult first = cut_of(body, flat_slab(0.1, thickness, edge));
    expect_good(body, first);
    ASSERT_EQ(first.fragments.size(), 2u);
    for (const Real shift : {0.0, 0.5 * thickness, thickness, 0.25e-9})
      for (const SurfaceMesh& piece : first.fragments) {
        const CutResult second = cut_of(piece, flat_slab(0.1 + shift, thickness, edge));
        expect_good(piece, second);
        EXPECT_EQ(second.fragments.size(), 1u);
      }
  }
}

TEST(CutCoincidence, AnUncutNotchCrossedAtAnyAngleIsValid) {
  const SurfaceMesh body = make_box({1, 1, 1}, 0.2);
  SlabShape notch;
  notch.wedge = true, notch.thickness = 0.02, notch.cells = 6, notch.half_u = 0.6, notch.half_v = 1.1;
  notch.normal = {0, 0, 1}, notch.centre = {0.43, 0.011, 0.07};
  const CutResult first = cut_of(body, make_slab(notch));
  expect_good(body, first);
  for (const Real degrees : {90.0, 45.0, 10.0, 1.0, 0.0}) {
    const Real a = degrees / 180 * 3.14159265358979;
    SlabShape crossing;
    crossing.normal = {0, std::sin(a), std::cos(a)}, crossing.centre = {0, 0.013, 0.072}, crossing.thickness = 0.01;
    const CutResult second = cut_of(first.fragments[0], make_slab(crossing));
    expect_good(first.fragments[0], second);
    EXPECT_GE(second.fragments.size(), 2u) << degrees;
  }
}

}  // namespace
}  // namespace sherd
