// How pieces meet along a circle: what radial cracks are counted by.
#pragma once
#include <numbers>
#include <vector>

#include "engine/mesh/bvh.h"

namespace sherd {

// How often the piece changes along a circle about the y axis, all at height `y`; 0 when one piece holds all of it.
inline int crossings(const std::vector<SurfaceMesh>& pieces, Real radius, Real y) {
  constexpr int kPoints = 720;
  const std::vector<TriangleBvh> trees(pieces.begin(), pieces.end());
  std::vector<std::size_t> order;
  for (int i = 0; i < kPoints; ++i) {
    const Real a = 2 * std::numbers::pi * i / kPoints;
    const Vec3 x{radius * std::cos(a), y, radius * std::sin(a)};
    for (std::size_t k = 0; k < trees.size(); ++k)
      if (trees[k].inside(x)) {
        if (order.empty() || order.back() != k) order.push_back(k);
        break;
      }
  }
  if (order.size() > 1 && order.front() == order.back()) order.pop_back();
  return order.size() > 1 ? static_cast<int>(order.size()) : 0;
}

}  // namespace sherd
