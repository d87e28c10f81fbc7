// Displacement on the triangles from displacement at the vertices: each flat triangle carries ten cubic nodes whose
// values follow from vertex values and fitted vertex gradients (design notes, thin-walls section 7, steps 1 to 5). The
// unknowns stay the vertices; bending of thin walls, which linear triangles lock, is resolved. Rigid motions and, where
// the surface is free of traction, affine fields are reproduced to rounding on any polyhedron, quadratic fields on flat
// faces wider than one element.
#pragma once
#include <span>

#include "engine/mesh/surface_fit.h"
#include "kernels/quadrature/cubic.h"

namespace sherd {

enum class Element { kLinear, kCubic };

struct ReconstructionOptions {
  Element element = Element::kCubic;
  Real feature_angle = 35;  // degrees; creases break the fits but not the displacement
  FitOptions fit;
};

class Reconstruction {
 public:
  // The values at a node: sum of weight * u(vertex) plus, for each term, what the gradients g1, g2 (along the axes) of
  // a corner's fit add: (x I + z Frame::x) g1 + (y I + z Frame::y) g2.
  struct Term {
    std::uint32_t corner;
    Real x, y, z;
  };
  // Derivative of u along the inward normal where the surface is free of traction: Frame::x g1 + Frame::y g2. It moves
  // values from the fitted surface onto the flat triangles.
  struct Frame {
    Mat3 x, y;
  };
  struct Entry {
    std::uint32_t vertex;
    Real weight;
  };
  struct GradientEntry {
    std::uint32_t vertex;
    Real x, y;
  };

  Reconstruction(const SurfaceMesh& mesh, Real nu, const ReconstructionOptions& options);

  std::size_t vertex_count() const { return vertices_; }
  // Vertices come first: node v < vertex_count() is vertex v.
  std::size_t node_count() const { return vertices_ + node_entries_.size() - 1; }
  const std::array<std::uint32_t, cubic::kNodes>& nodes(std::size_t t) const { return nodes_[t]; }
  // Of a node that is not a vertex.
  std::span<const Entry> entries(std::uint32_t node) const;
  std::span<const Term> terms(std::uint32_t node) const;
  // The same elements by their vertices and slopes (cubic::kHermite): the six slopes of triangle t, and what a slope,
  // the derivative along an edge times its length, is made of. Both triangles of an edge share its two slopes.
  std::size_t slope_count() const { return slope_entries_.size() - 1; }
  const std::array<std::uint32_t, 6>& slopes(std::size_t t) const { return slopes_[t]; }
  std::span<const Entry> slope_entries(std::uint32_t slope) const;
  std::span<const Term> slope_terms(std::uint32_t slope) const;
  std::size_t corner_count() const { return frames_.size(); }
  const Frame& frame(std::uint32_t corner) const { return frames_[corner]; }
  std::span<const GradientEntry> gradient(std::uint32_t corner) const;

  // Node values of a vertex field.
  void apply(const Vec3Column& vertex_values, Vec3Column& node_values) const;
  // Its transpose: vertex loads of node loads.
  Vec3Column apply_transpose(const Vec3Column& node_values) const;
  // A node's value as 3x3 blocks over vertices, ascending; any node.
  std::vector<std::pair<std::uint32_t, Mat3>> row(std::uint32_t node) const;

 private:
  void add_edge_nodes(const SurfaceMesh& mesh, const SurfaceCorners& corners, const std::vector<SurfaceFit>& fits);
  void add_centres(const SurfaceMesh& mesh);
  void add_linear_nodes(const SurfaceMesh& mesh);
  void close_node();
  std::uint32_t close_slope();

  std::size_t vertices_;
  std::vector<std::array<std::uint32_t, cubic::kNodes>> nodes_;
  std::vector<std::array<std::uint32_t, 6>> slopes_;
  std::vector<std::size_t> node_entries_{0}, node_terms_{0};  // first entry, first term of a node
  std::vector<Entry> entries_;
  std::vector<Term> terms_;
  std::vector<std::size_t> slope_entries_{0}, slope_terms_{0};  // first entry, first term of a slope
  std::vector<Entry> entries_of_slopes_;
  std::vector<Term> terms_of_slopes_;
  std::vector<Frame> frames_;
  std::vector<std::size_t> first_gradient_{0};
  std::vector<GradientEntry> gradients_;
};

}  // namespace sherd
