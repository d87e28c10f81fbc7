// The scenes of textbook cases break as scenes/README.md says.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "engine/mesh/surface_mesh.h"
#include "engine/step/simulation.h"
#include "tests/physics/circle.h"
#include "tests/physics/helix.h"

namespace sherd {
namespace {

constexpr Real kDegree = std::numbers::pi / 180;

struct Broken {
  std::vector<SurfaceMesh> pieces;  // in material space, just after loads or guides first act; largest first
  Vec3 seed;                        // of the first crack
};
Broken broken(const std::string& name) {
  Scene scene = load_scene(std::filesystem::path(SHERD_SOURCE) / "scenes" / name);
  scene.duration = 0.042;
  Simulation simulation(scene, {});
  while (!simulation.done()) simulation.step();
  Broken b;
  for (const FrameBody& body : simulation.snapshot().bodies) b.pieces.push_back(*body.mesh);
  std::sort(b.pieces.begin(), b.pieces.end(),
            [](const SurfaceMesh& x, const SurfaceMesh& y) { return signed_volume(x) > signed_volume(y); });
  const nlohmann::json stats = nlohmann::json::parse(simulation.stats_json());
  const std::vector<Real> seed = stats.at("events").at(0).at("cracks").at(0).at("seed");
  b.seed = {seed[0], seed[1], seed[2]};
  return b;
}
std::vector<SurfaceMesh> pieces_of(const std::string& name) {
  return broken(name).pieces;
}

template <class Visit>
void for_crack_faces(const SurfaceMesh& mesh, const Visit& visit) {
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    if (mesh.faces.kind[t] == FaceKind::kCrack) visit(mesh.centroid(t));
}

TEST(SlowScenes, TheNotchedBarBreaksAcrossTheNotchsTip) {
  const std::vector<SurfaceMesh> pieces = pieces_of("notched_bar.toml");
  ASSERT_EQ(pieces.size(), 2u);
  Real largest = 0;
  for_crack_faces(pieces[0], [&](const Vec3& x) { largest = std::max(largest, std::abs(x.y)); });
  EXPECT_LT(largest, 0.15 * 0.01);  // of an edge
}

TEST(SlowScenes, TheBentBarBreaksInTheMiddle) {
  const std::vector<SurfaceMesh> pieces = pieces_of("three_point_bending.toml");
  ASSERT_EQ(pieces.size(), 2u);
  for_crack_faces(pieces[0], [](const Vec3& x) { EXPECT_LT(std::abs(x.x), 0.011); });  // an edge
}

// On the side where the crack started; behind, its two ends are joined by a part that runs along the axis.
TEST(SlowScenes, TheChalksLipIsAHelixOf45Degrees) {
  const Broken chalk = broken("chalk_torsion.toml");
  ASSERT_EQ(chalk.pieces.size(), 2u);
  const SurfaceMesh& mesh = chalk.pieces[0];
  const std::vector<std::uint32_t> twins = build_twins(mesh);
  const Vec3 front = normalized(Vec3{chalk.seed.x, 0, chalk.seed.z});
  std::vector<TraceEdge> lip;
  for (std::uint32_t e = 0; e < twins.size(); ++e) {
    if (mesh.faces.kind[e / 3] != FaceKind::kCrack || mesh.faces.kind[twins[e] / 3] == FaceKind::kCrack) continue;
    const auto k = static_cast<int>(e % 3);
    const TraceEdge edge{mesh.corner(e / 3, k), mesh.corner(e / 3, (k + 1) % 3)};
    if (dot(normalized(Vec3{edge.from.x, 0, edge.from.z}), front) > 0.5) lip.push_back(edge);  // a third of a turn
  }
  const Helix h = helix(lip, 0.04);
  EXPECT_GT(h.length, 0.02);
  EXPECT_NEAR(-h.angle / kDegree, 45, 5);
}

TEST(SlowScenes, TheStruckPlateHasAtLeastThreeRadialArms) {
  const std::vector<SurfaceMesh> pieces = pieces_of("struck_plate.toml");
  EXPECT_GE(crossings(pieces, 0.06, 0.004), 3);
}

TEST(SlowScenes, GuidedCracksCutTheSphereInTwoAndTheBunnysEarsOff) {
  EXPECT_EQ(pieces_of("guided_sphere.toml").size(), 2u);
  if (!std::filesystem::exists("/usr/share/glmark2/models/bunny.obj")) GTEST_SKIP() << "no bunny";
  EXPECT_EQ(pieces_of("guided_bunny.toml").size(), 4u);
}

}  // namespace
}  // namespace sherd
