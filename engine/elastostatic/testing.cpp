#include "engine/elastostatic/testing.h"

#include <algorithm>
#include <map>

#include "kernels/core/parallel.h"
#include "kernels/quadrature/gauss.h"

namespace sherd {

Testing::Testing(const Boundary& boundary, const Reconstruction& reconstruction, const std::vector<bool>& galerkin)
    : boundary_(boundary), reconstruction_(reconstruction), galerkin_(galerkin) {
  for (std::uint32_t v = 0; v < galerkin_.size(); ++v)
    if (!galerkin_[v]) collocated_.push_back(v);
  if (collocated_.size() == galerkin_.size()) return;
  // A panel is needed when a Petrov-Galerkin row's shape function reaches it.
  std::vector<char> needed(boundary.panels.size(), 0);
  parallel_for(needed.size(), 64, [&](std::size_t t) {
    for (const std::uint32_t node : reconstruction_.nodes(t))
      for (const auto& [v, block] : reconstruction_.row(node)) needed[t] = needed[t] || galerkin_[v];
  });
  for (std::uint32_t t = 0; t < needed.size(); ++t)
    if (needed[t]) panels_.push_back(t);
}

std::size_t Testing::galerkin_count() const {
  return galerkin_.size() - collocated_.size();
}

TargetGroup Testing::group(std::size_t i) const {
  TargetGroup g;
  if (i < vertex_groups()) {
    g.count = std::min(kLanes, collocated_.size() - i * kLanes);
    for (std::size_t k = 0; k < g.count; ++k) {
      g.vertex[k] = collocated_[i * kLanes + k];
      g.x[k] = boundary_.mesh.vertices[g.vertex[k]];
    }
    return g;
  }
  g.count = kPoints, g.panel = panels_[i - vertex_groups()];
  const PanelFrame& f = boundary_.panels[g.panel];
  for (std::size_t k = 0; k < kPoints; ++k) {
    const TrianglePoint& p = kGauss6[k];
    g.vertex[k] = kNone, g.s[k] = p.b, g.t[k] = p.c;
    g.x[k] = f.vertex[0] * p.a + f.vertex[1] * p.b + f.vertex[2] * p.c;
  }
  return g;
}

std::vector<Testing::Weight> Testing::weights(std::uint32_t panel) const {
  std::map<std::uint32_t, std::array<Mat3, kPoints>> sum;
  for (std::size_t a = 0; a < cubic::kNodes; ++a) {
    std::array<Real, kPoints> shape;
    for (std::size_t k = 0; k < kPoints; ++k) shape[k] = cubic::evaluate(cubic::kShape[a], kGauss6[k].b, kGauss6[k].c);
    for (const auto& [v, block] : reconstruction_.row(reconstruction_.nodes(panel)[a])) {
      if (!galerkin_[v]) continue;
      const Mat3 test = transpose(block) * (boundary_.panels[panel].area / boundary_.vertex_area[v]);
      auto& at = sum[v];
      for (std::size_t k = 0; k < kPoints; ++k) at[k] += test * (shape[k] * kGauss6[k].weight);
    }
  }
  std::vector<Weight> out;
  for (const auto& [v, block] : sum) out.push_back({v, block});
  return out;
}

Vec3Column Testing::points() const {
  Vec3Column out;
  for (const std::uint32_t v : collocated_) out.push_back(boundary_.mesh.vertices[v]);
  for (std::size_t i = 0; i < panels_.size(); ++i) {
    const TargetGroup g = group(vertex_groups() + i);
    for (std::size_t k = 0; k < kPoints; ++k) out.push_back(g.x[k]);
  }
  return out;
}

Vec3Column Testing::apply(const Vec3Column& values) const {
  Vec3Column rows(galerkin_.size());
  for (std::size_t i = 0; i < collocated_.size(); ++i) rows.set(collocated_[i], values[i]);
  for (std::size_t i = 0; i < panels_.size(); ++i)
    for (const Weight& w : weights(panels_[i]))
      for (std::size_t k = 0; k < kPoints; ++k)
        rows.add(w.vertex, w.block[k] * values[collocated_.size() + kPoints * i + k]);
  return rows;
}

}  // namespace sherd
