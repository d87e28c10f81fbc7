#include "engine/fragment/cut.h"

#include <fmt/format.h>

#include "engine/fragment/cut_checks.h"
#include "engine/fragment/pieces.h"
#include "engine/mesh/intersections.h"
#include "kernels/core/random.h"

namespace sherd {
namespace {

constexpr int kMaxJitters = 8;
constexpr Real kJitter = 1e-7;  // of h

// A copy, so that the columns of attributes are complete whatever the caller left out.
SurfaceMesh with_attributes(const SurfaceMesh& mesh) {
  SurfaceMesh copy = mesh;
  copy.faces.resize(mesh.triangle_count());
  return copy;
}

SurfaceMesh jittered(const SurfaceMesh& slab, Real amplitude, std::uint64_t seed) {
  SurfaceMesh moved = slab;
  Random random(seed);
  for (std::size_t i = 0; i < moved.vertex_count(); ++i) {
    const Real x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    moved.vertices.add(i, amplitude * Vec3{x, y, z});
  }
  return moved;
}

// One try with the slab as it is. `again`: another jitter may help.
Difference attempt(const CutOperand& body, const SurfaceMesh& slab_mesh, bool first, bool checked, bool& again) {
  Difference result;
  again = false;
  const CutOperand slab(slab_mesh);
  if (first && !checked)
    if (const std::string text = check_manifold(slab_mesh, slab.twin); !text.empty()) {
      result.reason = "the slab is not a closed manifold: " + text;
      return result;
    }
  // The caller's slab has to be embedded; one that a jitter has folded over is only an unlucky draw.
  again = !first;
  if (!(first && checked) && count_self_intersections(slab_mesh, 1) > 0) {
    result.reason = "the slab intersects itself";
    return result;
  }
  again = true;
  const Piercing piercing = pierce(body, slab);
  if (piercing.status != PierceStatus::kOk) {
    result.reason = piercing.reason;
    return result;
  }
  result = subtract(body, slab, piercing);
  if (!result.ok) return result;
  std::string text = check_balance(result);
  if (text.empty()) text = check_touched(result);
  if (text.empty() && !result.mesh.triangles.empty()) text = check_manifold(result.mesh, build_twins(result.mesh));
  result.ok = text.empty(), result.reason = text;
  return result;
}

void collect(const Difference& difference, const CutOptions& options, CutResult& result) {
  result.reason.clear();
  result.removed_volume = difference.removed_volume;
  result.touched = difference.touched.size();
  std::vector<Piece> pieces = split_pieces(difference.mesh);
  result.separated = pieces.size() > 1;
  for (Piece& piece : pieces) {
    const bool dust = piece.volume < options.min_fragment_volume * difference.body_volume;
    if (dust && options.dust == DustRule::kDrop) {
      result.dust_volume += piece.volume;
    } else {
      result.fragments.push_back(std::move(piece.mesh));
    }
  }
  result.ok = !result.fragments.empty();
  if (!result.ok) result.reason = "nothing of the body is left";
}

}  // namespace

CutResult cut(const CutBody& body, const SurfaceMesh& slab, const CutOptions& options) {
  CutResult result;
  if (result.reason = body.defect(); !result.reason.empty()) return result;
  if (result.reason = check_numbers(slab, "the slab"); !result.reason.empty()) return result;
  const SurfaceMesh full_slab = with_attributes(slab);
  if (!(signed_volume(slab) > 0)) {
    result.reason = "the slab has no positive volume";
    return result;
  }
  const Real amplitude = kJitter * (options.edge_length > 0 ? options.edge_length : mean_edge_length(body.mesh()));
  Random seeds(options.seed);
  for (int jitters = 0;; ++jitters) {
    bool again = false;
    const SurfaceMesh moved = jitters == 0 ? full_slab : jittered(full_slab, amplitude, seeds.next());
    const Difference difference = attempt(body.operand(), moved, jitters == 0, options.slab_checked, again);
    result.jitters = jitters;
    if (difference.ok) {
      collect(difference, options, result);
      return result;
    }
    result.reason = difference.reason;
    if (again && jitters == kMaxJitters) result.reason += fmt::format(" (after {} jitters of the slab)", jitters);
    if (!again || jitters == kMaxJitters) return result;
  }
}

CutResult cut(const SurfaceMesh& body, const SurfaceMesh& slab, const CutOptions& options) {
  return cut(CutBody(body), slab, options);
}

}  // namespace sherd
