// Point sets that try an octree.
#pragma once
#include <string>
#include <vector>

#include "kernels/core/column.h"
#include "kernels/core/random.h"

namespace sherd::fmm {

struct PointSet {
  std::string name;
  Vec3Column sources, targets;
};

inline Vec3Column random_points(std::size_t n, std::uint64_t seed, const Vec3& scale, const Vec3& shift = {}) {
  Random random(seed);
  Vec3Column p;
  for (std::size_t i = 0; i < n; ++i)
    p.push_back(Vec3{scale.x * random.uniform(), scale.y * random.uniform(), scale.z * random.uniform()} + shift);
  return p;
}

inline Vec3Column sphere_points(std::size_t n, std::uint64_t seed) {
  Random random(seed);
  Vec3Column p;
  while (p.size() < n) {
    const Vec3 v{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    const Real l = norm(v);
    if (l > 0.1 && l < 1) p.push_back(v / l);
  }
  return p;
}

inline Vec3Column joined(Vec3Column a, const Vec3Column& b) {
  for (std::size_t i = 0; i < b.size(); ++i) a.push_back(b[i]);
  return a;
}

// Distances to the corner shrink by 1e4.
inline Vec3Column graded_points(std::size_t n, std::uint64_t seed) {
  Random random(seed);
  Vec3Column p;
  for (std::size_t i = 0; i < n; ++i) {
    const Real r = std::pow(10.0, random.uniform(-4, 0));
    p.push_back({r * random.uniform(), r * random.uniform(), 0.2 * r * r});
  }
  return p;
}

inline std::vector<PointSet> point_sets() {
  const Vec3Column volume = random_points(1500, 1, {1, 1, 1}), sphere = sphere_points(1500, 2);
  const Vec3Column line = random_points(1200, 3, {3, 0, 0}, {1, 1, 1}), plane = random_points(1500, 4, {1, 0, 2});
  const Vec3Column graded = graded_points(1500, 5);
  const Vec3Column far = joined(random_points(300, 6, {1, 1, 1}), random_points(300, 7, {1, 1, 1}, {1e12, 0, 0}));
  const Vec3Column near_far =
      joined(random_points(600, 6, {1, 1, 1}), random_points(600, 7, {1, 1, 1}, {1e3, -2e3, 1e3}));
  Vec3Column same(500), heaps;
  for (std::size_t i = 0; i < 900; ++i) heaps.push_back(volume[i % 9]);
  return {
      {"volume", volume, volume},
      {"sphere", sphere, sphere},
      {"line", line, line},
      {"plane", plane, plane},
      {"graded", graded, graded},
      {"clusters 1e12 apart", far, far},
      {"clusters 1e3 apart", near_far, near_far},
      {"one place", same, same},
      {"nine places", heaps, heaps},
      {"heaps among others", joined(heaps, sphere), joined(heaps, sphere)},
      {"sources in, targets on a sphere", random_points(1200, 8, {1, 1, 1}, {-0.5, -0.5, -0.5}), sphere},
      {"graded sources, sphere targets", graded, sphere},
      {"sphere sources, graded targets", sphere, graded},
      {"apart", volume, random_points(700, 9, {0.1, 0.1, 0.1}, {9, 9, 9})},
      {"many sources, two targets", sphere, random_points(2, 10, {1, 1, 1})},
      {"two sources, many targets", random_points(2, 10, {1, 1, 1}), sphere},
      {"1e300", random_points(500, 11, {1e300, 1e300, 1e300}), random_points(500, 12, {-1e300, 1e300, 1e300})},
      {"1e-300", random_points(500, 11, {1e-300, 1e-300, 1e-300}), random_points(500, 12, {-1e-300, 1e-300, 1e-300})},
      {"subnormal", random_points(200, 13, {1e-310, 1e-310, 1e-310}), random_points(200, 14, {1e-310, 0, 0})},
      {"small, far from the origin", random_points(900, 15, {1e-9, 1e-9, 1e-9}, {1, -1, 1}), sphere_points(0, 1)},
      {"no targets", volume, {}},
      {"no sources", {}, volume},
      {"nothing", {}, {}},
      {"one point", random_points(1, 16, {1, 1, 1}), random_points(1, 16, {1, 1, 1})},
      {"two points", random_points(2, 17, {1, 1, 1}), random_points(2, 17, {1, 1, 1})},
  };
}

}  // namespace sherd::fmm
