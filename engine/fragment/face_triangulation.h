// Constrained Delaunay triangulation of one face with the points and segments of the cut in it, and the side of the cut
// each triangle lies on.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "engine/fragment/arrangement_point.h"

namespace sherd {

struct FaceArrangement {
  std::vector<ArrangementPoint> points;                // the three corners, then the crossings
  std::vector<std::array<std::uint32_t, 2>> segments;  // start, end; they meet in end points only
  // Per point: bit k for one that lies exactly on the face's edge k (corner k has bits k and k - 1). Or empty: unknown.
  std::vector<std::uint8_t> edges;
};

struct FaceTriangulation {
  bool ok = false;
  std::string reason;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // oriented like the face, indices into points
  std::vector<char> right;                              // per triangle: right of the cut's segments (else left)
};

// Combinatorially exact; only the choice of diagonals uses rounded positions. Not ok when the points do not form a
// planar straight-line graph of strictly convex triangles or the two sides of the cut contradict each other.
FaceTriangulation triangulate_face(const FaceArrangement& face);

}  // namespace sherd
