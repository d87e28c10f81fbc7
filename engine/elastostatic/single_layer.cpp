#include "engine/elastostatic/single_layer.h"

#include "engine/elastostatic/force_layer.h"
#include "engine/elastostatic/panel_search.h"
#include "kernels/core/parallel.h"

namespace sherd {
namespace {

using force_layer::Density, force_layer::Lanes, force_layer::Layer, force_layer::from_nodes;

// Pairs of targets and far sources from which on the fast multipole method is used: about a second of direct sums on
// one core.
constexpr double kFastPairs = 2e9;

// The panels that carry the load, in order along a curve, so that those far from a target are runs.
Layer make_layer(const Boundary& b, const Load& load, const ParticularSolution& particular, const Elastic& m,
                 const QuadratureOptions& options) {
  const std::size_t contacts = load.panels.size();
  const bool everywhere_loaded = !particular.zero() || !load.face_traction.empty() || !load.quadratic_traction.empty();
  std::vector<PanelFrame> frames;
  Vec3Column centroid;
  for (const auto& c : load.panels.corners) frames.push_back(make_panel(c[0], c[1], c[2]));
  if (everywhere_loaded) frames.insert(frames.end(), b.panels.begin(), b.panels.end());
  for (const PanelFrame& f : frames) centroid.push_back(f.centroid());
  Layer layer;
  layer.material = m;
  for (const std::uint32_t i : along_curve(centroid))
    if (i < contacts)
      layer.add(frames[i], {load.panels.traction[i]}, true, options);
    else
      layer.add(frames[i], traction_polynomial(b, load, particular, i - contacts), false, options);
  return layer;
}

}  // namespace

Density traction_polynomial(const Boundary& b, const Load& load, const ParticularSolution& particular, std::size_t t) {
  std::array<Vec3, 6> value{};
  const PanelFrame& f = b.panels[t];
  if (!load.quadratic_traction.empty())
    for (std::size_t k = 0; k < 6; ++k) value[k] = load.quadratic_traction[6 * t + k];
  if (!particular.zero())
    for (std::size_t k = 0; k < 3; ++k) {
      value[k] -= particular.stress(f.vertex[k]) * f.normal;
      value[3 + k] -= particular.stress((f.vertex[k] + f.vertex[(k + 1) % 3]) * 0.5) * f.normal;
    }
  Density q = from_nodes(value);
  if (!load.face_traction.empty()) q[0] += load.face_traction[t];
  return q;
}

Vec3Column load_potential(const Boundary& b, const Load& load, const ParticularSolution& particular, const Elastic& m,
                          const QuadratureOptions& options, const Vec3Column& points) {
  const Layer layer = make_layer(b, load, particular, m, options);
  const bool fast = static_cast<double>(layer.far.position.size()) * static_cast<double>(points.size()) > kFastPairs;
  Vec3Column potential = fast ? layer.far_sums(points) : Vec3Column(points.size());
  const PanelSearch search(layer.centroid, layer.middle2);
  const std::vector<std::uint32_t> order = along_curve(points);  // eight targets near each other share their panels
  parallel_for((points.size() + kLanes - 1) / kLanes, 4, [&](std::size_t group) {
    const std::size_t first = group * kLanes, count = std::min(kLanes, points.size() - first);
    Lanes lanes(points, {order.data() + first, count});
    if (fast)
      for (std::size_t k = 0; k < count; ++k) lanes.add(k, potential[order[first + k]]);
    std::size_t next = 0;  // panels before it are in the sums
    search.visit(lanes.box, [&](std::size_t block) {
      for (const std::uint32_t i : search.block(block)) {
        if (layer.is_far(i, lanes)) continue;
        if (!fast) layer.add_far(next, i, lanes);
        layer.add_near(i, fast, lanes);
        next = i + 1;
      }
    });
    if (!fast) layer.add_far(next, layer.panel.size(), lanes);
    for (std::size_t k = 0; k < count; ++k) potential.set(order[first + k], lanes.sum(k) * m.kelvin());
  });
  return potential;
}

}  // namespace sherd
