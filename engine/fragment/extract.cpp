#include <algorithm>
#include <numeric>

#include "engine/fragment/components.h"
#include "engine/mesh/attributes.h"

namespace sherd {
namespace {

// Faces first .. last - 1 of the body. Most of a large body comes as few long runs, copied as they are.
struct Run {
  std::uint32_t first, last;
};

// Whole body faces of a solid that has only what the walk came over.
std::vector<Run> walked_faces(const Components& components, const CutSolid& solid) {
  std::vector<std::uint32_t> faces;
  for (const std::uint32_t s : solid.shells)
    faces.insert(faces.end(), components.shells[s].whole.begin(), components.shells[s].whole.end());
  std::sort(faces.begin(), faces.end());
  std::vector<Run> runs;
  for (const std::uint32_t f : faces) runs.push_back({f, f + 1});
  return runs;
}

// Body faces that a solid with rests of the body's shells does not have as a whole, ascending.
std::vector<std::uint32_t> faces_left_out(const Carving& carving, const Components& components, const CutSolid& solid) {
  const CutBody& body = carving.body();
  std::vector<char> has_rest(body.shells().size(), 0);
  for (const std::uint32_t s : solid.shells)
    for (const std::uint32_t r : components.shells[s].rest) has_rest[r] = 1;
  std::vector<std::uint32_t> out = carving.cut;
  out.insert(out.end(), carving.dropped.begin(), carving.dropped.end());
  SparseMap own;
  for (const std::uint32_t s : solid.shells)
    for (const std::uint32_t f : components.shells[s].whole) own.insert(f, 1);
  for (const CutShell& shell : components.shells)
    for (const std::uint32_t f : shell.whole)
      if (!own.contains(f)) out.push_back(f);
  if (std::count(has_rest.begin(), has_rest.end(), 0) > 0)
    for (std::uint32_t f = 0; f < body.mesh().triangle_count(); ++f)
      if (!has_rest[body.shell_of(f)] && !own.contains(f)) out.push_back(f);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::vector<Run> runs_between(const std::vector<std::uint32_t>& left_out, std::uint32_t count) {
  std::vector<Run> runs;
  std::uint32_t first = 0;
  for (const std::uint32_t f : left_out) {
    if (first < f) runs.push_back({first, f});
    first = f + 1;
  }
  if (first < count) runs.push_back({first, count});
  return runs;
}

// Renumbers to the used vertices, in order.
void take_used_vertices(const Carving& carving, SurfaceMesh& mesh) {
  std::vector<std::uint32_t> used;
  SparseMap place;
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t)
      if (place.insert(v, 0)) used.push_back(v);
  std::sort(used.begin(), used.end());
  for (std::uint32_t i = 0; i < used.size(); ++i)
    place.set(used[i], i), mesh.vertices.push_back(carving.position(used[i]));
  for (Triangle& t : mesh.triangles) t = {place[t[0]], place[t[1]], place[t[2]]};
}

// The same for a mesh of nearly the whole body: looks only at the corners of the faces left out for vertices that go.
void take_most_vertices(const Carving& carving, const std::vector<std::uint32_t>& left_out,
                        const std::vector<std::uint32_t>& parts, SurfaceMesh& mesh) {
  const CutBody& body = carving.body();
  SparseMap out, used;
  for (const std::uint32_t f : left_out) out.insert(f, 1);
  std::vector<std::uint32_t> fresh, gone;  // of the slab and crossings; of the body
  for (const std::uint32_t i : parts)
    for (const std::uint32_t v : carving.faces[i].vertices)
      if (used.insert(v, 1) && v >= carving.body_vertices()) fresh.push_back(v);
  std::sort(fresh.begin(), fresh.end());
  for (const std::uint32_t f : left_out)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t v = body.mesh().triangles[f][k];
      if (!used.insert(v, 1)) continue;
      bool stays = false;
      std::uint32_t e = 3 * f + k;
      do {
        stays = !out.contains(e / 3);
        e = body.twins()[e % 3 == 0 ? e + 2 : e - 1];
      } while (!stays && e != 3 * f + k);
      if (!stays) gone.push_back(v);
    }
  std::sort(gone.begin(), gone.end());
  std::vector<std::uint32_t> place(carving.vertex_count());
  const Vec3Column& from = body.mesh().vertices;
  Vec3Column& to = mesh.vertices;
  to.reserve(from.size() - gone.size() + fresh.size());
  std::uint32_t first = 0, shift = 0;
  const auto copy_until = [&](std::uint32_t last) {
    const auto append = [&](const std::vector<Real>& a, std::vector<Real>& b) {
      b.insert(b.end(), a.begin() + first, a.begin() + last);
    };
    append(from.x, to.x), append(from.y, to.y), append(from.z, to.z);
    std::iota(place.begin() + first, place.begin() + last, first - shift);
    first = last + 1, ++shift;
  };
  for (const std::uint32_t v : gone) copy_until(v);
  copy_until(carving.body_vertices());
  for (const std::uint32_t v : fresh)
    place[v] = static_cast<std::uint32_t>(to.size()), to.push_back(carving.position(v));
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
  mesh.triangles.reserve(solid.faces), mesh.faces.reserve(solid.faces);
  for (CornerChannel& c : mesh.channels) c.value.reserve(c.width() * solid.faces);
  std::size_t next = 0;
  const auto add_part = [&] {
    const std::uint32_t i = parts[next++];
    const NewFace& f = carving.faces[i];
    const SurfaceMesh& from = f.of_slab ? slab : body;
    mesh.triangles.push_back(f.vertices);
    mesh.faces.push_back_from(from.faces, f.parent);
    interpolate_corners(from, f.parent, carving.corners(carving.body_faces() + i), mesh);
  };
  std::vector<std::uint32_t> left_out;
  if (rests) left_out = faces_left_out(carving, components, solid);
  for (const Run& run : rests ? runs_between(left_out, carving.body_faces()) : walked_faces(components, solid)) {
    while (next < parts.size() && !carving.faces[parts[next]].of_slab && carving.faces[parts[next]].parent < run.first)
      add_part();
    append_faces(body, run.first, run.last, mesh);
  }
  while (next < parts.size()) add_part();
  if (rests) {
    take_most_vertices(carving, left_out, parts, mesh);
  } else {
    take_used_vertices(carving, mesh);
  }
  return mesh;
}

}  // namespace sherd
