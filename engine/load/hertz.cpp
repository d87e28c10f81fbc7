#include "engine/load/hertz.h"

namespace sherd {

Real effective_modulus(Real young1, Real nu1, Real young2, Real nu2) {
  const Real compliance = (1 - nu1 * nu1) / young1 + (young2 > 0 ? (1 - nu2 * nu2) / young2 : 0);
  return 1 / compliance;
}

Real hertz_duration(Real mass, Real radius, Real modulus, Real speed) {
  return 2.87 * std::pow(mass * mass / (radius * modulus * modulus * speed), 0.2);
}

Real hertz_radius(Real force, Real radius, Real modulus) {
  return std::cbrt(3 * force * radius / (4 * modulus));
}

}  // namespace sherd
