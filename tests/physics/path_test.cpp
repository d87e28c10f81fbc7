// The path of a crack is a property of body and load, not of the mesh.
#include "tests/physics/breaking.h"

namespace sherd {
namespace {

// Root mean square distance from the part of `a` inside `body` to `b`, m.
Real path_distance(const CrackSheet& a, const CrackSheet& b, const TriangleBvh& body) {
  const SurfaceMesh from = mesh_of(a);
  const TriangleBvh to(mesh_of(b));
  Real sum = 0, total = 0;
  for (std::size_t t = 0; t < from.triangle_count(); ++t) {
    if (!body.inside(from.centroid(t))) continue;
    const Real area = norm(from.area_normal2(t));
    sum += area * to.closest(from.centroid(t)).distance2, total += area;
  }
  return std::sqrt(sum / total);
}

// Off the middle of a bent beam, tension turns from the axis towards the load point as shear takes over: the crack
// starts upright and bends, and stops where the beam is compressed. (Beyond that no stress steers it.)
TEST(SlowCrackPath, ConvergesWithTheMesh) {
  std::vector<CrackSheet> paths;
  std::unique_ptr<Breaking> beam;
  for (const Real edge : {0.24, 0.12, 0.06}) {
    beam = std::make_unique<Breaking>(exact::bent_beam(edge));
    ASSERT_TRUE(beam->solved.ok) << beam->solved.reason;
    CrackSeed seed;
    seed.position = {-0.8, -0.5, 0.03}, seed.normal = {0, -1, 0};
    Vec3Column point;
    point.push_back(seed.position);
    std::vector<PrincipalStress> stress;
    beam->field->principal_stress(point, stress);
    seed.stress = stress[0];
    GrowthResult crack = grow_crack(beam->bvh(), *beam->field, seed, beam->options(0.2));
    ASSERT_EQ(crack.outcome, GrowthOutcome::kArrested) << crack.reason;
    EXPECT_EQ(crack.ladder_level, 0);
    paths.push_back(std::move(crack.sheet));
  }
  const Real coarse = path_distance(paths[0], paths[1], beam->bvh()),
             fine = path_distance(paths[1], paths[2], beam->bvh());
  RecordProperty("coarse", std::to_string(coarse));
  RecordProperty("fine", std::to_string(fine));
  EXPECT_LT(coarse, 0.24 / 4);             // paths of different meshes are far closer than an edge
  EXPECT_LT(fine, coarse / std::sqrt(2));  // steps are a share of the edge: first order would halve it
}

}  // namespace
}  // namespace sherd
