// Pieces share what the whole body bore.
#include <gtest/gtest.h>

#include "engine/fragment/cut.h"
#include "engine/load/inertia_relief.h"
#include "engine/load/surface_load.h"
#include "engine/mesh/shapes.h"

namespace sherd {
namespace {

TEST(SurfaceLoad, PiecesShareWhatTheWholeBodyBore) {
  // A plate hit in its middle and pulled at both ends, cut in two beside the middle.
  const SurfaceMesh plate = make_plate(0.4, 0.4, 0.02, 0.02);
  const TriangleBvh bvh(plate);
  const std::vector<BodyContact> contacts = {{{0.003, 0.01, 0.001}, {5, -900, 0}, 1e-3, 0.03}};
  SurfaceLoad whole{contact_patches(plate, contacts, build_twins(plate), bvh), {}, {1, 2, 3}};
  const Box right{{0.19, -1, -1}, {0.21, 1, 1}}, front{{-1, -1, 0.19}, {1, 1, 0.21}};
  whole.applied = {spread(plate, {right, {1, 0, 0}, {100, 0, 0}, {}}),
                   spread(plate, {front, {0, 0, 1}, {0, 0, 70}, {}})};
  const Real thickness = 1e-4;
  SurfaceMesh slab = make_box({thickness, 0.5, 0.5}, 0.1);
  for (std::size_t i = 0; i < slab.vertex_count(); ++i) slab.vertices.add(i, {0.0113, 0.002, 0.0013});
  slab.faces.kind.assign(slab.triangle_count(), FaceKind::kCrack);
  const CutResult c = cut(plate, slab, {0.02, 1, 1e-6});
  ASSERT_EQ(c.fragments.size(), 2u) << c.reason;
  Vec3 patch_force;
  Resultant sum;
  for (const SurfaceMesh& piece : c.fragments) {
    const SurfaceLoad part = owned_part(piece, whole);
    EXPECT_EQ(part.omega, whole.omega);
    ASSERT_EQ(part.patches.size(), 1u);
    patch_force += part.patches[0].force;
    const Load load = make_load(piece, mass_properties(piece, 1), part);
    const Resultant r = resultant(piece, load, {});
    sum.force += r.force, sum.moment += r.moment;
    EXPECT_LT(norm(load.net_force), 1e-9);
  }
  // The slab took thickness x 2 radius of the patch and thickness x 0.02 of the front face; pressure peaks at 1.5 of
  // its mean, panels err by 1 %.
  const Vec3 all = contacts[0].force + Vec3{100, 0, 70};
  EXPECT_LT(norm(patch_force - contacts[0].force), 0.02 * 900);
  EXPECT_LT(norm(sum.force - all), 0.02 * 900 + 70 * thickness / 0.4);
  EXPECT_NEAR(sum.force.x, 105, 0.02 * 5);  // the right end is on one piece, whole
}

}  // namespace
}  // namespace sherd
