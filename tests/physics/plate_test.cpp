// A plate struck in the middle: radial cracks. The first crack runs through the middle; each half then bends about its
// own cut edge and cracks from there, which takes the stress of the halves.
#include "engine/fracture/thicken.h"
#include "engine/fragment/cut.h"
#include "engine/mesh/remesh.h"
#include "tests/physics/breaking.h"
#include "tests/physics/circle.h"

namespace sherd {
namespace {

struct Strengths {
  Real initiation, propagation;  // Pa
};

// The pieces that the first of the strongest seeds to go through makes of `piece`; none when nothing does.
std::vector<SurfaceMesh> break_piece(const exact::Breakage& piece, const Strengths& strength, Real crack_edge) {
  constexpr std::size_t kTries = 5;
  const Breaking breaking(piece);
  if (!breaking.solved.ok) return {};
  const std::vector<CrackSeed> seeds = breaking.seeds(strength.initiation);
  for (std::size_t i = 0; i < std::min(kTries, seeds.size()); ++i) {
    GrowthOptions options = breaking.options(strength.propagation);
    options.edge_length = crack_edge;  // the plate is one edge of its mesh thick, and half of that is in tension
    const GrowthResult crack = breaking.grow(seeds[i], options);
    std::string reason;
    const auto slab = thicken(crack.sheet, options.thickness, 0, reason);
    if (crack.outcome != GrowthOutcome::kComplete || !slab) continue;
    CutOptions cutting;
    cutting.edge_length = piece.edge;
    CutResult result = cut(piece.mesh, *slab, cutting);
    if (!result.ok || result.fragments.size() < 2) continue;
    for (SurfaceMesh& fragment : result.fragments) {
      RemeshOptions fine;
      fine.edge_length = piece.edge;
      SurfaceMesh out;
      if (remesh(fragment, fine, out).status == RemeshStatus::kOk) fragment = std::move(out);
    }
    return std::move(result.fragments);
  }
  return {};
}

TEST(SlowStruckPlate, CracksRadially) {
  constexpr Real kEdge = 0.1, kCrackEdge = 0.03;
  const exact::Breakage plate = exact::struck_plate(kEdge);
  const Real peak = Breaking(plate).strongest().stress.value;
  const Strengths strength{0.25 * peak, 0.05 * peak};
  std::vector<SurfaceMesh> pieces{plate.mesh};
  for (int round = 0; round < 2; ++round) {
    std::vector<SurfaceMesh> next;
    for (SurfaceMesh& mesh : pieces) {
      exact::Breakage piece = plate;
      piece.mesh = mesh;
      std::vector<SurfaceMesh> parts = break_piece(piece, strength, kCrackEdge);
      if (parts.empty()) parts.push_back(std::move(mesh));
      std::move(parts.begin(), parts.end(), std::back_inserter(next));
    }
    pieces = std::move(next);
  }
  // Near the tension side, half-way between the hit and the edge.
  EXPECT_GE(crossings(pieces, 0.5, -0.03), 3);
  // Crack walls between hit and support contain the radial direction: the mean angle is far below the 45 degrees of
  // random directions.
  Real sum = 0, total = 0;
  for (const SurfaceMesh& piece : pieces)
    for (std::size_t t = 0; t < piece.triangle_count(); ++t) {
      const Vec3 x = piece.centroid(t), n2 = piece.area_normal2(t), radial = normalized(Vec3{x.x, 0, x.z});
      const Real r = std::hypot(x.x, x.z);
      if (piece.faces.kind[t] != FaceKind::kCrack || r < 0.25 || r > 0.9) continue;
      sum += std::asin(std::min(std::abs(dot(normalized(n2), radial)), 1.0)) * norm(n2), total += norm(n2);
    }
  ASSERT_GT(total, 0);
  EXPECT_LT(sum / total, 25 * std::numbers::pi / 180);
  RecordProperty("pieces", static_cast<int>(pieces.size()));
  RecordProperty("arms", crossings(pieces, 0.5, -0.03));
  RecordProperty("angle", std::to_string(sum / total * 180 / std::numbers::pi));
}

}  // namespace
}  // namespace sherd
