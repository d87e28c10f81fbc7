#include "engine/load/tension_bound.h"

#include <algorithm>

namespace sherd {

Real tension_bound(const BoundedBody& body, const BoundedLoad& load) {
  constexpr Real kMargin = 1.5, kContact = 0.8, kSlender = 0.16;
  constexpr Real kRotation = 0.25;  // of density (spin diagonal)^2; a disc has 0.1
  const Real t = body.thickness, d = body.diagonal;
  const Real bending = load.force / (t * t) * (1 + kSlender * d / t), contact = kContact * load.pressure;
  return kMargin * std::max(bending, contact) + kRotation * load.density * load.spin * load.spin * d * d;
}

}  // namespace sherd
