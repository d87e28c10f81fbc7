#include "engine/fragment/cut_body.h"

#include <algorithm>

#include "engine/fragment/cut_checks.h"
#include "engine/mesh/attributes.h"

namespace sherd {
namespace {

// Keeps the order of the others.
void drop_unused_vertices(SurfaceMesh& mesh) {
  std::vector<std::uint32_t> place(mesh.vertex_count(), 0);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) place[v] = 1;
  if (std::count(place.begin(), place.end(), 0u) == 0) return;
  std::uint32_t count = 0;
  for (std::uint32_t v = 0; v < place.size(); ++v) {
    if (place[v] == 0) continue;
    mesh.vertices.set(count, mesh.vertices[v]);
    place[v] = count++;
  }
  mesh.vertices.resize(count);
  for (Triangle& t : mesh.triangles) t = {place[t[0]], place[t[1]], place[t[2]]};
}

// The columns of attributes are complete whatever the caller left out.
SurfaceMesh tidied(SurfaceMesh mesh) {
  mesh.faces.resize(mesh.triangle_count());
  drop_unused_vertices(mesh);
  return mesh;
}

}  // namespace

CutBody::CutBody(SurfaceMesh mesh) : CutBody(std::move(mesh), check_numbers(mesh, "the body")) {}

// Indices out of range must not reach the trees.
CutBody::CutBody(SurfaceMesh&& mesh, std::string defect)
    : defect_(std::move(defect)), operand_(defect_.empty() ? tidied(std::move(mesh)) : SurfaceMesh{}) {
  if (!defect_.empty()) return;
  if (defect_ = check_attributes(operand_.mesh); !defect_.empty()) return;
  if (const std::string text = check_manifold(operand_.mesh, operand_.twin); !text.empty()) {
    defect_ = "the body is not a closed manifold: " + text;
    return;
  }
  label_shells();
  for (const BodyShell& s : shells_) volume_ += s.volume;
  if (!(volume_ > 0)) defect_ = "the body has no positive volume";
  const SurfaceMesh& own = operand_.mesh;
  euler_ = static_cast<std::int64_t>(own.vertex_count()) - static_cast<std::int64_t>(own.triangle_count() / 2);
}

void CutBody::label_shells() {
  const auto n = static_cast<std::uint32_t>(operand_.mesh.triangle_count());
  const Vec3 origin = operand_.bvh.box().centre();
  shell_.assign(n, kNone);
  std::vector<std::uint32_t> stack;
  for (std::uint32_t first = 0; first < n; ++first) {
    if (shell_[first] != kNone) continue;
    const auto label = static_cast<std::uint32_t>(shells_.size());
    BodyShell shell;
    shell.face = first;
    shell_[first] = label, stack.assign(1, first);
    while (!stack.empty()) {
      const std::uint32_t f = stack.back();
      stack.pop_back();
      ++shell.faces, shell.volume += corner_volume6(operand_.corners(f), origin) / 6;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t g = operand_.twin[3 * f + k] / 3;
        if (shell_[g] == kNone) shell_[g] = label, stack.push_back(g);
      }
    }
    shells_.push_back(shell);
  }
}

}  // namespace sherd
