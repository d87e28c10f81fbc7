// Isotropic, feature-preserving remeshing to one edge length, or to a graded one: split long edges, collapse short
// ones, flip, smooth tangentially, and stay on the input surface (Botsch & Kobbelt 2004; the paper's local remeshing
// rules on the body).
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

struct RemeshOptions {
  Real edge_length = 0;     // target h, metres; edges come out between about 0.8 h and 1.33 h
  Real feature_angle = 40;  // degrees: edges whose normals differ by more are creases
  int iterations = 5;       // >= 0; 0 only repairs slivers
  // Of the target length: where features (fixed vertices, different lines) closer than this force faces below 20
  // degrees, they are merged, as long as no thin sheet is pinched and faces stay within it of the input. At most 0.5.
  Real merge = 0.02;
  // Degrees: faces with a smaller angle are merged away even where that pinches a thin sheet. A wall that tapers to a
  // narrow rim has nothing else to give: its two lines meet there then, and it ends in an edge instead.
  Real pinch_below = 0;
  // Vertices leave the input surface by a part of the facets' own error, so that new facets cut no volume off curved
  // places, and walls and curved places give what features have cost. Without, vertices lie on the input surface.
  bool keep_volume = false;
  // Borders of texture charts (jumps of corner channels) are feature lines, but for charts smaller than 8 h^2.
  bool keep_seams = true;
  // Empty, or the target at each vertex of the input, metres, positive (linear in between; engine/mesh/sizing.h makes
  // it). `edge_length` is then what features are judged by, and the unit of the report's deviations.
  std::vector<Real> size = {};
  std::vector<std::uint8_t> locked = {};  // empty, or one entry a vertex: nonzero vertices keep their place, and edges
                                          // and faces between locked vertices stay as they are
};

enum class RemeshStatus { kOk, kRefused };

struct RemeshReport {
  RemeshStatus status = RemeshStatus::kRefused;
  std::string reason;  // of a refusal; `out` is then the input
  std::size_t splits = 0, collapses = 0, flips = 0, moves = 0;
  std::size_t blocked = 0;                // operations rejected because faces would have intersected
  Real min_angle = 0;                     // of all output faces, degrees
  std::size_t below_15 = 0, below_1 = 0;  // output faces with a smaller angle, degrees
  Real input_min_angle = 0;               // the same of the input
  std::size_t input_below_15 = 0;
  Real max_deviation = 0;       // of output vertices from the input surface, in units of h
  Real max_face_deviation = 0;  // of output face centroids, in units of h
  Real volume_change = 0;       // (output - input) / input
};

// `in` is closed and 2-manifold (else the mesh is refused), without self-intersections (each operation is tested
// exactly, so none arise; with some in the input the result may be refused). With locked vertices only the part around
// the others is looked at: the cost is that part's, and faces elsewhere stay what they are. Feature lines: creases, and
// edges between faces of different kind or crack id. Line ends, junctions, sharp turns stay where they are, other line
// vertices move along the line only. Every output face has the kind, crack id and material of the input region it lies
// in, and `source`, `side` and corner values of the closest input faces there. Vertices are renumbered (locked ones
// keep their order). Deterministic. Throws InputError for options out of range.
RemeshReport remesh(const SurfaceMesh& in, const RemeshOptions& options, SurfaceMesh& out);

// Smallest angle of a triangle, radians; 0 for a degenerate one.
Real smallest_angle(const std::array<Vec3, 3>& corners);

// Lock flags that leave alone what is good already: nonzero for vertices farther than `distance` (metres, along edges)
// from every face with an angle below 15 degrees or an edge outside [0.5, 1.6] edge_length. A fragment remeshed with
// them changes near its new walls only, and its volume and untouched faces stay what they were.
std::vector<std::uint8_t> lock_good_regions(const SurfaceMesh& mesh, Real edge_length, Real distance);
// The same for a graded target, one length a vertex (metres).
std::vector<std::uint8_t> lock_good_regions(const SurfaceMesh& mesh, const std::vector<Real>& size, Real distance);

}  // namespace sherd
