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

struct Rule {
  std::vector<Wide> node, weight;  // on [0, 1]
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
    rule.node.push_back((1 - z) / 2);
    rule.weight.push_back(1 / ((1 - z * z) * slope * slope));
  }
  return rule;
}

// Sums over the panel's monomials, as in PanelMoments, and for the gradients.
struct Moments {
  Wide inverse[kQuadraticMonomials] = {}, dyad[kQuadraticMonomials][6] = {}, angle[kCubicMonomials] = {};
  Wide inverse_gradient[kQuadraticMonomials][3] = {}, dyad_gradient[3][kQuadraticMonomials][6] = {};
};

class Integrator {
 public:
  Integrator(const PanelFrame& panel, const Vec3& x, bool gradients)
      : x_(widen(x)), gradients_(gradients), rule_(gauss_legendre(12)) {
    const WideVec v[3] = {widen(panel.vertex[0]), widen(panel.vertex[1]), widen(panel.vertex[2])};
    normal_ = cross(v[1] - v[0], v[2] - v[0]);
    area_ = norm(normal_) / 2;
    normal_ = normal_ / (2 * area_);
    recurse({Corner{v[0], 0, 0}, Corner{v[1], 1, 0}, Corner{v[2], 0, 1}}, 140);
  }
  const Moments& result() const { return sum_; }

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
      inside = inside && dot(cross(edge, q), normal_) >= 0;
    }
    const Wide height = dot(x_ - c[0].y, normal_);
    return inside ? std::abs(height) : std::sqrt(nearest2);
  }
  void add(const Part& c) {
    const Wide jacobian = norm(cross(c[1].y - c[0].y, c[2].y - c[0].y));
    for (std::size_t i = 0; i < rule_.node.size(); ++i)
      for (std::size_t j = 0; j < rule_.node.size(); ++j) {
        const Wide a = rule_.node[i], b = rule_.node[j] * a, w = rule_.weight[i] * rule_.weight[j] * a * jacobian;
        const auto at = [&](auto f0, auto f1, auto f2) { return f0 + (f1 - f0) * (a - b) + (f2 - f0) * b; };
        point(x_ - at(c[0].y, c[1].y, c[2].y), at(c[0].s, c[1].s, c[2].s), at(c[0].t, c[1].t, c[2].t), w);
      }
  }
  void point(const WideVec& r, Wide s, Wide t, Wide w) {
    const Wide monomial[kCubicMonomials] = {1, s, t, s * s, s * t, t * t, s * s * s, s * s * t, s * t * t, t * t * t};
    constexpr int kI[6] = {0, 1, 2, 1, 0, 0}, kJ[6] = {0, 1, 2, 2, 2, 1};
    const Wide l = norm(r), w1 = w / l, w3 = w1 / (l * l), w5 = w3 / (l * l);
    for (int m = 0; m < kCubicMonomials; ++m) sum_.angle[m] += monomial[m] * w3 * dot(r, normal_);
    for (int m = 0; m < kQuadraticMonomials; ++m) {
      sum_.inverse[m] += monomial[m] * w1;
      for (int v = 0; v < 6; ++v) sum_.dyad[m][v] += monomial[m] * w3 * r[kI[v]] * r[kJ[v]];
      for (int k = 0; gradients_ && k < 3; ++k) {
        sum_.inverse_gradient[m][k] -= monomial[m] * w3 * r[k];
        for (int v = 0; v < 6; ++v) {
          const int i = kI[v], j = kJ[v];
          const Wide first = (i == k ? r[j] : 0) + (j == k ? r[i] : 0);
          sum_.dyad_gradient[k][m][v] += monomial[m] * (w3 * first - 3 * w5 * r[i] * r[j] * r[k]);
        }
      }
    }
  }

  WideVec x_, normal_;
  Wide area_ = 0;
  bool gradients_;
  Rule rule_;
  Moments sum_;
};

}  // namespace sherd::reference
