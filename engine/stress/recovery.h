// Stress on the surface: tangential derivatives of the displacement by least-squares fits around each vertex, completed
// by the known traction (design notes: elastostatics section 6.3, thin-walls section 7 steps 1, 2, 9).
#pragma once
#include <vector>

#include "engine/mesh/surface_mesh.h"
#include "kernels/core/symmetric.h"
#include "kernels/fundamental/elastic.h"

namespace sherd {

struct RecoveryOptions {
  Real feature_angle = 35;  // degrees; faces that meet at more belong to different smooth groups
  int degree = 3;           // of the fit: 2 or 3
};

// A corner of the surface: a vertex together with one of the smooth groups of faces around it. Smooth vertices have
// one.
struct SurfaceCorner {
  std::uint32_t vertex = 0;
  Vec3 tangent_x, tangent_y, normal;  // of the fitted surface; normal unit, outward
  std::vector<std::uint32_t> patch;   // vertices of the fit; patch[0] is `vertex`
  std::vector<Real> row_x, row_y;     // derivative along tangent_x, tangent_y = sum of row * value over the patch
  std::vector<std::uint32_t> faces;   // incident faces of the group
};

class SurfaceRecovery {
 public:
  SurfaceRecovery(const SurfaceMesh& mesh, const RecoveryOptions& options);
  const std::vector<SurfaceCorner>& corners() const { return corners_; }
  // Index into corners() of corner k of face t.
  std::uint32_t corner_of(std::size_t t, int k) const { return corner_of_[3 * t + static_cast<std::size_t>(k)]; }
  // displacement: total, per vertex, m; traction: total known traction per corner, Pa. Returns the stress per corner,
  // Pa.
  std::vector<Sym3> stress(const Vec3Column& displacement, const Vec3Column& traction, const Elastic& material) const;

 private:
  std::vector<SurfaceCorner> corners_;
  std::vector<std::uint32_t> corner_of_;
};

}  // namespace sherd
