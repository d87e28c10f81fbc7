#include <algorithm>

#include "engine/fragment/components.h"
#include "engine/mesh/attributes.h"

namespace sherd {
namespace {

// Faces first .. last - 1 of the body. Most of a large body comes as few long runs, copied as they are.
struct Run {
  std::uint32_t first, last;
};

// Of the faces with keep[f].
std::vector<Run> runs_of(const std::vector<char>& keep) {
  std::vector<Run> runs;
  for (std::uint32_t f = 0; f < keep.size(); ++f) {
    if (!keep[f]) continue;
    if (!runs.empty() && runs.back().last == f) {
      ++runs.back().last;
    } else {
      runs.push_back({f, f + 1});
    }
  }
  return runs;
}

// Whole body faces of a solid that has only what the walk came over, ascending.
std::vector<Run> walked_faces(const Components& components, const CutSolid& solid) {
  std::vector<std::uint32_t> faces;
  for (const std::uint32_t s : solid.shells)
    faces.insert(faces.end(), components.shells[s].whole.begin(), components.shells[s].whole.end());
  std::sort(faces.begin(), faces.end());
  std::vector<Run> runs;
  for (const std::uint32_t f : faces) runs.push_back({f, f + 1});
  return runs;
}

// Of a solid that has rests of the body's shells.
std::vector<Run> rest_faces(const Carving& carving, const Components& components, const CutSolid& solid) {
  const CutBody& body = carving.body();
  std::vector<char> has_rest(body.shells().size(), 0);
  for (const std::uint32_t s : solid.shells)
    for (const std::uint32_t r : components.shells[s].rest) has_rest[r] = 1;
  std::vector<char> keep(body.mesh().triangle_count(), 1);
  if (has_rest.size() > 1)
    for (std::uint32_t f = 0; f < keep.size(); ++f) keep[f] = has_rest[body.shell_of(f)];
  for (const auto* list : {&carving.cut, &carving.dropped})
    for (const std::uint32_t f : *list) keep[f] = 0;
  for (const CutShell& shell : components.shells)
    for (const std::uint32_t f : shell.whole) keep[f] = 0;
  for (const std::uint32_t s : solid.shells)
    for (const std::uint32_t f : components.shells[s].whole) keep[f] = 1;
  return runs_of(keep);
}

// Renumbers to the used vertices, in order.
void take_vertices(const Carving& carving, std::uint32_t vertices, SurfaceMesh& mesh) {
  constexpr std::size_t kSmall = 16;  // times fewer triangles than vertices: sorting is cheaper than a column of all
  if (kSmall * mesh.triangle_count() < vertices) {
    std::vector<std::uint32_t> used;
    for (const Triangle& t : mesh.triangles) used.insert(used.end(), t.begin(), t.end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    SparseMap place;
    for (std::uint32_t i = 0; i < used.size(); ++i)
      place.insert(used[i], i), mesh.vertices.push_back(carving.position(used[i]));
    for (Triangle& t : mesh.triangles) t = {place[t[0]], place[t[1]], place[t[2]]};
    return;
  }
  std::vector<char> used(vertices, 0);
  for (const Triangle& t : mesh.triangles) used[t[0]] = used[t[1]] = used[t[2]] = 1;
  std::vector<std::uint32_t> place(vertices);
  std::uint32_t count = 0;
  for (std::uint32_t v = 0; v < vertices; ++v) place[v] = count, count += static_cast<std::uint32_t>(used[v]);
  mesh.vertices.resize(count);
  for (std::uint32_t v = 0; v < vertices; ++v)
    if (used[v]) mesh.vertices.set(place[v], carving.position(v));
  for (Triangle& t : mesh.triangles) t = {place[t[0]], place[t[1]], place[t[2]]};
}

}  // namespace

SurfaceMesh extract_solid(const Carving& carving, const Components& components, const CutSolid& solid) {
  std::vector<std::uint32_t> parts;
  bool rests = false;
  for (const std::uint32_t s : solid.shells) {
    const CutShell& shell = components.shells[s];
    parts.insert(parts.end(), shell.parts.begin(), shell.parts.end());
    rests = rests || !shell.rest.empty();
  }
  std::sort(parts.begin(), parts.end());
  const SurfaceMesh &body = carving.body().mesh(), &slab = carving.slab().mesh;
  SurfaceMesh mesh;
  match_channels(body, mesh);
  mesh.triangles.reserve(solid.faces);
  std::size_t next = 0;
  const auto add_part = [&] {
    const std::uint32_t i = parts[next++];
    const NewFace& f = carving.faces[i];
    const SurfaceMesh& from = f.of_slab ? slab : body;
    mesh.triangles.push_back(f.vertices);
    mesh.faces.push_back_from(from.faces, f.parent);
    interpolate_corners(from, f.parent, carving.corners(carving.body_faces() + i), mesh);
  };
  for (const Run& run : rests ? rest_faces(carving, components, solid) : walked_faces(components, solid)) {
    while (next < parts.size() && !carving.faces[parts[next]].of_slab && carving.faces[parts[next]].parent < run.first)
      add_part();
    append_faces(body, run.first, run.last, mesh);
  }
  while (next < parts.size()) add_part();
  take_vertices(carving, carving.vertex_count(), mesh);
  return mesh;
}

}  // namespace sherd
