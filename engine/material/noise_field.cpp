#include "engine/material/noise_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/material/lattice.h"

namespace sherd {
namespace {

// A uniform direction by Archimedes' theorem: height and longitude are uniform.
Vec3 gradient(const Cell& cell, std::uint64_t seed) {
  Random random = cell_random(cell, seed);
  const Real z = random.uniform(-1, 1), longitude = random.uniform(0, 2 * std::numbers::pi);
  const Real r = std::sqrt(std::max(0.0, 1 - z * z));
  return {r * std::cos(longitude), r * std::sin(longitude), z};
}

// Twice differentiable, 0 at 0 and 1 at 1.
Real fade(Real t) {
  return t * t * t * (t * (6 * t - 15) + 10);
}

// In [-1, 1]: the weights' mean of |gradient . offset| is largest at a cell's centre, sqrt(3)/2.
Real gradient_noise(const Vec3& x, std::uint64_t seed) {
  const Cell cell = cell_of(x);
  const Vec3 local = x - corner_of(cell);
  Real sum = 0;
  for (int k = 0; k < 8; ++k) {
    const std::array<int, 3> corner{k & 1, (k >> 1) & 1, k >> 2};
    Real weight = 1;
    Vec3 offset = local;
    Cell at = cell;
    for (std::size_t i = 0; i < 3; ++i) {
      const int axis = static_cast<int>(i);
      weight *= corner[i] ? fade(local[axis]) : 1 - fade(local[axis]);
      offset[axis] -= corner[i];
      at[i] += corner[i];
    }
    if (weight > 0) sum += weight * dot(gradient(at, seed), offset);
  }
  return std::clamp(2 / std::numbers::sqrt3 * sum, -1.0, 1.0);
}

}  // namespace

Real NoiseField::at(const Vec3& x) const {
  const Real g = gradient_noise(lattice_place(x, 0.5 * spec_.wavelength), spec_.seed);
  return spec_.mean * (spec_.lognormal ? std::exp(spec_.amplitude * g) : 1 + spec_.amplitude * g);
}

}  // namespace sherd
