#include "engine/elastostatic/testing.h"

#include <algorithm>

#include "engine/elastostatic/panel_search.h"
#include "kernels/core/parallel.h"
#include "kernels/quadrature/gauss.h"

namespace sherd {

Testing::Testing(const Boundary& boundary, const Reconstruction& reconstruction, const std::vector<VertexTest>& tests)
    : boundary_(boundary), reconstruction_(reconstruction), tests_(tests) {
  for (std::uint32_t v = 0; v < tests_.size(); ++v)
    if (!galerkin(v)) collocated_.push_back(v);
  if (collocated_.size() == tests_.size()) return;
  std::vector<char> tested(boundary.panels.size(), 0);
  const Reconstruction& r = reconstruction;
  parallel_for(tested.size(), 64, [&](std::size_t t) {
    const auto see = [&](std::uint32_t v) { tested[t] |= galerkin(v); };
    for (const std::uint32_t node : r.nodes(t)) {
      if (node < r.vertex_count()) {
        see(node);
        continue;
      }
      for (const Reconstruction::Entry& e : r.entries(node)) see(e.vertex);
      for (const Reconstruction::Term& m : r.terms(node))
        for (const Reconstruction::GradientEntry& g : r.gradient(m.corner)) see(g.vertex);
    }
  });
  std::vector<std::uint32_t> panels;
  for (std::uint32_t t = 0; t < tested.size(); ++t)
    if (tested[t]) panels.push_back(t);
  for (const std::uint32_t t : along_curve(boundary.centroid, std::move(panels))) {
    for (const TrianglePoint& p : kGauss6) gauss_.push_back({t, p.b, p.c, p.weight * boundary.panels[t].area});
  }
}

TargetGroup Testing::vertex_group(std::size_t i) const {
  TargetGroup g;
  g.count = std::min(kLanes, collocated_.size() - i * kLanes);
  for (std::size_t k = 0; k < g.count; ++k) {
    g.vertex[k] = collocated_[i * kLanes + k], g.panel[k] = kNone;
    g.x[k] = boundary_.mesh.vertices[g.vertex[k]];
  }
  return g;
}

TargetGroup Testing::gauss_group(std::size_t i) const {
  TargetGroup g;
  g.count = std::min(kLanes, gauss_.size() - i * kLanes);
  for (std::size_t k = 0; k < g.count; ++k) {
    const Point& p = gauss_[i * kLanes + k];
    const PanelFrame& f = boundary_.panels[p.panel];
    g.vertex[k] = kNone, g.panel[k] = p.panel, g.s[k] = p.s, g.t[k] = p.t;
    g.x[k] = f.vertex[0] * (1 - p.s - p.t) + f.vertex[1] * p.s + f.vertex[2] * p.t;
  }
  return g;
}

Vec3Column Testing::points() const {
  Vec3Column out;
  for (const std::uint32_t v : collocated_) out.push_back(boundary_.mesh.vertices[v]);
  for (std::size_t i = 0; i < gauss_groups(); ++i) {
    const TargetGroup g = gauss_group(i);
    for (std::size_t k = 0; k < g.count; ++k) out.push_back(g.x[k]);
  }
  return out;
}

Vec3Column Testing::apply(const Vec3Column& values) const {
  Vec3Column nodes(gauss_.empty() ? 0 : reconstruction_.node_count());
  for (std::size_t i = 0; i < gauss_.size(); ++i) {
    const Point& p = gauss_[i];
    for (std::size_t a = 0; a < cubic::kNodes; ++a)
      nodes.add(reconstruction_.nodes(p.panel)[a],
                values[collocated_.size() + i] * (p.weight * cubic::evaluate(cubic::kShape[a], p.s, p.t)));
  }
  Vec3Column rows(tests_.size());
  if (!gauss_.empty()) {
    const Vec3Column means = reconstruction_.apply_transpose(nodes);
    for (std::size_t v = 0; v < tests_.size(); ++v)
      if (galerkin(v)) rows.set(v, means[v] / boundary_.vertex_area[v]);
  }
  for (std::size_t i = 0; i < collocated_.size(); ++i) rows.set(collocated_[i], values[i]);
  return rows;
}

}  // namespace sherd
