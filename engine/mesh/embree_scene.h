// Bulk closest-point and ray queries through Embree. Traversal is in float on the mesh moved to its box centre and
// scaled to size 1; answers are computed in double from the mesh's own corners, so a closest point is exact to double
// rounding, and the same for any thread count (equal distances: the lowest face wins). engine/mesh/bvh.h decides
// geometry; this one is for thousands of points.
#pragma once
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

class EmbreeScene {
 public:
  struct Closest {
    Vec3 point;
    std::uint32_t face = kNone;  // kNone when nothing lies within the given distance
    Real distance2 = std::numeric_limits<Real>::infinity();
  };
  struct Hit {
    Real t = std::numeric_limits<Real>::infinity();  // origin + t * direction
    std::uint32_t face = kNone;                      // kNone when nothing is hit
  };

  // Copies the mesh: it may change or die afterwards. Throws InternalError when Embree refuses (out of memory).
  explicit EmbreeScene(const SurfaceMesh& mesh);
  ~EmbreeScene();
  EmbreeScene(EmbreeScene&&) noexcept;
  EmbreeScene& operator=(EmbreeScene&&) noexcept;

  Closest closest(const Vec3& p, Real max_distance = std::numeric_limits<Real>::infinity()) const;
  // result[i] belongs to points[i]; parallel.
  void closest(const Vec3Column& points, Real max_distance, std::vector<Closest>& result) const;
  // First crossing with t in [t_min, t_max]. The face is found in float (a ray within 1e-6 of the mesh's size of an
  // edge may report the neighbour), t is then computed in double on that face. direction need not be a unit vector.
  Hit first_hit(const Vec3& origin, const Vec3& direction, Real t_min = 0,
                Real t_max = std::numeric_limits<Real>::infinity()) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sherd
