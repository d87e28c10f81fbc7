// Constants of isotropic elasticity that the kernels share.
#pragma once
#include <numbers>

#include "kernels/core/vec3.h"

namespace sherd {

struct Elastic {
  Real mu = 1;    // shear modulus, Pa
  Real nu = 0.3;  // Poisson's ratio, -1 < nu < 0.5
  SHERD_HD Real lambda() const { return 2 * mu * nu / (1 - 2 * nu); }
  SHERD_HD Real kelvin() const { return 1 / (16 * std::numbers::pi * mu * (1 - nu)); }  // c of U_ij
};

}  // namespace sherd
