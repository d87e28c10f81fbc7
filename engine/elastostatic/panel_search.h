// Which panels reach into a box: panels in blocks of neighbours with their bounds, two levels deep.
#pragma once
#include <span>
#include <vector>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

class PanelSearch {
 public:
  static constexpr std::size_t kBlock = 32;

  // reach2: squared distance from its centroid up to which a panel matters, m^2.
  PanelSearch(const Vec3Column& centroid, const std::vector<Real>& reach2);

  std::size_t block_count() const { return bounds_.size(); }
  // Panels of a block; neighbours along a space-filling curve.
  std::span<const std::uint32_t> block(std::size_t i) const {
    return {order_.data() + i * kBlock, std::min(kBlock, order_.size() - i * kBlock)};
  }
  // f(block) for every block with a panel that may reach into the box, ascending.
  template <class F>
  void visit(const Box& box, const F& f) const {
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (!groups_[g].overlaps(box)) continue;
      for (std::size_t i = g * kBlock; i < std::min((g + 1) * kBlock, bounds_.size()); ++i)
        if (bounds_[i].overlaps(box)) f(i);
    }
  }

 private:
  std::vector<std::uint32_t> order_;
  std::vector<Box> bounds_, groups_;
};

// The indices `of` of points in order along a space-filling curve (Morton), so that neighbours in the list are
// neighbours; and of all points.
std::vector<std::uint32_t> along_curve(const Vec3Column& points, std::vector<std::uint32_t> of);
std::vector<std::uint32_t> along_curve(const Vec3Column& points);

}  // namespace sherd
