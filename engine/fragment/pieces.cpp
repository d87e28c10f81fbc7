#include "engine/fragment/pieces.h"

#include <algorithm>

#include "engine/mesh/bvh.h"

namespace sherd {
namespace {

SurfaceMesh extract(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& faces, std::vector<std::uint32_t>& to) {
  std::vector<std::uint32_t> used;
  used.reserve(3 * faces.size());
  for (std::uint32_t f : faces) used.insert(used.end(), mesh.triangles[f].begin(), mesh.triangles[f].end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  SurfaceMesh part;
  part.vertices.reserve(used.size());
  for (std::uint32_t i = 0; i < used.size(); ++i) to[used[i]] = i, part.vertices.push_back(mesh.vertices[used[i]]);
  part.triangles.reserve(faces.size());
  for (std::uint32_t f : faces) {
    const Triangle& t = mesh.triangles[f];
    part.triangles.push_back({to[t[0]], to[t[1]], to[t[2]]});
    part.faces.push_back_from(mesh.faces, f);
  }
  return part;
}

}  // namespace

std::vector<Piece> split_pieces(const SurfaceMesh& mesh) {
  std::vector<std::uint32_t> label, to(mesh.vertex_count());
  const std::uint32_t count = label_components(mesh, label);
  std::vector<std::vector<std::uint32_t>> shell(count);
  for (std::uint32_t f = 0; f < label.size(); ++f) shell[label[f]].push_back(f);

  std::vector<SurfaceMesh> shells(count);
  std::vector<Real> volume(count);
  std::vector<std::uint32_t> solids, cavities;
  for (std::uint32_t c = 0; c < count; ++c) {
    shells[c] = extract(mesh, shell[c], to);
    volume[c] = signed_volume(shells[c]);
    (volume[c] > 0 ? solids : cavities).push_back(c);
  }
  std::stable_sort(solids.begin(), solids.end(), [&](auto a, auto b) { return volume[a] > volume[b]; });
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
  std::vector<Piece> pieces;
  for (std::uint32_t s : solids) {
    Piece piece{std::move(shells[s]), volume[s]};
    if (!owned[s].empty()) {
      std::vector<std::uint32_t> faces = shell[s];
      for (std::uint32_t c : owned[s]) {
        faces.insert(faces.end(), shell[c].begin(), shell[c].end());
        piece.volume += volume[c];
      }
      std::sort(faces.begin(), faces.end());
      piece.mesh = extract(mesh, faces, to);
    }
    pieces.push_back(std::move(piece));
  }
  std::stable_sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.volume > b.volume; });
  return pieces;
}

}  // namespace sherd
