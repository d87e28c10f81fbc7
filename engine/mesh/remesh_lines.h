// Feature lines of the input: polylines of edges that are creases or that part faces of different region (kind,
// crack id, texture chart), between fixed vertices (ends, junctions, sharp turns, locked vertices). Line vertices of
// the working mesh live at an arc length.
#pragma once
#include <vector>

#include "engine/mesh/remesh_mesh.h"

namespace sherd {

enum class VertexRole : std::uint8_t { kFree, kLine, kFixed };

struct FeatureLine {
  std::vector<Vec3> point;
  std::vector<Real> arc;  // length from the start, metres; arc.front() = 0

  Vec3 at(Real s) const;
  Real nearest(const Vec3& p) const;  // arc length of the closest point
};

struct FeatureLines {
  std::vector<FeatureLine> lines;
  // Per vertex of the working mesh (extended as it grows): line and arc length are meant for kLine only.
  std::vector<VertexRole> role;
  std::vector<std::uint32_t> line;
  std::vector<Real> arc;
};

// Marks mesh.line of every feature half-edge. `locked` is empty or per vertex. Creases that form only stubs and specks
// shorter than a few `edge_length` are noise of the surface and no features.
FeatureLines find_feature_lines(EditMesh& mesh, Real feature_angle_degrees, Real edge_length,
                                const std::vector<std::uint8_t>& locked);

}  // namespace sherd
