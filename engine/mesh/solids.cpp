#include "engine/mesh/solids.h"

#include <algorithm>

#include "engine/mesh/attributes.h"
#include "engine/mesh/bvh.h"

namespace sherd {

SurfaceMesh extract_faces(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& faces) {
  std::vector<std::uint32_t> used;
  used.reserve(3 * faces.size());
  for (std::uint32_t f : faces) used.insert(used.end(), mesh.triangles[f].begin(), mesh.triangles[f].end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  const auto place = [&](std::uint32_t v) {
    return static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), v) - used.begin());
  };
  SurfaceMesh part;
  part.vertices.reserve(used.size());
  for (std::uint32_t v : used) part.vertices.push_back(mesh.vertices[v]);
  part.triangles.reserve(faces.size());
  match_channels(mesh, part);
  for (std::uint32_t f : faces) {
    const Triangle& t = mesh.triangles[f];
    append_face(mesh, f, {place(t[0]), place(t[1]), place(t[2])}, part);
  }
  return part;
}

std::vector<SolidFaces> group_shells(const SurfaceMesh& mesh) {
  std::vector<std::uint32_t> label;
  const std::uint32_t count = label_components(mesh, label);
  std::vector<SolidFaces> shell(count);
  for (std::uint32_t f = 0; f < label.size(); ++f) shell[label[f]].faces.push_back(f);

  std::vector<SurfaceMesh> shells(count);
  std::vector<std::uint32_t> solids, cavities;
  for (std::uint32_t c = 0; c < count; ++c) {
    shells[c] = extract_faces(mesh, shell[c].faces);
    shell[c].volume = signed_volume(shells[c]);
    (shell[c].volume > 0 ? solids : cavities).push_back(c);
  }
  const auto larger = [](const SolidFaces& a, const SolidFaces& b) { return a.volume > b.volume; };
  std::stable_sort(solids.begin(), solids.end(), [&](auto a, auto b) { return larger(shell[a], shell[b]); });
  std::vector<std::vector<std::uint32_t>> owned(count);
  if (!cavities.empty() && !solids.empty()) {
    // From the smallest solid on, so that the first that contains the cavity is the innermost.
    std::vector<std::uint32_t> owner(count, solids[0]);
    std::vector<char> found(count, 0);
    for (std::size_t i = solids.size(); i-- > 1;) {
      const TriangleBvh bvh(shells[solids[i]]);
      for (std::uint32_t c : cavities)
        if (!found[c] && bvh.inside(shells[c].vertices[0])) owner[c] = solids[i], found[c] = 1;
    }
    for (std::uint32_t c : cavities) owned[owner[c]].push_back(c);
  }
  std::vector<SolidFaces> result;
  for (std::uint32_t s : solids) {
    SolidFaces solid = std::move(shell[s]);
    for (std::uint32_t c : owned[s]) {
      solid.faces.insert(solid.faces.end(), shell[c].faces.begin(), shell[c].faces.end());
      solid.volume += shell[c].volume;
    }
    std::sort(solid.faces.begin(), solid.faces.end());
    result.push_back(std::move(solid));
  }
  std::stable_sort(result.begin(), result.end(), larger);
  return result;
}

}  // namespace sherd
