// Where the integral equation is tested, and how its residual becomes one vector equation a vertex. Collocation asks
// for r(x_v) = 0 at the vertex. Petrov-Galerkin asks for the mean of r against the reconstructed shape function of the
// vertex: sum over panels and six Gauss points each of w N_v(x)^T r(x) / a_v = 0 (three points a panel err by 20 to 30
// % on plates some forty walls wide, measured). Collocation samples the residual exactly where the interpolation error
// vanishes, which bending of thin walls turns into tens of percent; averaging it removes that (design notes, thin-walls
// sections 0 and 1). Rows may be mixed: both are scaled alike.
#pragma once
#include "engine/elastostatic/boundary.h"
#include "engine/elastostatic/operator_rows.h"

namespace sherd {

// How each vertex is tested.
enum class VertexTest : std::uint8_t { kCollocation, kGalerkin };

class Testing {
 public:
  struct Point {
    std::uint32_t panel;
    Real s, t;    // coordinates in the panel (moments.h)
    Real weight;  // of the rule times the panel's area, m^2
  };

  // Gauss points lie on every panel that the shape function of a kGalerkin vertex reaches.
  Testing(const Boundary& boundary, const Reconstruction& reconstruction, const std::vector<VertexTest>& tests);

  bool galerkin(std::size_t vertex) const { return tests_[vertex] != VertexTest::kCollocation; }
  std::size_t galerkin_count() const { return tests_.size() - collocated_.size(); }
  const std::vector<std::uint32_t>& collocated() const { return collocated_; }  // vertices, ascending
  const std::vector<Point>& gauss_points() const { return gauss_; }             // neighbours in the list are neighbours

  // Targets in eights: of the collocated vertices, of the Gauss points.
  std::size_t vertex_groups() const { return (collocated_.size() + kLanes - 1) / kLanes; }
  std::size_t gauss_groups() const { return (gauss_.size() + kLanes - 1) / kLanes; }
  TargetGroup vertex_group(std::size_t i) const;
  TargetGroup gauss_group(std::size_t i) const;

  // Right-hand sides: all target points, collocated vertices first, and from values there to rows.
  Vec3Column points() const;
  Vec3Column apply(const Vec3Column& values) const;

 private:
  const Boundary& boundary_;
  const Reconstruction& reconstruction_;
  std::vector<VertexTest> tests_;
  std::vector<std::uint32_t> collocated_;
  std::vector<Point> gauss_;
};

}  // namespace sherd
