// Random numbers that belong to the cells of an integer lattice, the same for everybody who asks. Internal to the
// material's fields.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>

#include "kernels/core/random.h"
#include "kernels/core/vec3.h"

namespace sherd {

using Cell = std::array<std::int64_t, 3>;

// x in units of the lattice, held within what integers and fractions of a double can tell apart: no body is that large.
inline Vec3 lattice_place(const Vec3& x, Real unit) {
  constexpr Real kFarthest = 1e12;
  const Vec3 far{kFarthest, kFarthest, kFarthest};
  return min(max(x / unit, -far), far);
}
inline Cell cell_of(const Vec3& place) {
  const auto index = [](Real x) { return static_cast<std::int64_t>(std::floor(x)); };
  return {index(place.x), index(place.y), index(place.z)};
}
inline Vec3 corner_of(const Cell& c) {
  return {static_cast<Real>(c[0]), static_cast<Real>(c[1]), static_cast<Real>(c[2])};
}

// Each index passes through a full round of mixing, so that neighbours share nothing.
inline Random cell_random(const Cell& cell, std::uint64_t seed) {
  std::uint64_t state = Random(seed).next();
  for (const std::int64_t i : cell) state = Random(state ^ static_cast<std::uint64_t>(i)).next();
  return Random(state);
}

}  // namespace sherd
