// Displacement gradient of a Kelvin single layer with constant density on one panel: what stress inside a body is
// summed from, in either formulation.
#pragma once
#include "engine/elastostatic/boundary.h"
#include "kernels/fundamental/elastic.h"

namespace sherd {

struct LayerGradient {
  Mat3 kelvin;   // [i][k] = u_i,k of the layer with density q
  Vec3 inverse;  // A,k: gradient of the integral of 1/l, no unit
};

// q in Pa, x any point. Closed form, seven or three Gauss points by distance (QuadratureOptions). `side`: the limit to
// take when x lies on the panel itself; the gradient is logarithmically infinite on the panel's edges (clamped,
// finite).
LayerGradient layer_gradient(const PanelFrame& panel, const Vec3& x, const Vec3& q, const Elastic& material,
                             const QuadratureOptions& options, Side side = Side::kAway);

}  // namespace sherd
