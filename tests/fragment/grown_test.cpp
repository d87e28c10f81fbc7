// Grown sheets cut out of bodies: exact coincidences (the design's T3), thin and thick slabs (T6).
#include "engine/fracture/grow.h"
#include "engine/fracture/synthetic_fields.h"
#include "engine/fracture/thicken.h"
#include "engine/mesh/shapes.h"
#include "tests/fragment/slabs.h"

namespace sherd {
namespace {

struct Grown {
  GrowthResult growth;
  SurfaceMesh slab;
};

CrackSeed seed_at(const SurfaceMesh& mesh, std::uint32_t vertex, const CrackField& field) {
  CrackSeed seed;
  seed.position = mesh.vertices[vertex], seed.vertex = vertex;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    for (const std::uint32_t v : mesh.triangles[t])
      if (v == vertex) seed.normal += mesh.area_normal2(t);
  seed.normal = normalized(seed.normal);
  Vec3Column at;
  at.push_back(seed.position);
  std::vector<PrincipalStress> stress;
  field.principal_stress(at, stress);
  seed.stress = stress[0];
  return seed;
}

std::uint32_t nearest_vertex(const SurfaceMesh& mesh, const Vec3& p) {
  std::uint32_t best = 0;
  for (std::uint32_t v = 1; v < mesh.vertex_count(); ++v)
    if (distance2(mesh.vertices[v], p) < distance2(mesh.vertices[best], p)) best = v;
  return best;
}

// From the body's vertex nearest to `near`; an empty slab when the crack was refused, cleanly.
Grown grow_slab(const SurfaceMesh& body, const CrackField& field, const Vec3& near, Real h, Real thickness,
                Real overshoot = 0.15) {
  GrowthOptions options;
  options.edge_length = h, options.thickness = thickness, options.overshoot = overshoot,
  options.propagation_strength = 0.5;
  Grown g;
  g.growth = grow_crack(TriangleBvh(body), field, seed_at(body, nearest_vertex(body, near), field), options);
  if (g.growth.outcome != GrowthOutcome::kComplete) {
    EXPECT_FALSE(g.growth.reason.empty());
    return g;
  }
  std::string reason;
  const auto slab = thicken(g.growth.sheet, thickness, 1, reason);
  EXPECT_TRUE(slab) << reason;
  if (slab) g.slab = *slab;
  return g;
}

// Seeds on lattice vertices and a constant direction along an axis: sheet nodes lie in lattice planes, slab walls
// parallel to the cube's faces.
TEST(CutGrown, CracksInLatticePlanesOfACubeSeparateItOrAreRefused) {
  const Real h = 0.125;
  const SurfaceMesh body = make_box({1, 1, 1}, h);
  int separated = 0;
  for (const Vec3& e : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
    for (const Real place : {0.0, 0.125, 0.25, 0.375}) {
      const FunctionField field(constant_direction(e));
      const Vec3 side = e.x != 0 ? Vec3{0, 0.5, 0.125} : Vec3{0.5, 0, 0.125};
      const Vec3 near = place * e + (e.z != 0 ? Vec3{0.5, 0.125, 0} : side);
      const Grown g = grow_slab(body, field, near, h, 1e-3);
      if (g.slab.triangles.empty()) continue;
      const CutResult result = cut_of(body, g.slab);
      expect_good(body, result);
      EXPECT_EQ(result.fragments.size(), 2u);
      EXPECT_NEAR(signed_volume(result.fragments[1]), 0.5 - place, 2e-3);
      ++separated;
    }
  EXPECT_GE(separated, 11);  // of twelve
}

// The second slab's walls coincide with, or lie between, or beside the walls that the first left.
TEST(CutGrown, TheSameSlabAgainAndShiftedAlongItsThicknessStaysValid) {
  const Real h = 0.125, t = 2e-3;
  const SurfaceMesh body = make_box({1, 1, 1}, h);
  const FunctionField field(constant_direction({1, 0, 0}));
  const Grown g = grow_slab(body, field, {0.125, 0.5, 0.125}, h, t);
  ASSERT_FALSE(g.slab.triangles.empty()) << g.growth.reason;
  const CutResult first = cut_of(body, g.slab);
  expect_good(body, first);
  ASSERT_EQ(first.fragments.size(), 2u);
  for (const Real shift : {0.0, 0.5 * t, t, 1e-9 * h, -1e-9 * h})
    for (const SurfaceMesh& piece : first.fragments) {
      const CutResult second = cut_of(piece, moved(g.slab, [shift](const Vec3& p) { return p + Vec3{shift, 0, 0}; }));
      expect_good(piece, second);
      EXPECT_EQ(second.fragments.size(), 1u);
      EXPECT_LT(second.removed_volume, 1.1 * t);
    }
}

// From slabs thinner than a ten-thousandth of an edge to as thick as one, with overshoots from a twentieth to a half.
TEST(SlowCutGrown, ThicknessAndOvershootOverFourDecadesGiveValidPiecesOrACleanRefusal) {
  struct Case {
    SurfaceMesh mesh;
    Real h;
    Vec3 near;
  };
  const std::vector<Case> cases = {{make_sphere(1, 0.2), 0.2, {0.1, 1, 0.1}},
                                   {make_box({1, 1, 1}, 0.1), 0.1, {0.03, 0.5, 0.1}},
                                   {make_plate(1, 1, 0.05, 0.1), 0.1, {0.1, 0, 0.2}}};  // half an edge thick
  int cut_count = 0, all = 0;
  for (const Case& c : cases)
    for (const Real ratio : {1e-4, 1e-3, 1e-2, 0.1, 0.3, 1.0})
      for (const Real overshoot : {0.05, 0.15, 0.5}) {
        SCOPED_TRACE(std::to_string(ratio) + " " + std::to_string(overshoot));
        const FunctionField field(noisy_direction({0.9, 0.1, 0.3}, 0.1, 8 * c.h, 3));
        const Grown g = grow_slab(c.mesh, field, c.near, c.h, ratio * c.h, overshoot);
        ++all;
        if (g.slab.triangles.empty()) continue;
        CutOptions options;
        options.edge_length = c.h, options.slab_checked = true;
        const CutResult result = cut(c.mesh, g.slab, options);
        expect_good(c.mesh, result);
        EXPECT_TRUE(result.separated);
        // thickness times area, but for the slab's slant at the surface: thickness over the size of the piece
        EXPECT_NEAR(result.removed_volume, ratio * c.h * g.growth.area,
                    (0.02 + 2 * ratio * c.h) * ratio * c.h * g.growth.area);
        ++cut_count;
      }
  EXPECT_GE(cut_count, all * 9 / 10);
}

// Bodies much coarser and much finer than the sheet.
TEST(CutGrown, TheBodysEdgesMayBeFourTimesFinerOrCoarserThanTheSheets) {
  const Real h = 0.16;
  for (const Real edge : {h / 4, h, 4 * h}) {
    const SurfaceMesh body = make_box({1, 1, 1}, edge);
    const FunctionField field(noisy_direction({0.2, 0.1, 0.9}, 0.1, 8 * h, 4));
    const Grown g = grow_slab(body, field, {0.5, 0.03, 0.02}, h, 1e-3);
    ASSERT_FALSE(g.slab.triangles.empty()) << g.growth.reason;
    const CutResult result = cut_of(body, g.slab);
    expect_good(body, result);
    EXPECT_EQ(result.fragments.size(), 2u);
  }
}

}  // namespace
}  // namespace sherd
