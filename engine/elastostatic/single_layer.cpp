#include "engine/elastostatic/single_layer.h"

#include <algorithm>

#include "engine/elastostatic/lane_kernels.h"
#include "engine/elastostatic/panel_search.h"
#include "kernels/core/parallel.h"
#include "kernels/fmm/plan.h"
#include "kernels/fundamental/kelvin.h"
#include "kernels/quadrature/gauss.h"

namespace sherd {
namespace {

// Pairs of targets and far sources from which on the fast multipole method is used: about a second of direct sums on
// one core.
constexpr double kFastPairs = 2e9;
constexpr Real kFastTolerance = 1e-6;

using Density = std::array<Vec3, kQuadraticMonomials>;

// Coefficients of the monomials 1, s, t, s^2, s t, t^2 from the values at corners and midpoints 0-1, 1-2, 2-0.
Density from_nodes(const std::array<Vec3, 6>& v) {
  return {v[0],
          v[3] * 4 - v[0] * 3 - v[1],
          v[5] * 4 - v[0] * 3 - v[2],
          (v[0] + v[1] - v[3] * 2) * 2,
          (v[0] - v[3] + v[4] - v[5]) * 4,
          (v[0] + v[2] - v[5] * 2) * 2};
}

Vec3 at(const Density& q, Real s, Real t) {
  return q[0] + q[1] * s + q[2] * t + q[3] * (s * s) + q[4] * (s * t) + q[5] * (t * t);
}

// A panel as point forces at the nodes of a rule: position and density times weight times area.
struct PointForces {
  Vec3Column position, force;

  template <std::size_t N>
  void add(const PanelFrame& f, const std::array<TrianglePoint, N>& rule, const Density& q) {
    for (const TrianglePoint& g : rule) {
      position.push_back(f.vertex[0] * g.a + f.vertex[1] * g.b + f.vertex[2] * g.c);
      force.push_back(at(q, g.b, g.c) * (g.weight * f.area));
    }
  }
  Vec3 displacement(std::size_t begin, std::size_t end, const Vec3& x, const Elastic& m) const {
    Vec3 u;
    for (std::size_t i = begin; i < end; ++i) u += kelvin::displacement(x - position[i], force[i], m);
    return u;
  }
};

// The layer with everything that does not depend on the target computed once: closed form near the target, seven points
// farther away, three points far away.
struct Layer {
  std::vector<PanelFrame> panel;
  std::vector<char> constant;
  std::vector<Density> density;
  PointForces middle, far;  // seven and three a panel
  Vec3Column centroid;
  std::vector<Real> near2, middle2;  // squared reach of each description, m^2
  Real least2 = 1e300;               // a target this near a Gauss point is that point (of its own panel), m^2

  void add(const PanelFrame& f, const Density& q, bool is_constant, const QuadratureOptions& o) {
    panel.push_back(f), density.push_back(q), constant.push_back(is_constant);
    middle.add(f, kGauss7, q), far.add(f, kGauss3, q);
    centroid.push_back(f.centroid());
    least2 = std::min(least2, 1e-12 * f.area);
    // Displacements of constants, unlike their gradients, are within 1.4e-5 from two edges on (design notes, section
    // 2).
    const Real reach = is_constant ? std::max(o.closed_form - 1, 0.0) : o.closed_form;
    near2.push_back(reach * reach * f.longest2), middle2.push_back(o.gauss7 * o.gauss7 * f.longest2);
  }
  Vec3 closed_form(std::size_t i, const Vec3& x, const Elastic& m) const {
    const Density& q = density[i];
    if (constant[i]) {
      PanelValues v;
      integrate_panel(panel[i], x, Side::kAway, v);
      return (q[0] * ((3 - 4 * m.nu) * v.inverse) + v.dyad * q[0]) * m.kelvin();
    }
    PanelMoments v;
    integrate_panel_moments(panel[i], x, Side::kAway, v);
    Vec3 u;
    for (std::size_t k = 0; k < q.size(); ++k) u += q[k] * ((3 - 4 * m.nu) * v.inverse[k]) + v.dyad[k] * q[k];
    return u * m.kelvin();
  }
  // The three-point sum over all panels for eight targets at once.
  void far_sum(const std::array<Vec3, kLanes>& x, std::size_t count, const Elastic& m, Vec3* out) const {
    double target[3 * kLanes], sum[3 * kLanes] = {};
    for (std::size_t k = 0; k < kLanes; ++k)
      for (int i = 0; i < 3; ++i) target[static_cast<std::size_t>(i) * kLanes + k] = x[k < count ? k : 0][i];
    const Vec3Column &p = far.position, &f = far.force;
    lane_kernels().kelvin_sum({p.x.data(), p.y.data(), p.z.data(), f.x.data(), f.y.data(), f.z.data(), p.size()},
                              3 - 4 * m.nu, least2, target, sum);
    for (std::size_t k = 0; k < count; ++k) out[k] = Vec3{sum[k], sum[kLanes + k], sum[2 * kLanes + k]} * m.kelvin();
  }
  // The same by the fast multipole method, for all targets.
  Vec3Column far_sums(const Vec3Column& x, const Elastic& m) const {
    fmm::PlanOptions o;
    o.tolerance = kFastTolerance, o.arithmetic = fmm::Arithmetic::kMixed;
    const fmm::Plan plan(fmm::PairSum::kKelvinValue, {(3 - 4 * m.nu) * m.kelvin(), m.kelvin(), 0, 0, 0},
                         {far.position, x, nullptr, nullptr}, o);
    std::vector<double> strengths = far.force.x, value(3 * x.size());
    strengths.insert(strengths.end(), far.force.y.begin(), far.force.y.end());
    strengths.insert(strengths.end(), far.force.z.begin(), far.force.z.end());
    plan.apply(strengths, value);
    Vec3Column out(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) out.set(i, {value[i], value[x.size() + i], value[2 * x.size() + i]});
    return out;
  }
  // What panels nearer than three points allow add to that.
  Vec3 correction(std::span<const std::uint32_t> panels, const Vec3& x, const Elastic& m) const {
    const Vec3Column &p = far.position, &f = far.force;
    Vec3 u;
    for (const std::uint32_t i : panels) {
      const Real d2 = distance2(x, centroid[i]);
      if (d2 > middle2[i]) continue;
      for (std::size_t q = 3 * i; q < 3 * i + 3; ++q)
        if (distance2(x, p[q]) > least2) u -= kelvin::displacement(x - p[q], f[q], m);
      u += d2 > near2[i] ? middle.displacement(7 * i, 7 * i + 7, x, m) : closed_form(i, x, m);
    }
    return u;
  }
};

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
  Layer layer;
  for (std::size_t i = 0; i < load.panels.size(); ++i) {
    const auto& c = load.panels.corners[i];
    layer.add(make_panel(c[0], c[1], c[2]), {load.panels.traction[i]}, true, options);
  }
  if (!particular.zero() || !load.face_traction.empty() || !load.quadratic_traction.empty())
    for (std::size_t t = 0; t < b.panels.size(); ++t)
      layer.add(b.panels[t], traction_polynomial(b, load, particular, t), false, options);
  const bool fast = static_cast<double>(layer.far.position.size()) * static_cast<double>(points.size()) > kFastPairs;
  Vec3Column potential = fast ? layer.far_sums(points, m) : Vec3Column(points.size());
  const PanelSearch search(layer.centroid, layer.middle2);
  parallel_for((points.size() + kLanes - 1) / kLanes, 4, [&](std::size_t group) {
    std::array<Vec3, kLanes> x, u;
    const std::size_t first = group * kLanes, count = std::min(kLanes, points.size() - first);
    for (std::size_t k = 0; k < count; ++k) x[k] = points[first + k], u[k] = potential[first + k];
    if (!fast) layer.far_sum(x, count, m, u.data());
    for (std::size_t k = 0; k < count; ++k) {
      Box at;
      at.grow(x[k]);
      search.visit(at, [&](std::size_t block) { u[k] += layer.correction(search.block(block), x[k], m); });
      potential.set(first + k, u[k]);
    }
  });
  return potential;
}

}  // namespace sherd
