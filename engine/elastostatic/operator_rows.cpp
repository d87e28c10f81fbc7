#include "engine/elastostatic/operator_rows.h"

#include <algorithm>
#include <mutex>

#include "engine/elastostatic/panel_rows.h"
#include "engine/elastostatic/panel_search.h"
#include "engine/elastostatic/source_block.h"
#include "kernels/core/aligned.h"

namespace sherd {
namespace {

constexpr std::size_t kBlockPanels = 128;

// What a target in a panel subtracts of itself: its shape functions over the vertices. Six neighbours in a list of
// targets lie in one panel, so the last panel's is kept.
class OwnRow {
 public:
  struct Entry {
    std::uint32_t vertex;
    std::array<Mat3, cubic::kNodes> node;
  };
  const std::vector<Entry>& of(const Reconstruction& r, std::uint32_t panel) {
    if (panel == panel_) return entries_;
    panel_ = panel, entries_.clear();
    for (std::size_t a = 0; a < cubic::kNodes; ++a)
      for (const auto& [v, block] : r.row(r.nodes(panel)[a])) {
        auto at = std::ranges::find(entries_, v, &Entry::vertex);
        if (at == entries_.end()) at = entries_.insert(at, {v, {}});
        at->node[a] = block;
      }
    return entries_;
  }

 private:
  std::uint32_t panel_ = kNone;
  std::vector<Entry> entries_;
};

}  // namespace

struct OperatorRows::Workspace {
  AlignedNumbers freedom, vertex;
  alignas(64) double x[3 * kLanes], total[kLanes];
  OwnRow own;
};

struct OperatorRows::Impl {
  const Boundary& boundary;
  const Reconstruction& reconstruction;
  LaneConstants constants;
  const LaneKernels& kernels = lane_kernels();
  std::vector<SourceBlock> blocks;
  // Workspaces between uses: fresh memory costs as much as what is computed in it.
  std::mutex lending;
  std::vector<std::unique_ptr<Workspace>> idle;

  Impl(const Boundary& b, const Reconstruction& r, Real nu)
      : boundary(b), reconstruction(r), constants(lane_constants(nu)) {
    const std::vector<std::uint32_t> order = along_curve(b.centroid);
    SourceBlockBuilder builder(b, r, false);
    for (std::size_t first = 0; first < order.size(); first += kBlockPanels)
      blocks.push_back(builder.build({order.data() + first, std::min(kBlockPanels, order.size() - first)}));
  }
};

OperatorRows::OperatorRows(const Boundary& boundary, const Reconstruction& reconstruction, Real nu)
    : impl_(std::make_unique<Impl>(boundary, reconstruction, nu)) {}
OperatorRows::~OperatorRows() = default;

std::shared_ptr<OperatorRows::Workspace> OperatorRows::make_workspace() const {
  Impl& impl = *impl_;
  const std::lock_guard lock(impl.lending);
  std::unique_ptr<Workspace> lent;
  if (impl.idle.empty())
    lent = std::make_unique<Workspace>();
  else
    lent = std::move(impl.idle.back()), impl.idle.pop_back();
  return {lent.release(), [&impl](Workspace* w) {
            const std::lock_guard give_back(impl.lending);
            impl.idle.emplace_back(w);
          }};
}

namespace {

// The term - u(x) D[1](x), u(x) the vertex value or the shape functions at a point of a panel.
void subtract_own(const Reconstruction& r, const TargetGroup& g, OperatorRows::Workspace& w, std::span<double> out) {
  for (std::size_t k = 0; k < g.count; ++k) {
    if (g.vertex[k] != kNone) {
      for (std::size_t i = 0; i < 3; ++i) out[kLaneBlock * g.vertex[k] + 4 * i * kLanes + k] -= w.total[k];
      continue;
    }
    Real weight[cubic::kNodes];
    for (std::size_t a = 0; a < cubic::kNodes; ++a)
      weight[a] = w.total[k] * cubic::evaluate(cubic::kShape[a], g.s[k], g.t[k]);
    for (const OwnRow::Entry& e : w.own.of(r, g.panel[k])) {
      Mat3 sum;
      for (std::size_t a = 0; a < cubic::kNodes; ++a) sum += e.node[a] * weight[a];
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) out[kLaneBlock * e.vertex + (3 * i + j) * kLanes + k] -= sum.m[i][j];
    }
  }
}

}  // namespace

void OperatorRows::evaluate(const TargetGroup& g, Workspace& w, std::span<double> out) const {
  const Boundary& b = impl_->boundary;
  const LaneConstants& c = impl_->constants;
  const LaneKernels& kernels = impl_->kernels;
  for (std::size_t k = 0; k < kLanes; ++k)
    for (int i = 0; i < 3; ++i) w.x[static_cast<std::size_t>(i) * kLanes + k] = g.x[k < g.count ? k : 0][i];
  std::ranges::fill(out, 0);
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
    kernels.gather(block.gather(), w.freedom.data(), out.data());
  }
  subtract_own(impl_->reconstruction, g, w, out);
}

std::span<const double> OperatorRows::evaluate(const TargetGroup& g, Workspace& w) const {
  w.vertex.resize(kLaneBlock * impl_->reconstruction.vertex_count());
  evaluate(g, w, w.vertex);
  return w.vertex;
}

}  // namespace sherd
