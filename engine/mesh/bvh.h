// Double-precision bounding volume hierarchy over the triangles of a mesh: the queries that decide geometry (fracture,
// cut, remeshing). Embree (engine/mesh/embree_scene.h) is for bulk queries where float is enough.
#pragma once
#include <limits>
#include <vector>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

class TriangleBvh {
 public:
  // Copies the corners: the mesh may change or die afterwards.
  explicit TriangleBvh(const SurfaceMesh& mesh);

  struct Hit {
    Real t;  // origin + t * direction
    std::uint32_t face;
  };
  struct Closest {
    Vec3 point;
    std::uint32_t face = kNone;  // kNone when nothing lies within the given distance
    Real distance2 = std::numeric_limits<Real>::infinity();
  };

  Closest closest(const Vec3& p, Real max_distance = std::numeric_limits<Real>::infinity()) const;
  // All crossings with t in [t_min, t_max], sorted by t; direction need not be a unit vector.
  void all_hits(const Vec3& origin, const Vec3& direction, Real t_min, Real t_max, std::vector<Hit>& hits) const;
  // Majority of three fixed, generic ray parities; exact on closed meshes away from the surface.
  bool inside(const Vec3& p) const;
  // Faces whose boxes overlap `box`, ascending.
  void overlapping(const Box& box, std::vector<std::uint32_t>& faces) const;
  // Pairs (face here, face there) whose boxes overlap, sorted.
  void overlapping_pairs(const TriangleBvh& other, std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs) const;

  // Around all triangles.
  Box box() const { return nodes_.empty() ? Box{} : nodes_[0].box; }
  std::size_t triangle_count() const { return corners_.size(); }
  const std::array<Vec3, 3>& corners(std::uint32_t face) const { return corners_[face]; }

 private:
  struct Node {
    Box box;
    std::uint32_t first = 0, count = 0;  // leaf: faces order_[first .. first+count)
    std::uint32_t right = 0;             // inner: left child is the next node
  };
  std::uint32_t build(std::uint32_t first, std::uint32_t count);

  std::vector<std::array<Vec3, 3>> corners_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

// Point of triangle abc closest to p (Ericson, Real-Time Collision Detection, 5.1.5).
Vec3 closest_point_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace sherd
