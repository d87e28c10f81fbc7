#include "engine/fragment/cut.h"

#include <fmt/format.h>

#include "engine/fragment/cleanup.h"
#include "engine/fragment/components.h"
#include "engine/fragment/cut_checks.h"
#include "engine/fragment/difference.h"
#include "engine/mesh/attributes.h"
#include "engine/mesh/intersections.h"
#include "kernels/core/fault.h"
#include "kernels/core/random.h"

namespace sherd {
namespace {

constexpr int kMaxJitters = 8;
constexpr Real kJitter = 1e-7;      // of h
constexpr Real kLeastArea = 1e-12;  // of h^2, the design's B4

// Moves the slab's vertices to random places around their own.
void jitter(const SurfaceMesh& slab, Real amplitude, std::uint64_t seed, SurfaceMesh& moved) {
  Random random(seed);
  for (std::size_t i = 0; i < moved.vertex_count(); ++i) {
    const Real x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    moved.vertices.set(i, slab.vertices[i] + amplitude * Vec3{x, y, z});
  }
}

// One try with the slab as it is.
class Attempt {
 public:
  Attempt(const CutBody& body, const CutOperand& slab, Real edge_length, bool complete)
      : piercing_(pierce(body.operand(), slab)),
        carving_(body, slab, piercing_),
        edge_length_(edge_length),
        complete_(complete) {}

  // Empty, or why another jitter has to be tried.
  std::string run() {
    if (piercing_.status != PierceStatus::kOk) return piercing_.reason;
    if (std::string text = subtract(piercing_, carving_); !text.empty()) return text;
    fault_point("cut.check");
    if (std::string text = check_balance(carving_); !text.empty()) return text;
    if (std::string text = check_links(carving_); !text.empty()) return text;
    std::vector<std::uint32_t> parts;
    for (std::uint32_t i = 0; i < carving_.faces.size(); ++i)
      if (!carving_.faces[i].whole) parts.push_back(i);
    const Real least_area = kLeastArea * edge_length_ * edge_length_;
    if (BadFaces bad = find_bad_faces(carving_, parts, least_area); !bad.faces.empty()) {
      fault_point("cut.clean");
      std::string reason = bad.reason;
      if (!clean_up(carving_, std::move(bad), edge_length_, least_area, cleanups_)) return reason;
      if (reason = check_balance(carving_); !reason.empty()) return reason;
      if (reason = check_links(carving_); !reason.empty()) return reason;
    }
    fault_point("cut.components");
    components_ = find_components(carving_);
    if (!components_.reason.empty()) return components_.reason;
    // The design's V2: without handles no loop in the solid passes a complete sheet only once.
    const bool handles = carving_.body().euler() < 2 * static_cast<std::int64_t>(carving_.body().shells().size());
    if (complete_ && !handles && !piercing_.segments.empty() && components_.solids.size() < 2)
      return "a complete crack leaves a body without handles in one piece";
    return {};
  }

  void collect(const CutOptions& options, CutResult& result) const {
    result.removed_volume = carving_.removed_volume;
    result.separated = components_.solids.size() > 1;
    result.euler = components_.euler, result.cleanups = cleanups_;
    for (const NewFace& f : carving_.faces) result.touched += f.alive && !f.whole;
    for (const CutSolid& solid : components_.solids) {
      if (options.dust == DustRule::kDrop && solid.volume < options.min_fragment_volume * carving_.body().volume()) {
        result.dust_volume += solid.volume;
        continue;
      }
      fault_point("cut.extract");
      result.fragments.push_back(extract_solid(carving_, components_, solid));
    }
    result.ok = !result.fragments.empty();
    if (!result.ok) result.reason = "nothing of the body is left";
  }

 private:
  Piercing piercing_;
  Carving carving_;
  Real edge_length_;
  bool complete_;
  Components components_;
  int cleanups_ = 0;
};

// Empty, or why the slab cannot be cut out of anything.
std::string refuse_slab(const SurfaceMesh& slab, const std::vector<std::uint32_t>& twin, const CutOptions& options) {
  if (!(signed_volume(slab) > 0)) return "the slab has no positive volume";
  if (options.slab_checked) return {};
  if (const std::string text = check_manifold(slab, twin); !text.empty())
    return "the slab is not a closed manifold: " + text;
  if (count_self_intersections(slab, 1) > 0) return "the slab intersects itself";
  return {};
}

}  // namespace

CutResult cut(const CutBody& body, const SurfaceMesh& slab, const CutOptions& options) {
  CutResult result;
  if (result.reason = body.defect(); !result.reason.empty()) return result;
  if (result.reason = check_numbers(slab, "the slab"); !result.reason.empty()) return result;
  fault_point("cut.begin");
  SurfaceMesh moved = slab;
  moved.faces.resize(slab.triangle_count());
  match_channels(body.mesh(), moved);
  const std::vector<std::uint32_t> twin = build_twins(slab);
  if (result.reason = refuse_slab(slab, twin, options); !result.reason.empty()) return result;
  const Real edge_length = options.edge_length > 0 ? options.edge_length : mean_edge_length(body.mesh());
  Random seeds(options.seed);
  for (;; ++result.jitters) {
    const CutOperand operand(moved, twin);
    // A jitter that folds the slab over is only an unlucky draw.
    if (result.jitters > 0 && count_self_intersections(moved, 1) > 0) {
      result.reason = "the slab intersects itself";
    } else {
      Attempt attempt(body, operand, edge_length, options.complete);
      result.reason = attempt.run();
      if (result.reason.empty()) {
        attempt.collect(options, result);
        return result;
      }
    }
    if (result.jitters == kMaxJitters) {
      result.reason += fmt::format(" (after {} jitters of the slab)", kMaxJitters);
      return result;
    }
    jitter(slab, kJitter * edge_length, seeds.next(), moved);
  }
}

CutResult cut(const SurfaceMesh& body, const SurfaceMesh& slab, const CutOptions& options) {
  return cut(CutBody(body), slab, options);
}

bool does_nothing(const CutBody& body, const CutResult& c, std::int32_t crack) {
  constexpr Real kOneSided = 0.5;  // of the larger wall's area
  if (c.separated || c.euler > body.euler()) return false;
  if (body.euler() == 2 * std::ssize(body.shells())) return true;
  Real plus = 0, minus = 0;
  for (const SurfaceMesh& f : c.fragments)
    for (std::size_t t = 0; t < f.triangle_count(); ++t)
      if (f.faces.kind[t] == FaceKind::kCrack && f.faces.crack[t] == crack && f.faces.side[t] != 0)
        (f.faces.side[t] > 0 ? plus : minus) += norm(f.area_normal2(t));
  return !(std::min(plus, minus) > kOneSided * std::max(plus, minus));
}

}  // namespace sherd
