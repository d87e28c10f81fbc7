// Displacement gradient of the tractions of contact patches: thousands of small panels on a vessel at rest.
#pragma once
#include <span>

#include "engine/elastostatic/boundary.h"
#include "engine/load/load.h"
#include "kernels/fundamental/elastic.h"

namespace sherd {

class LoadGradients {
 public:
  LoadGradients(const TractionPanels& panels, const Elastic& material, const QuadratureOptions& options);
  // Adds [i][k] = u_i,k (no unit), one a point, at points that lie on no panel, or on its edges clamped. Each panel as
  // layer_gradient.h has it, those that are far from eight points at once in vector registers. Parallel; the same bits
  // for any number of threads.
  void add(const Vec3Column& x, std::span<Mat3> out) const;

 private:
  std::vector<PanelFrame> panels_;
  Vec3Column centroid_, traction_, position_, force_;  // three points a panel
  std::vector<Real> reach_;                            // from the centroid, within which three points do not do, m
  std::vector<Real> zeros_;
  Elastic material_;
  QuadratureOptions options_;
};

}  // namespace sherd
