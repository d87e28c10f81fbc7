// Adaptive quadrature of panel moments in extended precision: the oracle of the moments' tests.
#pragma once
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "kernels/quadrature/moments.h"

namespace sherd::reference {

using Wide = long double;
using WideVec = Vec3T<Wide>;
inline WideVec widen(const Vec3& v) {
  return {v.x, v.y, v.z};
}

inline Vec3 narrow(const WideVec& v) {
  return {static_cast<Real>(v.x), static_cast<Real>(v.y), static_cast<Real>(v.z)};
}

struct Rule {
  std::vector<Real> node, weight;  // on [0, 1]
};
inline Rule gauss_legendre(int n) {
  Rule rule;
  for (int i = 0; i < n; ++i) {
    Wide z = std::cos(std::numbers::pi_v<Wide> * (i + 0.75L) / (n + 0.5L)), slope = 0;
    for (int it = 0; it < 50; ++it) {
      Wide p0 = 1, p1 = z;
      for (int k = 2; k <= n; ++k) {
        const Wide p2 = ((2 * k - 1) * z * p1 - (k - 1) * p0) / k;
        p0 = p1, p1 = p2;
      }
      slope = n * (z * p1 - p0) / (z * z - 1);
      z -= p1 / slope;
    }
    rule.node.push_back(static_cast<Real>((1 - z) / 2));
    rule.weight.push_back(static_cast<Real>(1 / ((1 - z * z) * slope * slope)));
  }
  return rule;
}

// Sums with the panel's monomials, as in PanelMoments and PanelMomentGradients; Voigt order.
struct Sums {
  Real inverse[kQuadraticMonomials] = {}, dyad[kQuadraticMonomials][6] = {}, angle[kCubicMonomials] = {};
  Real inverse_gradient[3][kQuadraticMonomials] = {}, dyad_gradient[3][kQuadraticMonomials][6] = {};

  void add(const Sums& b) {
    for (int m = 0; m < kCubicMonomials; ++m) angle[m] += b.angle[m];
    for (int m = 0; m < kQuadraticMonomials; ++m) {
      inverse[m] += b.inverse[m];
      for (int v = 0; v < 6; ++v) dyad[m][v] += b.dyad[m][v];
      for (int k = 0; k < 3; ++k) {
        inverse_gradient[k][m] += b.inverse_gradient[k][m];
        for (int v = 0; v < 6; ++v) dyad_gradient[k][m][v] += b.dyad_gradient[k][m][v];
      }
    }
  }
};

class Integrator {
 public:
  Integrator(const PanelFrame& panel, const Vec3& x, bool gradients)
      : x_(widen(x)), gradients_(gradients), rule_(gauss_legendre(12)) {
    const WideVec v[3] = {widen(panel.vertex[0]), widen(panel.vertex[1]), widen(panel.vertex[2])};
    wide_normal_ = normalized(cross(v[1] - v[0], v[2] - v[0]));
    normal_ = narrow(wide_normal_);
    recurse({Corner{v[0], 0, 0}, Corner{v[1], 1, 0}, Corner{v[2], 0, 1}}, 100);  // parts touching x: 2^-100 of the area
  }
  const Sums& result() const { return sum_; }

 private:
  struct Corner {
    WideVec y;
    Wide s, t;
  };
  using Part = std::array<Corner, 3>;

  // Halves the longest edge until the part is farther from x than its own diameter; then a collapsed 12 x 12 rule: the
  // nearest singularity has Bernstein parameter 5.8 at worst, 5.8^-24 = 5e-19 before the growth of the densities.
  void recurse(const Part& c, int depth) {
    int longest = 0;
    Wide length = 0, nearest = INFINITY;
    for (int e = 0; e < 3; ++e) {
      const Wide l = distance(c[e].y, c[(e + 1) % 3].y);
      if (l > length) length = l, longest = e;
    }
    nearest = part_distance(c);
    if (nearest >= length || depth == 0) return add(c);
    const Corner &a = c[longest], &b = c[(longest + 1) % 3], &apex = c[(longest + 2) % 3];
    const Corner middle{(a.y + b.y) * 0.5L, (a.s + b.s) / 2, (a.t + b.t) / 2};
    recurse({a, middle, apex}, depth - 1);
    recurse({middle, b, apex}, depth - 1);
  }
  Wide part_distance(const Part& c) const {
    Wide nearest2 = INFINITY;
    bool inside = true;
    for (int e = 0; e < 3; ++e) {
      const WideVec edge = c[(e + 1) % 3].y - c[e].y, q = x_ - c[e].y;
      const Wide z = std::min(1.0L, std::max(0.0L, dot(q, edge) / norm2(edge)));
      nearest2 = std::min(nearest2, norm2(q - edge * z));
      inside = inside && dot(cross(edge, q), wide_normal_) >= 0;
    }
    const Wide height = dot(x_ - c[0].y, wide_normal_);
    return inside ? std::abs(height) : std::sqrt(nearest2);
  }
  // Extended precision places the corners; relative to x and at least a diameter away, double suffices inside the part.
  void add(const Part& c) {
    const Real jacobian = static_cast<Real>(norm(cross(c[1].y - c[0].y, c[2].y - c[0].y)));
    Vec3 r[3];
    Real s[3], t[3];
    for (int k = 0; k < 3; ++k) {
      r[k] = narrow(x_ - c[k].y);
      s[k] = static_cast<Real>(c[k].s), t[k] = static_cast<Real>(c[k].t);
    }
    Sums part;
    for (std::size_t i = 0; i < rule_.node.size(); ++i)
      for (std::size_t j = 0; j < rule_.node.size(); ++j) {
        const Real a = rule_.node[i], b = rule_.node[j] * a, w = rule_.weight[i] * rule_.weight[j] * a * jacobian;
        const auto at = [&](const auto(&f)[3]) { return f[0] * (1 - a) + f[1] * (a - b) + f[2] * b; };
        point(at(r), at(s), at(t), w, part);
      }
    sum_.add(part);
  }
  void point(const Vec3& r, Real s, Real t, Real w, Sums& sum) const {
    const Real monomial[kCubicMonomials] = {1, s, t, s * s, s * t, t * t, s * s * s, s * s * t, s * t * t, t * t * t};
    const Real one = 1 / norm(r), w1 = w * one, w3 = w1 * one * one, w5 = w3 * one * one;
    const Real q[3] = {r.x, r.y, r.z}, height = dot(r, normal_) * w3;
    for (int m = 0; m < kCubicMonomials; ++m) sum.angle[m] += monomial[m] * height;
    Real dyad[6], gradient[3][6];
    for (int v = 0; v < 6; ++v) {
      const int i = kI[v], j = kJ[v];
      dyad[v] = w3 * q[i] * q[j];
      for (int k = 0; k < 3; ++k)
        gradient[k][v] = w3 * ((i == k ? q[j] : 0) + (j == k ? q[i] : 0)) - 3 * w5 * q[i] * q[j] * q[k];
    }
    for (int m = 0; m < kQuadraticMonomials; ++m) {
      sum.inverse[m] += monomial[m] * w1;
      for (int v = 0; v < 6; ++v) sum.dyad[m][v] += monomial[m] * dyad[v];
      if (!gradients_) continue;
      for (int k = 0; k < 3; ++k) {
        sum.inverse_gradient[k][m] -= monomial[m] * w3 * q[k];
        for (int v = 0; v < 6; ++v) sum.dyad_gradient[k][m][v] += monomial[m] * gradient[k][v];
      }
    }
  }

  static constexpr int kI[6] = {0, 1, 2, 1, 0, 0}, kJ[6] = {0, 1, 2, 2, 2, 1};
  WideVec x_, wide_normal_;
  Vec3 normal_;
  bool gradients_;
  Rule rule_;
  Sums sum_;
};

}  // namespace sherd::reference
