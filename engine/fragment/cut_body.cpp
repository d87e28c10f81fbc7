#include "engine/fragment/cut_body.h"

#include <algorithm>

#include "engine/fragment/cut_checks.h"

namespace sherd {
namespace {

// The columns of attributes are complete whatever the caller left out.
SurfaceMesh with_attributes(SurfaceMesh mesh) {
  mesh.faces.resize(mesh.triangle_count());
  return mesh;
}

std::int64_t euler_of(const SurfaceMesh& mesh) {
  std::vector<char> used(mesh.vertex_count(), 0);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) used[v] = 1;
  return std::count(used.begin(), used.end(), 1) - static_cast<std::int64_t>(mesh.triangle_count() / 2);
}

}  // namespace

CutBody::CutBody(SurfaceMesh mesh) : CutBody(std::move(mesh), check_numbers(mesh, "the body")) {}

// Indices out of range must not reach the trees.
CutBody::CutBody(SurfaceMesh&& mesh, std::string defect)
    : defect_(std::move(defect)), operand_(defect_.empty() ? with_attributes(std::move(mesh)) : SurfaceMesh{}) {
  if (!defect_.empty()) return;
  if (const std::string text = check_manifold(operand_.mesh, operand_.twin); !text.empty()) {
    defect_ = "the body is not a closed manifold: " + text;
    return;
  }
  volume_ = signed_volume(operand_.mesh);
  if (!(volume_ > 0)) defect_ = "the body has no positive volume";
  euler_ = euler_of(operand_.mesh);
}

}  // namespace sherd
