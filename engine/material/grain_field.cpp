#include "engine/material/grain_field.h"

#include <algorithm>
#include <limits>

#include "engine/material/lattice.h"

namespace sherd {
namespace {

// Points keep this far from their cube's sides. Then a place is at most 0.9 sqrt(3) = 1.56 from its own cube's point,
// and every point of cubes three or more away is farther than 2.1. So neighbours up to two away hold the nearest point,
// and every point whose bisector with it passes within (2.1 - 1.56) / 2 > kWidestBoundary.
constexpr Real kMargin = 0.1;
constexpr std::int64_t kReach = 2;

Vec3 point_in(const Cell& cell, Random& random) {
  Vec3 p = corner_of(cell);
  for (int i = 0; i < 3; ++i) p[i] += random.uniform(kMargin, 1 - kMargin);
  return p;
}

template <class F>
void for_neighbours(const Cell& c, const F& f) {
  for (std::int64_t i = -kReach; i <= kReach; ++i)
    for (std::int64_t j = -kReach; j <= kReach; ++j)
      for (std::int64_t k = -kReach; k <= kReach; ++k) f(Cell{c[0] + i, c[1] + j, c[2] + k});
}

}  // namespace

GrainField::Place GrainField::place(const Vec3& x) const {
  const Vec3 p = lattice_place(x, spec_.size);
  std::array<Vec3, 125> points;
  std::size_t n = 0, nearest = 0;
  Cell grain{};
  for_neighbours(cell_of(p), [&](const Cell& cell) {
    Random random = cell_random(cell, spec_.seed);
    points[n] = point_in(cell, random);
    if (n == 0 || distance2(points[n], p) < distance2(points[nearest], p)) nearest = n, grain = cell;
    ++n;
  });
  Real boundary = std::numeric_limits<Real>::infinity();
  for (std::size_t i = 0; i < n; ++i) {
    if (i == nearest) continue;
    const Vec3 apart = points[i] - points[nearest];
    boundary = std::min(boundary, dot(0.5 * (points[i] + points[nearest]) - p, apart) / norm(apart));
  }
  return {grain, spec_.size * std::max(boundary, 0.0)};
}

Real GrainField::at(const Vec3& x) const {
  const Place at = place(x);
  Random random = cell_random(at.grain, spec_.seed ^ 0x67A1Bull);  // apart from the numbers that place the points
  const Real value = spec_.mean * (1 + spec_.spread * random.uniform(-1, 1));
  const Real inside = spec_.width > 0 ? std::min(at.to_boundary / (spec_.width * spec_.size), 1.0) : 1;
  return value * std::lerp(spec_.boundary, 1.0, inside);
}

}  // namespace sherd
