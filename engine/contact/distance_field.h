// Signed distance of a closed mesh on a regular grid: negative inside, metres, mesh coordinates.
#pragma once
#include <vector>

#include "engine/mesh/bvh.h"
#include "engine/mesh/surface_mesh.h"

namespace sherd {

struct FieldOptions {
  Real spacing = 0;                 // grid step, m; 0 chooses it from the mesh (see field_spacing)
  std::size_t max_nodes = 300'000;  // the step grows until the grid fits (4 bytes a node)
};

// mean edge length, kept between 1/64 and 1/32 of the longest side of the bounding box, and at most a quarter of its
// shortest side so that a plate has nodes inside; then enlarged until the grid has at most max_nodes.
Real field_spacing(const SurfaceMesh& mesh, const FieldOptions& options);

// Node values: exact distance (rounded to float) within two grid steps of the surface, farther away the distance to a
// face carried over from a neighbour (an upper bound, a fraction of a step too large at most). Between nodes trilinear:
// within one grid step of the true distance, exact where the nearest surface is flat.
class SignedDistanceField {
 public:
  // `bvh` of the same mesh, used for the signs (parity along the three grid lines of a node; generic rays where they
  // differ).
  SignedDistanceField(const SurfaceMesh& mesh, const TriangleBvh& bvh, const FieldOptions& options = {});

  // Beyond the grid: a lower bound from the nearest grid point.
  Real value(const Vec3& p) const;
  // value(p) > bound, for most far points without a look at the grid (a random access to memory).
  bool beyond(const Vec3& p, Real bound) const {
    const Vec3 out = max(max(origin_ - p, p - high_), Vec3{});
    return norm2(out) > bound * std::abs(bound) || value(p) > bound;
  }
  // Gradient of the trilinear interpolant (not normalized); beyond the grid that of the nearest grid point.
  Vec3 gradient(const Vec3& p) const;
  Real spacing() const { return h_; }
  std::size_t node_count() const { return values_.size(); }
  Box box() const { return {origin_, high_}; }

 private:
  struct Cell {
    std::size_t corner;  // node index of the low corner
    Vec3 fraction;       // in [0, 1]
  };
  Cell locate(const Vec3& clamped) const;
  Vec3 clamp(const Vec3& p) const;

  Vec3 origin_, high_;  // corners of the grid
  Real h_ = 1, inverse_h_ = 1;
  std::size_t n_[3] = {0, 0, 0};  // nodes; x fastest
  std::vector<float> values_;
};

}  // namespace sherd
