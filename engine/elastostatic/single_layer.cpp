#include "engine/elastostatic/single_layer.h"

#include <algorithm>

#include "engine/elastostatic/lane_kernels.h"
#include "engine/elastostatic/panel_search.h"
#include "kernels/core/parallel.h"
#include "kernels/fmm/plan.h"
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
  LaneSources part(std::size_t begin, std::size_t count) const {
    const Vec3Column &p = position, &f = force;
    return {p.x.data() + begin,
            p.y.data() + begin,
            p.z.data() + begin,
            f.x.data() + begin,
            f.y.data() + begin,
            f.z.data() + begin,
            count};
  }
  LaneSources all() const { return part(0, position.size()); }
};

// From this part of the closed forms' reach on, a quadratic density is integrated by seven points on each quarter of
// the panel: they are as far away in quarters' edges as the closed forms' reach is in panels', and cost a fifth.
constexpr Real kQuarters = 0.6;

// The four triangles between the corners and midpoints of (0, 0), (1, 0), (0, 1), with kGauss7 on each.
std::array<TrianglePoint, 28> make_quarters() {
  std::array<TrianglePoint, 28> out{};
  constexpr Real kCorner[4][3][2] = {{{0, 0}, {0.5, 0}, {0, 0.5}},
                                     {{0.5, 0}, {1, 0}, {0.5, 0.5}},
                                     {{0, 0.5}, {0.5, 0.5}, {0, 1}},
                                     {{0.5, 0}, {0.5, 0.5}, {0, 0.5}}};
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t q = 0; q < 7; ++q) {
      const TrianglePoint& g = kGauss7[q];
      const auto& c = kCorner[k];
      const Real b = g.a * c[0][0] + g.b * c[1][0] + g.c * c[2][0], t = g.a * c[0][1] + g.b * c[1][1] + g.c * c[2][1];
      out[7 * k + q] = {1 - b - t, b, t, g.weight / 4};
    }
  return out;
}

// Point forces of one panel, on the stack.
template <std::size_t N>
struct FewForces {
  double value[6][N];

  FewForces(const PanelFrame& f, const std::array<TrianglePoint, N>& rule, const Density& q) {
    for (std::size_t i = 0; i < N; ++i) {
      const TrianglePoint& g = rule[i];
      const Vec3 y = f.vertex[0] * g.a + f.vertex[1] * g.b + f.vertex[2] * g.c,
                 t = at(q, g.b, g.c) * (g.weight * f.area);
      for (int k = 0; k < 3; ++k) value[k][i] = y[k], value[3 + k][i] = t[k];
    }
  }
  LaneSources all() const { return {value[0], value[1], value[2], value[3], value[4], value[5], N}; }
};

// Eight targets, coordinates one after another, and what is summed at them.
struct Lanes {
  double x[3 * kLanes] = {}, u[3 * kLanes] = {};

  void kelvin(const LaneSources& s, Real ratio, Real least2) { lane_kernels().kelvin_sum(s, ratio, least2, x, u); }
  Vec3 at(std::size_t k) const { return {u[k], u[kLanes + k], u[2 * kLanes + k]}; }
};

// The layer with everything that does not depend on the target computed once: closed form near the target, seven points
// on quarters of a panel, then on panels, three points far away.
struct Layer {
  std::vector<PanelFrame> panel;
  std::vector<char> constant;
  std::vector<Density> density;
  PointForces middle, far;  // seven and three a panel
  Vec3Column centroid;
  std::vector<Real> near2, quarters2, middle2;  // squared reach of each description, m^2
  Real least2 = 1e300;                          // a target this near a Gauss point is that point (of its panel), m^2

  void add(const PanelFrame& f, const Density& q, bool is_constant, const QuadratureOptions& o) {
    panel.push_back(f), density.push_back(q), constant.push_back(is_constant);
    middle.add(f, kGauss7, q), far.add(f, kGauss3, q);
    centroid.push_back(f.centroid());
    least2 = std::min(least2, 1e-12 * f.area);
    // Displacements of constants, unlike their gradients, are within 1.4e-5 from two edges on (design notes, section
    // 2).
    const Real reach = is_constant ? std::max(o.closed_form - 1, 0.0) : o.closed_form;
    const Real closed = is_constant ? reach : kQuarters * reach;
    near2.push_back(closed * closed * f.longest2), quarters2.push_back(reach * reach * f.longest2);
    middle2.push_back(o.gauss7 * o.gauss7 * f.longest2);
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
  // The three-point sum over all panels, but for kelvin().
  void far_sum(const Elastic& m, Lanes& lanes) const { lanes.kelvin(far.all(), 3 - 4 * m.nu, least2); }
  // The same by the fast multipole method, for all targets, m.
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
  // What panels nearer than three points allow add to that at the first `count` targets.
  void correct(std::span<const std::uint32_t> panels, std::size_t count, const std::array<Vec3, kLanes>& x,
               const Elastic& m, std::array<Vec3, kLanes>& u) const {
    static const std::array<TrianglePoint, 28> quarters = make_quarters();
    const Real ratio = 3 - 4 * m.nu;
    std::array<Real, kLanes> d2{};
    Vec3 centre;
    for (const Vec3& p : x) centre += p / static_cast<Real>(kLanes);
    Real radius = 0;
    for (const Vec3& p : x) radius = std::max(radius, distance(p, centre));
    for (const std::uint32_t i : panels) {
      const Real reach = std::sqrt(middle2[i]) + radius;
      if (distance2(centre, centroid[i]) > reach * reach) continue;
      Real nearest = 1e300;
      bool by_middle = false, by_quarters = false;
      for (std::size_t k = 0; k < count; ++k) {
        d2[k] = distance2(x[k], centroid[i]);
        nearest = std::min(nearest, d2[k]);
        by_middle |= d2[k] > quarters2[i] && d2[k] <= middle2[i];
        by_quarters |= d2[k] > near2[i] && d2[k] <= quarters2[i];
      }
      if (nearest > middle2[i]) continue;
      Lanes three, seven, fine;
      for (std::size_t k = 0; k < kLanes; ++k)
        for (std::size_t j = 0; j < 3; ++j) three.x[j * kLanes + k] = x[k < count ? k : 0][static_cast<int>(j)];
      std::copy_n(three.x, 3 * kLanes, seven.x), std::copy_n(three.x, 3 * kLanes, fine.x);
      three.kelvin(far.part(3 * i, 3), ratio, least2);
      if (by_middle) seven.kelvin(middle.part(7 * i, 7), ratio, least2);
      if (by_quarters) {
        fine.kelvin(FewForces(panel[i], quarters, density[i]).all(), ratio, least2);
      }
      for (std::size_t k = 0; k < count; ++k) {
        if (d2[k] > middle2[i]) continue;
        u[k] -= three.at(k) * m.kelvin();
        if (d2[k] > quarters2[i])
          u[k] += seven.at(k) * m.kelvin();
        else if (d2[k] > near2[i])
          u[k] += fine.at(k) * m.kelvin();
        else
          u[k] += closed_form(i, x[k], m);
      }
    }
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
  const std::vector<std::uint32_t> order = along_curve(points);  // eight targets near each other share their panels
  parallel_for((points.size() + kLanes - 1) / kLanes, 4, [&](std::size_t group) {
    std::array<Vec3, kLanes> x, u;
    const std::size_t first = group * kLanes, count = std::min(kLanes, points.size() - first);
    Lanes lanes;
    Box at;
    for (std::size_t k = 0; k < kLanes; ++k) {
      x[k] = points[order[first + (k < count ? k : 0)]];
      at.grow(x[k]);
      for (std::size_t j = 0; j < 3; ++j) lanes.x[j * kLanes + k] = x[k][static_cast<int>(j)];
    }
    if (!fast) layer.far_sum(m, lanes);
    for (std::size_t k = 0; k < count; ++k) u[k] = fast ? potential[order[first + k]] : lanes.at(k) * m.kelvin();
    search.visit(at, [&](std::size_t block) { layer.correct(search.block(block), count, x, m, u); });
    for (std::size_t k = 0; k < count; ++k) potential.set(order[first + k], u[k]);
  });
  return potential;
}

}  // namespace sherd
