#include "engine/elastostatic/row_tester.h"

#include <algorithm>

namespace sherd {

RowTester::RowTester(const Testing& testing, std::size_t first, std::size_t groups, SourceBlockBuilder& builder) {
  const std::vector<Testing::Point>& points = testing.gauss_points();
  std::vector<std::uint32_t> panels;  // the points are in their order
  for (std::size_t i = first * kLanes; i < std::min((first + groups) * kLanes, points.size()); ++i) {
    if (panels.empty() || panels.back() != points[i].panel) panels.push_back(points[i].panel);
    slot_.push_back(panels.size() - 1);
    for (const cubic::Polynomial& shape : cubic::kHermite)
      weights_.push_back(points[i].weight * cubic::evaluate(shape, points[i].s, points[i].t));
  }
  block_ = builder.build(panels);
}

void RowTester::test(const double* batch, std::size_t stride, std::size_t v0, std::size_t lanes, Work& w) const {
  const LaneKernels& kernels = lane_kernels();
  w.freedoms.assign(kLaneBlock * block_.freedoms, 0), w.rows.assign(kLaneBlock * block_.vertices.size(), 0);
  for (std::size_t p = 0; p < slot_.size(); ++p) {
    const double* in = batch + p / kLanes * stride + kLaneBlock * v0 + p % kLanes;
    alignas(64) double value[kLaneBlock] = {};
    for (std::size_t l = 0; l < lanes; ++l)
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) value[(3 * j + i) * kLanes + l] = in[kLaneBlock * l + (3 * i + j) * kLanes];
    kernels.add_weighted(value, weights_.data() + kPanelFreedoms * p, block_.local[slot_[p]].data(), w.freedoms.data());
  }
  kernels.gather(block_.gather(), w.freedoms.data(), w.rows.data());
}

}  // namespace sherd
