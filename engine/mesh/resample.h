// Corner channels on new triangles over an old surface, and where they jump.
#pragma once
#include "engine/mesh/bvh.h"

namespace sherd {

// Chart of each triangle: connected over edges across which no channel jumps (by more than 1e-5 of its range) and the
// columns kind, crack and material agree. Numbered in order of first triangle; empty for a mesh without channels.
std::vector<std::uint32_t> label_charts(const SurfaceMesh& mesh);

// One number for all triangles between whose kinds no line must vanish: same kind, crack, material and, for charts of
// more than `least_chart` (m^2), same chart. Smaller charts would leave a remesher nothing but lines. `seams` false: no
// charts at all.
std::vector<std::uint32_t> label_regions(const SurfaceMesh& mesh, bool seams, Real least_chart);

class ChannelSampler {
 public:
  // Both must outlive the sampler; `bvh` is of `from`.
  ChannelSampler(const SurfaceMesh& from, const TriangleBvh& bvh);

  // Appends the values of a triangle with corners `at` that lies on or near `face`: each corner takes the value of the
  // closest point in the chart of `face`, so that nothing is mixed across a seam.
  void append(std::uint32_t face, const std::array<Vec3, 3>& at, SurfaceMesh& to) const;

 private:
  const SurfaceMesh& from_;
  const TriangleBvh& bvh_;
  std::vector<std::uint32_t> chart_;
};

// Channels of `to`, all sampled from `from`: each triangle lies in the chart closest to its centroid.
void resample_channels(const SurfaceMesh& from, SurfaceMesh& to);

}  // namespace sherd
