// Wall thickness T: how much solid lies under the surface, where that solid is a wall (a far side that faces back).
// Elements longer than a wall is thick bend wrongly, so meshes are checked against T (thickness_resolution.h) and
// graded by it (sizing.h).
#pragma once
#include <vector>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

struct ThicknessOptions {
  // Degrees. Two sides are one wall when they are parallel within this angle. Below 45, so that neither a cube's edge
  // (90) nor a chipped one (60) is a wall; above the 36 of a ten-sided stem's far facets.
  Real parallel_angle = 40;
  // The way across is measured along the inward normal: exact on parallel walls, concentric shells and bars, and d tan
  // a on a wedge of angle a at distance d from its edge. Where that ray ends on no facing side (past a rim, by a
  // facet's tilt), the shortest of `cone_rays` at `cone_angle` degrees from it counts: 6 % long on a parallel wall.
  // Tried on plates with noise of 0.15 T, wedges and cubes: the shortest of all reads 0.86 d tan a on a wedge of 35
  // degrees, the median 1.06 T on every wall, the normal alone misses 17 % of that wedge.
  Real cone_angle = 20;
  int cone_rays = 6;
  // A face beside one (on the same smooth side) that reads this many times as thick lies in a tip, which is no wall:
  // at the edge of a wedge T goes to zero however fine the mesh, and nothing bends there.
  Real tip_ratio = 1.5;
  Real feature_angle = 40;  // degrees: sides meet at edges whose normals differ by more
};

struct WallThickness {
  std::vector<Real> face;    // metres, at the face's centroid; infinity where there is no wall
  std::vector<Real> vertex;  // metres, the least of the faces around; infinity when none is a wall or there are none
};

// `mesh` should be closed and oriented outward; where it is not, rays may find no far side (infinity). Walls thinner
// than 4e-6 of the box diagonal are not seen. Parallel; the same bits for any number of threads. Throws InputError for
// options out of range.
WallThickness wall_thickness(const SurfaceMesh& mesh, const ThicknessOptions& options = {});

// Local edge length h of each face, metres: the edge of the equilateral triangle whose area is the mean area around (of
// the faces around each corner, averaged over the three corners).
std::vector<Real> local_edge_length(const SurfaceMesh& mesh);

}  // namespace sherd
