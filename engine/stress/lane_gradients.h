// Displacement gradients at eight targets at a time, summed over chunks of sources: few targets keep all threads busy
// too. Internal to the stress stage.
#pragma once
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "engine/elastostatic/lane_targets.h"
#include "kernels/core/parallel.h"
#include "kernels/core/symmetric.h"

namespace sherd {

// Entry i of the gradient of lane k at [i * kLanes + k].
using LaneGradients = std::array<double, 9 * kLanes>;

inline std::size_t lane_groups(std::size_t targets) {
  return (targets + kLanes - 1) / kLanes;
}
inline std::span<const std::uint32_t> lane_group(std::span<const std::uint32_t> targets, std::size_t group) {
  return targets.subspan(group * kLanes, std::min(kLanes, targets.size() - group * kLanes));
}

// done(group, sum) with the sum of add(group, chunk, sum) over all chunks, in their order. The same bits for any number
// of threads and of groups.
template <class Add, class Done>
void sum_lanes(std::size_t groups, std::size_t chunks, const Add& add, const Done& done) {
  constexpr std::size_t kManyGroups = 16;  // enough for the threads of any machine that such small sums are for
  std::vector<LaneGradients> part(groups < kManyGroups ? groups * chunks : 0);
  parallel_for(part.size(), 1, [&](std::size_t i) {
    part[i].fill(0);
    add(i / chunks, i % chunks, part[i]);
  });
  parallel_for(groups, 1, [&](std::size_t group) {
    LaneGradients sum{}, own;
    for (std::size_t c = 0; c < chunks; ++c) {
      LaneGradients& p = part.empty() ? own : part[group * chunks + c];
      if (part.empty()) own.fill(0), add(group, c, own);
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += p[i];
    }
    done(group, sum);
  });
}

inline Mat3 lane(const LaneGradients& g, std::size_t k) {
  Mat3 m;
  for (std::size_t i = 0; i < 9; ++i) m.m[i / 3][i % 3] = g[i * kLanes + k];
  return m;
}

}  // namespace sherd
