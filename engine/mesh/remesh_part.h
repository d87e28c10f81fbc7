// The part of a mesh that a remesher with locked vertices can change, as a closed mesh of its own, so that the cost is
// that of the part.
#pragma once
#include <optional>

#include "engine/mesh/remesh.h"

namespace sherd {

// Faces with an unlocked vertex, those around them, and all others near enough to meet a changed face. Where the rest
// of the surface is missing, each border loop is closed by a fan of ghost triangles around an apex: they keep the part
// a closed manifold, are locked, and are no surface otherwise.
struct MeshPart {
  SurfaceMesh mesh;                      // ghosts last
  std::size_t faces = 0;                 // without ghosts
  std::vector<std::uint32_t> vertex_of;  // vertex of the whole for each one; kNone for apexes
  std::vector<std::uint8_t> in_part;     // per face of the whole
  RemeshOptions options;                 // locks and target lengths of the part
};

// Nothing when the part would be most of the mesh or none of it, or is open. `options.locked` has one entry a vertex.
std::optional<MeshPart> cut_out_part(const SurfaceMesh& mesh, const RemeshOptions& options);

// A remeshed part, without ghosts.
struct RemeshedPart {
  SurfaceMesh mesh;
  std::vector<std::uint32_t> vertex_of;  // vertex of the part each one was; kNone for new ones
};

// The whole with its part replaced: faces outside first, bit for bit as they were, then the part's; old vertices in
// their order, then new ones. `first_new` receives the number of faces outside.
SurfaceMesh put_back(const SurfaceMesh& mesh, const MeshPart& part, const RemeshedPart& remeshed,
                     std::size_t& first_new);

}  // namespace sherd
