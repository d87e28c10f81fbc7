#include "engine/stress/load_gradients.h"

#include <numeric>

#include "engine/stress/lane_gradients.h"
#include "engine/stress/layer_gradient.h"
#include "kernels/quadrature/gauss.h"

namespace sherd {
namespace {

constexpr std::size_t kChunk = 256;  // panels

}  // namespace

LoadGradients::LoadGradients(const TractionPanels& panels, const Elastic& material, const QuadratureOptions& options)
    : traction_(panels.traction), material_(material), options_(options) {
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const auto& [a, b, c] = panels.corners[i];
    const PanelFrame f = make_panel(a, b, c);
    for (const TrianglePoint& p : kGauss3) {
      position_.push_back(f.vertex[0] * p.a + f.vertex[1] * p.b + f.vertex[2] * p.c);
      force_.push_back(traction_[i] * (p.weight * f.area));
    }
    centroid_.push_back(f.centroid());
    reach_.push_back(options.gauss7 * std::sqrt(f.longest2));
    panels_.push_back(f);
  }
  zeros_.assign(position_.size(), 0);
}

void LoadGradients::add(const Vec3Column& x, std::span<Mat3> out) const {
  if (panels_.empty()) return;
  std::vector<std::uint32_t> all(x.size());
  std::iota(all.begin(), all.end(), 0u);
  const auto add_far = [&](const LaneTargets& targets, std::size_t begin, std::size_t end, LaneGradients& sum) {
    if (begin == end) return;
    const std::size_t first = 3 * begin;
    const double* zero = zeros_.data();
    const LaneElements s{{position_.x.data() + first, position_.y.data() + first, position_.z.data() + first},
                         {force_.x.data() + first, force_.y.data() + first, force_.z.data() + first},
                         {zero, zero, zero},
                         {zero, zero, zero, zero, zero, zero, zero, zero, zero},
                         {zero, zero, zero},
                         3 * (end - begin)};
    lane_kernels().gradient_sum(s, material_.kelvin(), 3 - 4 * material_.nu, 0, targets.x, sum.data());
  };
  const auto add_chunk = [&](std::size_t group, std::size_t chunk, LaneGradients& sum) {
    const LaneTargets targets(x, lane_group(all, group));
    const Vec3 centre = targets.box.centre();
    const Real radius = 0.5 * targets.box.diagonal();
    const std::size_t last = std::min((chunk + 1) * kChunk, panels_.size());
    std::size_t begin = chunk * kChunk;  // of a run of panels that are far from all of the targets
    for (std::size_t i = begin; i < last; ++i) {
      const Real d = reach_[i] + radius;
      if (distance2(centre, centroid_[i]) > d * d) continue;
      add_far(targets, begin, i, sum);
      begin = i + 1;
      for (std::size_t k = 0; k < targets.count; ++k) {
        const Mat3 g = layer_gradient(panels_[i], targets.target(k), traction_[i], material_, options_).kelvin;
        for (std::size_t j = 0; j < 9; ++j) sum[j * kLanes + k] += g.m[j / 3][j % 3];
      }
    }
    add_far(targets, begin, last, sum);
  };
  sum_lanes(lane_groups(x.size()), (panels_.size() + kChunk - 1) / kChunk, add_chunk,
            [&](std::size_t group, const LaneGradients& sum) {
              const auto points = lane_group(all, group);
              for (std::size_t k = 0; k < points.size(); ++k) out[points[k]] += lane(sum, k);
            });
}

}  // namespace sherd
