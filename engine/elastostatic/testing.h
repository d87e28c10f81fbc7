// Where the integral equation is tested, and how its residual becomes one vector equation a vertex. Collocation asks
// for r(x_v) = 0 at the vertex. Petrov-Galerkin asks for the mean of r against the reconstructed shape function of the
// vertex: sum over panels and Gauss points of w N_v(x)^T r(x) / a_v = 0. Collocation samples the residual exactly where
// the interpolation error vanishes, which bending of thin walls turns into tens of percent; averaging it removes that
// (design notes, thin-walls sections 0 and 1). Rows may be mixed: both are scaled alike.
#pragma once
#include "engine/elastostatic/boundary.h"
#include "engine/elastostatic/operator_rows.h"

namespace sherd {

class Testing {
 public:
  static constexpr std::size_t kPoints = 6;  // Gauss points a panel

  // galerkin: per vertex, true for a Petrov-Galerkin row.
  Testing(const Boundary& boundary, const Reconstruction& reconstruction, const std::vector<bool>& galerkin);

  std::size_t vertex_count() const { return galerkin_.size(); }
  bool galerkin(std::size_t vertex) const { return galerkin_[vertex]; }
  std::size_t galerkin_count() const;
  const std::vector<std::uint32_t>& collocated() const { return collocated_; }  // vertices, ascending
  const std::vector<std::uint32_t>& panels() const { return panels_; }          // whose points are targets, ascending

  // Groups of targets: collocated vertices in eights, then one group a panel of panels().
  std::size_t group_count() const { return vertex_groups() + panels_.size(); }
  std::size_t vertex_groups() const { return (collocated_.size() + kLanes - 1) / kLanes; }
  TargetGroup group(std::size_t i) const;

  // What the values at a panel's points add to each Petrov-Galerkin row they reach.
  struct Weight {
    std::uint32_t vertex;
    std::array<Mat3, kPoints> block;
  };
  std::vector<Weight> weights(std::uint32_t panel) const;

  // Right-hand sides: all target points (vertex groups first, then panels) and from values there to rows.
  Vec3Column points() const;
  Vec3Column apply(const Vec3Column& values) const;

 private:
  const Boundary& boundary_;
  const Reconstruction& reconstruction_;
  std::vector<bool> galerkin_;
  std::vector<std::uint32_t> collocated_, panels_;
};

}  // namespace sherd
