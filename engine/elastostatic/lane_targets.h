// Targets as the lane kernels take them: eight at a time.
#pragma once
#include <span>

#include "engine/elastostatic/lane_kernels.h"
#include "engine/mesh/surface_mesh.h"

namespace sherd {

// Up to eight points, coordinates one after another; those beyond `count` repeat the first.
struct LaneTargets {
  std::size_t count;
  double x[3 * kLanes];
  Box box;

  LaneTargets(const Vec3Column& points, std::span<const std::uint32_t> of) : count(of.size()) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      const Vec3 p = points[of[k < count ? k : 0]];
      box.grow(p);
      for (std::size_t j = 0; j < 3; ++j) x[j * kLanes + k] = p[static_cast<int>(j)];
    }
  }
  Vec3 target(std::size_t k) const { return {x[k], x[kLanes + k], x[2 * kLanes + k]}; }
};

}  // namespace sherd
