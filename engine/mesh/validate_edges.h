// Undirected edges of a triangle soup, however broken: validation and repair read them.
#pragma once
#include <vector>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

struct EdgeUse {
  std::uint32_t low, high;  // vertices, low < high
  std::uint32_t half_edge;  // 3 t + k: corner k -> k + 1 of triangle t
  bool forward;             // runs low -> high
};

// Sorted by (low, high, half_edge): the uses of one edge lie together. Edges between equal vertices are left out.
std::vector<EdgeUse> sorted_edge_uses(const SurfaceMesh& mesh);
// One past the last use of the edge that starts at uses[i].
inline std::size_t edge_end(const std::vector<EdgeUse>& uses, std::size_t i) {
  std::size_t j = i + 1;
  while (j < uses.size() && uses[j].low == uses[i].low && uses[j].high == uses[i].high) ++j;
  return j;
}

// Disjoint sets; a set's name is its smallest member, so results do not depend on the order of the unions.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) {
    parent_.reserve(n);
    for (std::size_t i = 0; i < n; ++i) parent_.push_back(static_cast<std::uint32_t>(i));
  }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    (a < b ? parent_[b] : parent_[a]) = a < b ? a : b;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

// The corner 3 t + k of triangle t at `vertex`, which must be one of its vertices.
inline std::uint32_t corner_at(const SurfaceMesh& mesh, std::uint32_t t, std::uint32_t vertex) {
  const Triangle& f = mesh.triangles[t];
  return 3 * t + (f[0] == vertex ? 0u : (f[1] == vertex ? 1u : 2u));
}

// Smallest altitude over longest edge, in [0, sqrt(3)/2].
Real triangle_shape(const Vec3& a, const Vec3& b, const Vec3& c);
constexpr Real kNeedleShape = 1e-4;       // remeshing and the quadratures cope above this
constexpr Real kDegenerateShape = 1e-14;  // below the rounding of the altitude itself: no area

}  // namespace sherd
