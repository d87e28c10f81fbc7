// Stress on the surface: tangential derivatives of the displacement by least-squares fits around each vertex, completed
// by the known traction (design notes: elastostatics section 6.3, thin-walls section 7 steps 1, 2, 9).
#pragma once
#include <vector>

#include "engine/mesh/surface_fit.h"
#include "engine/stress/rim.h"
#include "kernels/fundamental/elastic.h"

namespace sherd {

struct RecoveryOptions {
  Real feature_angle = 35;  // degrees; faces that meet at more belong to different smooth groups
  FitOptions fit;
  bool rims = true;  // use both tractions at convex sharp edges (rim.h)
};

// A corner of the surface with its fit: derivative along tangent_x = sum of row_x * value over the patch.
struct StressCorner : SurfaceCorner {
  Vec3 tangent_x, tangent_y, normal;  // of the fitted surface; normal unit, outward
  std::vector<std::uint32_t> patch;   // vertices of the fit; patch[0] is `vertex`
  std::vector<Real> row_x, row_y;
};

// Stress where the surface gradient g[i][k] = u_i,k (g n = 0) and the traction t on the outward normal n are known, Pa.
Sym3 surface_stress(const Mat3& g, const Vec3& n, const Vec3& t, const Elastic& material);

class SurfaceRecovery {
 public:
  SurfaceRecovery(const SurfaceMesh& mesh, const RecoveryOptions& options);
  const std::vector<StressCorner>& corners() const { return corners_; }
  // Index into corners() of corner k of face t.
  std::uint32_t corner_of(std::size_t t, int k) const { return corner_of_[3 * t + static_cast<std::size_t>(k)]; }
  // displacement: total, per vertex, m; traction: total known traction per corner, Pa. Returns the stress per corner,
  // Pa.
  std::vector<Sym3> stress(const Vec3Column& displacement, const Vec3Column& traction, const Elastic& material) const;

 private:
  std::vector<StressCorner> corners_;
  std::vector<std::uint32_t> corner_of_;
  std::vector<Rim> rims_;
};

}  // namespace sherd
