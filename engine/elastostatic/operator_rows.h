// Rows of the direct formulation's operator over the vertices, for any point of the surface:
//   r(x) = D[u - u(x)] + 2 mu V_E[M u] - V_L[M u]
// with u the reconstructed displacement (see dense_operator.h for the letters). Near panels in closed form, far ones by
// Gauss rules whose weights are exact for the product of the shape functions with a linear kernel.
#pragma once
#include <memory>
#include <span>

#include "engine/elastostatic/boundary.h"
#include "engine/elastostatic/lane_kernels.h"
#include "engine/elastostatic/reconstruction.h"

namespace sherd {

// Targets are evaluated eight at a time, one a SIMD lane.
struct TargetGroup {
  std::size_t count = 0;  // lanes in use; the others repeat the first
  std::array<Vec3, kLanes> x;
  std::array<std::uint32_t, kLanes> vertex;  // the vertex each target is, or kNone and then
  std::array<std::uint32_t, kLanes> panel;   // the panel it lies in, at
  std::array<Real, kLanes> s{}, t{};         // these coordinates (moments.h)
};

class OperatorRows {
 public:
  OperatorRows(const Boundary& boundary, const Reconstruction& reconstruction, Real nu);
  ~OperatorRows();

  struct Workspace;
  std::shared_ptr<Workspace> make_workspace() const;  // one per thread at a time; given back, it serves again
  // Into `out`, one lane block (lane_kernels.h) a vertex: entry (i, j) of lane k is what component j there adds to
  // component i at target k.
  void evaluate(const TargetGroup& targets, Workspace& workspace, std::span<double> out) const;
  // The same into the workspace: valid until it is used again.
  std::span<const double> evaluate(const TargetGroup& targets, Workspace& workspace) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sherd
