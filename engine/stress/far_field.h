// Somigliana's gradient of a solved body at many points: the three-point sum over all triangles for eight points at
// once, corrected where a triangle is nearer than that allows.
#pragma once
#include <span>

#include "engine/elastostatic/lane_kernels.h"
#include "engine/stress/element_field.h"

namespace sherd {

class FarField {
 public:
  // Keeps references to both.
  FarField(const Boundary& boundary, const std::vector<ElementField>& elements, const Elastic& material,
           const QuadratureOptions& options);
  // Up to kLanes points; face[k]: the triangle point k lies on, for the limit from inside, or kNone. [i][k] = u_i,k.
  void gradients(std::span<const Vec3> x, std::span<const std::uint32_t> face, std::span<Mat3> out) const;

 private:
  const Boundary& boundary_;
  const std::vector<ElementField>& elements_;
  Elastic material_;
  Vec3Column position_, density_, guenter_, normal_;
  std::array<std::vector<Real>, 9> gradient_;
  std::vector<Real> near2_, middle2_;  // squared reach of the closed form and of seven points, m^2
  Real least2_ = 1e300;                // a point this near a Gauss point is that point, m^2
};

}  // namespace sherd
