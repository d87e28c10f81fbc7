// Laplace's fundamental solution 1/(4 pi l). r = x - y, target minus source; l = |r|; n is the source normal.
#pragma once
#include <numbers>

#include "kernels/core/vec3.h"

namespace sherd::laplace {

// Single layer potential of a unit source.
template <class T>
SHERD_HD T single_layer(const Vec3T<T>& r) {
  return T(1) / (T(4 * std::numbers::pi) * norm(r));
}
// Its gradient with respect to x.
template <class T>
SHERD_HD Vec3T<T> single_layer_gradient(const Vec3T<T>& r) {
  const T l2 = norm2(r);
  return r * (T(-1) / (T(4 * std::numbers::pi) * l2 * norm(r)));
}
// Double layer (1/4pi) (r . n)/l^3: its integral over a closed surface is -1 inside and 0 outside when n is outward.
template <class T>
SHERD_HD T double_layer(const Vec3T<T>& r, const Vec3T<T>& n) {
  const T l2 = norm2(r);
  return dot(r, n) / (T(4 * std::numbers::pi) * l2 * norm(r));
}

}  // namespace sherd::laplace
