// The remesher's working mesh: a closed 2-manifold as a corner table. Half-edge h = 3 t + k runs from corner k to
// corner k+1 of triangle t. Deleted triangles and vertices leave holes; extract() closes them.
#pragma once
#include <vector>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

struct EditMesh {
  std::vector<Vec3> position;
  std::vector<Triangle> triangle;   // {kNone, ..} when deleted
  std::vector<std::uint32_t> twin;  // per half-edge
  std::vector<std::uint32_t> line;  // per half-edge: feature line it lies on, kNone elsewhere; equal on both twins
  std::vector<std::uint32_t> out;   // per vertex: some half-edge leaving it, kNone when deleted
  FaceAttributes faces;
  std::vector<std::uint32_t> region;  // per triangle: feature lines run between regions

  // False when the mesh is not closed, 2-manifold and consistently oriented; the reason is then set.
  bool assign(const SurfaceMesh& mesh, const char*& reason);
  // Without channels and ghosts. The lists, when given, receive the working mesh's number of each face and vertex.
  SurfaceMesh extract(std::vector<std::uint32_t>* faces_of = nullptr,
                      std::vector<std::uint32_t>* vertices_of = nullptr) const;

  static std::uint32_t next(std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static std::uint32_t prev(std::uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }
  std::uint32_t from(std::uint32_t h) const { return triangle[h / 3][h % 3]; }
  std::uint32_t to(std::uint32_t h) const { return from(next(h)); }
  std::uint32_t tip(std::uint32_t h) const { return from(prev(h)); }
  // Triangles first_ghost to end_ghost only close the borders of a part of a larger mesh (engine/mesh/remesh_part.h).
  std::uint32_t first_ghost = 0, end_ghost = 0;
  bool ghost(std::uint32_t t) const { return t >= first_ghost && t < end_ghost; }
  bool alive(std::uint32_t t) const { return triangle[t][0] != kNone; }
  // Next half-edge leaving from(h), counter-clockwise seen from outside.
  std::uint32_t turn(std::uint32_t h) const { return twin[prev(h)]; }
  template <class F>
  void for_out(std::uint32_t v, const F& visit) const {
    std::uint32_t h = out[v];
    do {
      visit(h);
      h = turn(h);
    } while (h != out[v]);
  }
  std::size_t valence(std::uint32_t v) const;
  bool adjacent(std::uint32_t a, std::uint32_t b) const;
  std::array<Vec3, 3> corners(std::uint32_t t) const {
    return {position[triangle[t][0]], position[triangle[t][1]], position[triangle[t][2]]};
  }
  Real edge_length(std::uint32_t h) const { return distance(position[from(h)], position[to(h)]); }

  // New vertex at p in the middle of the edge; its two new triangles are the last ones. Returns the vertex.
  std::uint32_t split(std::uint32_t h, const Vec3& p);
  bool can_collapse(std::uint32_t h) const;  // link condition: the surface stays a manifold
  void collapse(std::uint32_t h);            // from(h) disappears into to(h)
  bool can_flip(std::uint32_t h) const;
  void flip(std::uint32_t h);
};

}  // namespace sherd
