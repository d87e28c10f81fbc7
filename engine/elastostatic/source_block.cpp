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
      freedom_of_(r.vertex_count() + r.slope_count(), kNone),
      vertex_of_(local_vertices ? r.vertex_count() : 0, kNone) {}

std::uint32_t SourceBlockBuilder::vertex(SourceBlock& block, std::uint32_t global) {
  return local_vertices_ ? number(global, vertex_of_, block.vertices) : global;
}

SourceBlock SourceBlockBuilder::build(std::span<const std::uint32_t> panels) {
  SourceBlock block;
  const auto vertices = static_cast<std::uint32_t>(reconstruction_.vertex_count());
  std::vector<std::uint32_t> freedoms;
  for (const std::uint32_t t : panels) {
    block.panels.push_back(t), block.lane_panels.push_back(make_lane_panel(boundary_.panels[t]));
    std::array<std::uint32_t, kPanelFreedoms> local;
    for (std::size_t a = 0; a < 3; ++a) local[a] = number(reconstruction_.nodes(t)[a], freedom_of_, freedoms);
    for (std::size_t a = 0; a < 6; ++a)
      local[3 + a] = number(vertices + reconstruction_.slopes(t)[a], freedom_of_, freedoms);
    block.local.push_back(local);
  }
  block.freedoms = freedoms.size();
  std::vector<CornerTerm> terms;
  for (std::uint32_t i = 0; i < freedoms.size(); ++i) add_freedom(block, freedoms[i], i, terms);
  std::ranges::stable_sort(terms, {}, &CornerTerm::corner);
  for (std::size_t first = 0, last = 0; first < terms.size(); first = last) {
    while (last < terms.size() && terms[last].corner == terms[first].corner) ++last;
    add_corner(block, {terms.data() + first, last - first});
  }
  for (const std::uint32_t i : freedoms) freedom_of_[i] = kNone;
  for (const std::uint32_t v : block.vertices) vertex_of_[v] = kNone;
  return block;
}

void SourceBlockBuilder::add_freedom(SourceBlock& block, std::uint32_t freedom, std::uint32_t local,
                                     std::vector<CornerTerm>& terms) {
  const Reconstruction& r = reconstruction_;
  if (freedom < r.vertex_count()) {
    block.entries.push_back({local, vertex(block, freedom), 1});
    return;
  }
  const std::uint32_t slope = freedom - static_cast<std::uint32_t>(r.vertex_count());
  for (const Reconstruction::Entry& e : r.slope_entries(slope))
    block.entries.push_back({local, vertex(block, e.vertex), e.weight});
  for (const Reconstruction::Term& t : r.slope_terms(slope)) terms.push_back({t.corner, {local, t.x, t.y, t.z}});
}

void SourceBlockBuilder::add_corner(SourceBlock& block, std::span<const CornerTerm> terms) {
  const Reconstruction& r = reconstruction_;
  const std::uint32_t corner = terms.front().corner;
  LaneGather::Corner out{};
  out.first_term = size32(block.terms), out.first_gradient = size32(block.gradients);
  for (const CornerTerm& t : terms) block.terms.push_back(t.term);
  for (const Reconstruction::GradientEntry& g : r.gradient(corner))
    block.gradients.push_back({vertex(block, g.vertex), g.x, g.y});
  out.last_term = size32(block.terms), out.last_gradient = size32(block.gradients);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      out.frame_x[3 * i + j] = r.frame(corner).x[i][j], out.frame_y[3 * i + j] = r.frame(corner).y[i][j];
  block.corners.push_back(out);
}

}  // namespace sherd
