#include "engine/elastostatic/operator_rows.h"

#include <algorithm>

#include "engine/elastostatic/panel_rows.h"
#include "engine/elastostatic/panel_search.h"
#include "engine/elastostatic/source_block.h"

namespace sherd {
namespace {

constexpr std::size_t kBlockPanels = 128;

}  // namespace

struct OperatorRows::Impl {
  const Boundary& boundary;
  const Reconstruction& reconstruction;
  LaneConstants constants;
  const LaneKernels& kernels = lane_kernels();
  std::vector<SourceBlock> blocks;

  Impl(const Boundary& b, const Reconstruction& r, Real nu)
      : boundary(b), reconstruction(r), constants(lane_constants(nu)) {
    const std::vector<std::uint32_t> order = along_curve(b.centroid);
    SourceBlockBuilder builder(b, r, false);
    for (std::size_t first = 0; first < order.size(); first += kBlockPanels)
      blocks.push_back(builder.build({order.data() + first, std::min(kBlockPanels, order.size() - first)}));
  }
};

struct OperatorRows::Workspace {
  std::vector<double> freedom, vertex;
  double x[3 * kLanes], total[kLanes];
};

OperatorRows::OperatorRows(const Boundary& boundary, const Reconstruction& reconstruction, Real nu)
    : impl_(std::make_unique<Impl>(boundary, reconstruction, nu)) {}
OperatorRows::~OperatorRows() = default;

std::shared_ptr<OperatorRows::Workspace> OperatorRows::make_workspace() const {
  return std::make_shared<Workspace>();
}

namespace {

// The term - u(x) D[1](x), u(x) the vertex value or the shape functions at a point of a panel.
void subtract_own(const Reconstruction& r, const TargetGroup& g, OperatorRows::Workspace& w) {
  for (std::size_t k = 0; k < g.count; ++k) {
    if (g.vertex[k] != kNone) {
      for (std::size_t i = 0; i < 3; ++i) w.vertex[kLaneBlock * g.vertex[k] + 4 * i * kLanes + k] -= w.total[k];
      continue;
    }
    for (std::size_t a = 0; a < cubic::kNodes; ++a) {
      const Real weight = w.total[k] * cubic::evaluate(cubic::kShape[a], g.s[k], g.t[k]);
      for (const auto& [v, block] : r.row(r.nodes(g.panel[k])[a]))
        for (std::size_t i = 0; i < 3; ++i)
          for (std::size_t j = 0; j < 3; ++j)
            w.vertex[kLaneBlock * v + (3 * i + j) * kLanes + k] -= weight * block.m[i][j];
    }
  }
}

}  // namespace

std::span<const double> OperatorRows::evaluate(const TargetGroup& g, Workspace& w) const {
  const Boundary& b = impl_->boundary;
  const LaneConstants& c = impl_->constants;
  const LaneKernels& kernels = impl_->kernels;
  const std::size_t vertices = impl_->reconstruction.vertex_count();
  for (std::size_t k = 0; k < kLanes; ++k)
    for (int i = 0; i < 3; ++i) w.x[static_cast<std::size_t>(i) * kLanes + k] = g.x[k < g.count ? k : 0][i];
  w.vertex.assign(kLaneBlock * vertices, 0);
  std::fill_n(w.total, kLanes, 0);
  for (const SourceBlock& block : impl_->blocks) {
    w.freedom.assign(kLaneBlock * block.freedoms, 0);
    for (std::size_t i = 0; i < block.panels.size(); ++i) {
      const std::uint32_t t = block.panels[i];
      Real nearest = 1e300;
      for (std::size_t k = 0; k < g.count; ++k) nearest = std::min(nearest, distance2(g.x[k], b.centroid[t]));
      const std::uint32_t* local = block.local[i].data();
      if (nearest > b.middle2[t])
        kernels.three_points(block.lane_panels[i], lane_tables(), c, w.x, local, w.freedom.data(), w.total);
      else if (nearest > b.near2[t])
        kernels.six_points(block.lane_panels[i], lane_tables(), c, w.x, nullptr, local, w.freedom.data(), w.total);
      else
        add_near_panel(b, g, t, block.lane_panels[i], local, c, kernels, w.freedom.data(), w.total);
    }
    kernels.gather(block.gather(), w.freedom.data(), w.vertex.data());
  }
  subtract_own(impl_->reconstruction, g, w);
  return w.vertex;
}

}  // namespace sherd
