#include "engine/elastostatic/source_block.h"

#include <algorithm>

#include "kernels/quadrature/gauss.h"

namespace sherd {
namespace {

void copy(const Vec3& v, double* out) {
  for (int k = 0; k < 3; ++k) out[k] = v[k];
}

LanePanel make_lane_panel(const PanelFrame& f) {
  LanePanel p;
  const auto at = [&](const TrianglePoint& g) { return f.vertex[0] * g.a + f.vertex[1] * g.b + f.vertex[2] * g.c; };
  for (std::size_t q = 0; q < 3; ++q) copy(at(kGauss3[q]), p.three[q]);
  for (std::size_t q = 0; q < 6; ++q) copy(at(kGauss6[q]), p.six[q]);
  copy(f.normal, p.normal), copy(f.shape_gradient(1), p.gradient_s), copy(f.shape_gradient(2), p.gradient_t);
  p.area = f.area;
  return p;
}

std::uint32_t number(std::uint32_t global, std::vector<std::uint32_t>& of, std::vector<std::uint32_t>& list) {
  if (of[global] == kNone) of[global] = static_cast<std::uint32_t>(list.size()), list.push_back(global);
  return of[global];
}

template <class T>
std::uint32_t size32(const std::vector<T>& v) {
  return static_cast<std::uint32_t>(v.size());
}

}  // namespace

SourceBlockBuilder::SourceBlockBuilder(const Boundary& b, const Reconstruction& r, bool local_vertices)
    : boundary_(b),
      reconstruction_(r),
      local_vertices_(local_vertices),
      node_of_(r.node_count(), kNone),
      corner_of_(r.corner_count(), kNone),
      vertex_of_(local_vertices ? r.vertex_count() : 0, kNone) {}

std::uint32_t SourceBlockBuilder::vertex(SourceBlock& block, std::uint32_t global) {
  return local_vertices_ ? number(global, vertex_of_, block.vertices) : global;
}

SourceBlock SourceBlockBuilder::build(std::span<const std::uint32_t> panels) {
  SourceBlock block;
  std::vector<std::uint32_t> nodes, corners;
  for (const std::uint32_t t : panels) {
    block.panels.push_back(t), block.lane_panels.push_back(make_lane_panel(boundary_.panels[t]));
    std::array<std::uint32_t, cubic::kNodes> local;
    for (std::size_t a = 0; a < cubic::kNodes; ++a) local[a] = number(reconstruction_.nodes(t)[a], node_of_, nodes);
    block.local.push_back(local);
  }
  for (const std::uint32_t node : nodes) add_node(block, node, corners);
  for (const std::uint32_t c : corners) add_corner(block, c);
  for (const std::uint32_t node : nodes) node_of_[node] = kNone;
  for (const std::uint32_t c : corners) corner_of_[c] = kNone;
  for (const std::uint32_t v : block.vertices) vertex_of_[v] = kNone;
  return block;
}

void SourceBlockBuilder::add_node(SourceBlock& block, std::uint32_t node, std::vector<std::uint32_t>& corners) {
  const Reconstruction& r = reconstruction_;
  LaneGather::Node out{};
  out.first_entry = size32(block.entries), out.first_term = size32(block.terms);
  out.vertex = kNone;
  if (node < r.vertex_count())
    out.vertex = vertex(block, node);
  else {
    for (const Reconstruction::Entry& e : r.entries(node)) block.entries.push_back({vertex(block, e.vertex), e.weight});
    for (const Reconstruction::Term& t : r.terms(node))
      block.terms.push_back({number(t.corner, corner_of_, corners), t.x, t.y, t.z});
  }
  out.last_entry = size32(block.entries), out.last_term = size32(block.terms);
  block.nodes.push_back(out);
}

void SourceBlockBuilder::add_corner(SourceBlock& block, std::uint32_t corner) {
  const Reconstruction& r = reconstruction_;
  LaneGather::Corner out{};
  out.first = size32(block.gradients);
  for (const Reconstruction::GradientEntry& g : r.gradient(corner))
    block.gradients.push_back({vertex(block, g.vertex), g.x, g.y});
  out.last = size32(block.gradients);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      out.frame_x[3 * i + j] = r.frame(corner).x[i][j], out.frame_y[3 * i + j] = r.frame(corner).y[i][j];
  block.corners.push_back(out);
}

}  // namespace sherd
