// Elastic impact of two bodies (Hertz 1882; Johnson, Contact Mechanics, 1985, eqs 4.22-4.24 and 11.24).
#pragma once
#include "kernels/core/vec3.h"

namespace sherd {

// 1/E* = (1-nu1^2)/E1 + (1-nu2^2)/E2, Pa. Pass young2 = 0 for a rigid partner.
Real effective_modulus(Real young1, Real nu1, Real young2, Real nu2);
// 2.87 (m^2 / (R E*^2 v))^(1/5), s; effective mass kg, effective radius m, approach speed m/s, all > 0.
Real hertz_duration(Real mass, Real radius, Real modulus, Real speed);
// Contact radius (3 F R / (4 E*))^(1/3), m, under the normal force F.
Real hertz_radius(Real force, Real radius, Real modulus);

}  // namespace sherd
