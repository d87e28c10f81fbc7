// A layer of point forces and polynomial densities on panels, summed at eight targets at a time: what single_layer.cpp
// is made of.
#pragma once
#include <algorithm>
#include <limits>

#include "engine/elastostatic/boundary.h"
#include "engine/elastostatic/lane_targets.h"
#include "engine/elastostatic/panel_rows.h"
#include "engine/elastostatic/particular.h"
#include "kernels/fmm/plan.h"
#include "kernels/quadrature/gauss.h"

namespace sherd::force_layer {

inline constexpr Real kFastTolerance = 1e-6;  // of the fast multipole method

using Density = std::array<Vec3, kQuadraticMonomials>;

// Coefficients of the monomials 1, s, t, s^2, s t, t^2 from the values at corners and midpoints 0-1, 1-2, 2-0.
inline Density from_nodes(const std::array<Vec3, 6>& v) {
  return {v[0],
          v[3] * 4 - v[0] * 3 - v[1],
          v[5] * 4 - v[0] * 3 - v[2],
          (v[0] + v[1] - v[3] * 2) * 2,
          (v[0] - v[3] + v[4] - v[5]) * 4,
          (v[0] + v[2] - v[5] * 2) * 2};
}

inline Vec3 at(const Density& q, Real s, Real t) {
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
inline constexpr Real kQuarters = 0.6;

// The four triangles between the corners and midpoints of (0, 0), (1, 0), (0, 1), with kGauss7 on each.
inline std::array<TrianglePoint, 28> make_quarters() {
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

// Where point forces of one panel are, and how its corners and its density's coefficients make them.
template <std::size_t N>
struct RuleTable {
  double corner[3][N], density[kQuadraticMonomials][N];

  explicit RuleTable(const std::array<TrianglePoint, N>& rule) {
    for (std::size_t i = 0; i < N; ++i) {
      const TrianglePoint& g = rule[i];
      corner[0][i] = g.a, corner[1][i] = g.b, corner[2][i] = g.c;
      const Real m[kQuadraticMonomials] = {1, g.b, g.c, g.b * g.b, g.b * g.c, g.c * g.c};
      for (std::size_t k = 0; k < kQuadraticMonomials; ++k) density[k][i] = g.weight * m[k];
    }
  }
};

// Point forces of one panel, on the stack.
template <std::size_t N>
struct FewForces {
  double value[6][N];

  FewForces(const PanelFrame& f, const RuleTable<N>& rule, const Density& q) {
    for (int j = 0; j < 3; ++j) {
      const Real v0 = f.vertex[0][j], v1 = f.vertex[1][j], v2 = f.vertex[2][j];
      for (std::size_t i = 0; i < N; ++i)
        value[j][i] = v0 * rule.corner[0][i] + v1 * rule.corner[1][i] + v2 * rule.corner[2][i];
      Real c[kQuadraticMonomials];
      for (std::size_t k = 0; k < kQuadraticMonomials; ++k) c[k] = q[k][j] * f.area;
      for (std::size_t i = 0; i < N; ++i) {
        Real sum = 0;
        for (std::size_t k = 0; k < kQuadraticMonomials; ++k) sum += c[k] * rule.density[k][i];
        value[3 + j][i] = sum;
      }
    }
  }
  LaneSources all() const { return {value[0], value[1], value[2], value[3], value[4], value[5], N}; }
};

// Eight targets and what is summed at them.
struct Lanes : LaneTargets {
  double u[3 * kLanes] = {};
  Vec3 centre;
  Real radius = 0;  // they lie within this distance of the centre

  Lanes(const Vec3Column& points, std::span<const std::uint32_t> of) : LaneTargets(points, of), centre(box.centre()) {
    for (std::size_t k = 0; k < count; ++k) radius = std::max(radius, distance(target(k), centre));
  }
  Vec3 sum(std::size_t k) const { return {u[k], u[kLanes + k], u[2 * kLanes + k]}; }
  void add(std::size_t k, const Vec3& v) { u[k] += v.x, u[kLanes + k] += v.y, u[2 * kLanes + k] += v.z; }
};

// One for the lanes that a description serves, else zero.
struct LaneMask {
  double weight[kLanes];
  bool any = false;
};

constexpr LaneMask everywhere(double weight) {
  LaneMask m{};
  for (double& w : m.weight) w = weight;
  return m;
}

// The lanes whose values are above `low` and not above `high`.
inline LaneMask between(const Real (&value)[kLanes], Real low, Real high) {
  LaneMask m;
  int count = 0;
  for (std::size_t k = 0; k < kLanes; ++k) {
    const bool inside = (value[k] > low) & (value[k] <= high);
    m.weight[k] = inside ? 1.0 : 0.0, count += inside;
  }
  m.any = count > 0;
  return m;
}

// The layer with everything that does not depend on the target computed once: closed form near the target, seven points
// on quarters of a panel, then on panels, three points far away.
struct Layer {
  std::vector<PanelFrame> panel;
  std::vector<char> constant;
  std::vector<Density> density;
  PointForces middle, far;  // seven and three a panel
  Vec3Column centroid;
  std::vector<Real> near2, quarters2, middle2;  // squared reach of each description, m^2
  std::vector<Real> reach;                      // of the three points: root of middle2, m
  Real least2 = 1e300;                          // a target this near a Gauss point is that point (of its panel), m^2
  Elastic material;

  void add(const PanelFrame& f, const Density& q, bool is_constant, const QuadratureOptions& o) {
    panel.push_back(f), density.push_back(q), constant.push_back(is_constant);
    middle.add(f, kGauss7, q), far.add(f, kGauss3, q);
    centroid.push_back(f.centroid());
    least2 = std::min(least2, 1e-12 * f.area);
    // Displacements of constants, unlike their gradients, are within 1.4e-5 from two edges on (design notes, section
    // 2).
    const Real exact = is_constant ? std::max(o.closed_form - 1, 0.0) : o.closed_form;
    const Real closed = std::min(is_constant ? exact : kQuarters * exact, o.gauss7), fine = std::min(exact, o.gauss7);
    near2.push_back(closed * closed * f.longest2), quarters2.push_back(fine * fine * f.longest2);
    middle2.push_back(o.gauss7 * o.gauss7 * f.longest2), reach.push_back(std::sqrt(middle2.back()));
  }
  // All sums are without kelvin().
  void add_closed(std::size_t i, LaneMask& mask, Lanes& lanes) const {
    const Density& q = density[i];
    const Real ratio = 3 - 4 * material.nu;
    if (constant[i]) {
      PanelValues v;
      for (std::size_t k = 0; k < lanes.count; ++k) {
        if (mask.weight[k] == 0) continue;
        integrate_panel(panel[i], lanes.target(k), Side::kAway, v);
        lanes.add(k, q[0] * (ratio * v.inverse) + v.dyad * q[0]);
      }
      return;
    }
    static constexpr LaneMask kNone{};
    LaneMoments m;
    closed_forms(panel[i], lanes.x, kNone.weight, mask.weight, {ratio, 1, 0}, lane_kernels(), m);
    for (std::size_t b = 0; b < q.size(); ++b) {
      const auto& [xx, yy, zz, yz, xz, xy] = m.kernel[b];
      for (std::size_t k = 0; k < kLanes; ++k) {
        lanes.u[k] += xx[k] * q[b].x + xy[k] * q[b].y + xz[k] * q[b].z;
        lanes.u[kLanes + k] += xy[k] * q[b].x + yy[k] * q[b].y + yz[k] * q[b].z;
        lanes.u[2 * kLanes + k] += xz[k] * q[b].x + yz[k] * q[b].y + zz[k] * q[b].z;
      }
    }
  }
  void add_points(const LaneSources& s, const LaneMask& mask, Lanes& lanes) const {
    lane_kernels().kelvin_sum(s, 3 - 4 * material.nu, least2, lanes.x, mask.weight, lanes.u);
  }
  // The three-point sum over panels [begin, end).
  void add_far(std::size_t begin, std::size_t end, Lanes& lanes) const {
    static constexpr LaneMask kAll = everywhere(1);
    if (begin < end) add_points(far.part(3 * begin, 3 * (end - begin)), kAll, lanes);
  }
  // The three-point sum over all panels by the fast multipole method, for all targets.
  Vec3Column far_sums(const Vec3Column& x) const {
    fmm::PlanOptions o;
    o.tolerance = kFastTolerance, o.arithmetic = fmm::Arithmetic::kMixed;
    const fmm::Plan plan(fmm::PairSum::kKelvinValue, {3 - 4 * material.nu, 1, 0, 0, 0},
                         {far.position, x, nullptr, nullptr}, o);
    std::vector<double> strengths = far.force.x, value(3 * x.size());
    strengths.insert(strengths.end(), far.force.y.begin(), far.force.y.end());
    strengths.insert(strengths.end(), far.force.z.begin(), far.force.z.end());
    plan.apply(strengths, value);
    Vec3Column out(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) out.set(i, {value[i], value[x.size() + i], value[2 * x.size() + i]});
    return out;
  }
  bool is_far(std::size_t i, const Lanes& lanes) const {
    const Real d = reach[i] + lanes.radius;
    return distance2(lanes.centre, centroid[i]) > d * d;
  }
  // A panel that some targets see by more than three points. `three_known`: the sums have its three points already.
  void add_near(std::size_t i, bool three_known, Lanes& lanes) const {
    static const RuleTable<28> quarters(make_quarters());
    const Vec3 c = centroid[i];
    Real d2[kLanes];
    for (std::size_t k = 0; k < kLanes; ++k) d2[k] = distance2(lanes.target(k), c);
    constexpr Real kInfinity = std::numeric_limits<Real>::infinity();
    LaneMask three = between(d2, middle2[i], kInfinity), closed = between(d2, -1, near2[i]);
    const LaneMask seven = between(d2, quarters2[i], middle2[i]), fine = between(d2, near2[i], quarters2[i]);
    if (three_known)
      for (double& w : three.weight) w -= 1;
    if (three_known ? seven.any || fine.any || closed.any : three.any) add_points(far.part(3 * i, 3), three, lanes);
    if (seven.any) add_points(middle.part(7 * i, 7), seven, lanes);
    if (fine.any) add_points(FewForces(panel[i], quarters, density[i]).all(), fine, lanes);
    if (closed.any) add_closed(i, closed, lanes);
  }
};

}  // namespace sherd::force_layer
