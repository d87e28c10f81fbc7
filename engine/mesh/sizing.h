// Thickness-aware grading: target edge lengths at most a given multiple of the wall thickness, growing slowly away from
// thin walls, and remeshing to them.
#pragma once
#include "engine/mesh/remesh.h"
#include "engine/mesh/thickness.h"

namespace sherd {

struct SizingOptions {
  Real edge_length = 0;         // target where walls ask for nothing finer, metres
  Real edge_per_thickness = 0;  // edges at most this many times the wall thickness; 0: edge_length everywhere
  Real growth = 0.3;            // a target grows by at most this much per metre of way along the surface
  Real finest = 0.125;          // no target below this part of edge_length
  Real merge = 0.02;            // of RemeshOptions
};

// Target length at each vertex of `mesh`, metres: min(edge_length, edge_per_thickness * thickness), not below the
// finest one, its growth bounded along the mesh's edges. `thickness` has one entry a vertex. Throws InputError for
// options out of range.
std::vector<Real> sizing_field(const SurfaceMesh& mesh, const std::vector<Real>& thickness,
                               const SizingOptions& options);

// About how many triangles remesh() makes for such target lengths, one a vertex: the integral of dA / (sqrt(3) / 4
// h^2), and one for each face between vertices that `locked` (empty, or one entry a vertex) names.
Real expected_triangles(const SurfaceMesh& mesh, const std::vector<Real>& size,
                        const std::vector<std::uint8_t>& locked = {});

// The smallest target of the mesh's own wall thickness, metres; edge_length when off or where nothing asks for less.
Real finest_target(const SurfaceMesh& mesh, const SizingOptions& options);

// The same polyhedron with no edge longer than `longest` (metres), by halving edges; attributes are inherited. Meshes
// that are not closed and manifold, or would get more than two million triangles, come back as they are.
SurfaceMesh with_edges_halved(const SurfaceMesh& mesh, Real longest);

// remesh() to sizing_field() of the mesh's own wall thickness, sampled at points no farther apart than edge_length. As
// remesh() to edge_length when edge_per_thickness is 0.
RemeshReport remesh_graded(const SurfaceMesh& in, const SizingOptions& options, SurfaceMesh& out);

}  // namespace sherd
