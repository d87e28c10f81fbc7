#include "engine/step/run_state.h"

#include <algorithm>
#include <array>

namespace sherd {

void describe(Archive& a, std::shared_ptr<Solid>& solid) {
  a.shared(solid, [&](std::shared_ptr<Solid>& s) {
    std::shared_ptr<const SurfaceMesh> mesh = s ? s->shared_mesh() : nullptr;
    RootScale root = s ? s->root() : RootScale{};
    Real edge_length = s ? s->edge_length() : 0;
    archive(a, mesh), archive(a, root), archive(a, edge_length);
    if (!s) {
      if (!mesh) throw ArchiveError("a body has no mesh");
      s = std::make_shared<Solid>(std::move(mesh), root, edge_length);
    }
    s->learn();
    archive(a, static_cast<SolidState&>(*s));
  });
}

void describe(Archive& a, const ResolutionRule*& rule) {
  static constexpr std::array kRules{&kCubicTestedRule, &kCubicCollocationRule, &kLinearCollocationRule};
  auto place = static_cast<std::uint8_t>(std::find(kRules.begin(), kRules.end(), rule) - kRules.begin());
  a.raw(&place, 1);
  if (place > kRules.size()) throw ArchiveError("there is no such rule");
  rule = place < kRules.size() ? kRules[place] : nullptr;
}

std::uint64_t digest(const SurfaceMesh& mesh, std::uint64_t start) {
  Archive bytes;
  SurfaceMesh copy = mesh;
  archive(bytes, copy);
  return digest(bytes.take(), start);
}

}  // namespace sherd
