#include "engine/elastostatic/panel_search.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernels/core/parallel.h"

namespace sherd {

PanelSearch::PanelSearch(const Vec3Column& centroid, const std::vector<Real>& reach2) : order_(along_curve(centroid)) {
  bounds_.resize((order_.size() + kBlock - 1) / kBlock);
  for (std::size_t i = 0; i < bounds_.size(); ++i)
    for (const std::uint32_t t : block(i)) {
      const Real reach = std::sqrt(reach2[t]);
      bounds_[i].grow(centroid[t] - Vec3{reach, reach, reach}),
          bounds_[i].grow(centroid[t] + Vec3{reach, reach, reach});
    }
  groups_.resize((bounds_.size() + kBlock - 1) / kBlock);
  for (std::size_t i = 0; i < bounds_.size(); ++i) groups_[i / kBlock].grow(bounds_[i]);
}

std::vector<std::uint32_t> along_curve(const Vec3Column& points) {
  std::vector<std::uint32_t> all(points.size());
  std::iota(all.begin(), all.end(), 0u);
  return along_curve(points, std::move(all));
}

std::vector<std::uint32_t> along_curve(const Vec3Column& points, std::vector<std::uint32_t> of) {
  constexpr int kBits = 20;
  Box box;
  for (const std::uint32_t i : of) box.grow(points[i]);
  const Real size = std::max(box.diagonal(), 1e-300);
  std::vector<KeyedIndex> keys;
  keys.reserve(of.size());
  for (const std::uint32_t i : of) {
    const Vec3 p = (points[i] - box.low) * (((1 << kBits) - 1) / size);
    std::uint64_t code = 0;
    for (int bit = kBits - 1; bit >= 0; --bit)
      for (int k = 0; k < 3; ++k) code = 2 * code + ((static_cast<std::uint64_t>(p[k]) >> bit) & 1);
    keys.push_back({code, i});
  }
  parallel_sort(keys);
  for (std::size_t i = 0; i < keys.size(); ++i) of[i] = keys[i].index;
  return of;
}

}  // namespace sherd
