// The ten-node cubic Lagrange triangle. Nodes: the three vertices; on edge e (vertex e to e+1) the points at 1/3 and
// 2/3, nodes 3 + 2 e and 4 + 2 e; the centroid, node 9. Coordinates and monomials as in moments.h.
#pragma once
#include <array>

#include "kernels/quadrature/moments.h"

namespace sherd::cubic {

inline constexpr int kNodes = 10;

// Coefficients over the cubic monomials.
using Polynomial = std::array<Real, kCubicMonomials>;

constexpr Polynomial multiply(const Polynomial& p, int degree_p, const Polynomial& q, int degree_q) {
  constexpr int first[] = {0, 1, 3, 6};  // monomial s^(d-j) t^j is number first[d] + j
  Polynomial out{};
  for (int d = 0; d <= degree_p; ++d)
    for (int i = 0; i <= d; ++i)
      for (int e = 0; e <= degree_q; ++e)
        for (int j = 0; j <= e; ++j)
          if (d + e <= 3)
            out[static_cast<std::size_t>(first[d + e] + i + j)] +=
                p[static_cast<std::size_t>(first[d] + i)] * q[static_cast<std::size_t>(first[e] + j)];
  return out;
}

// factor (a + b lambda_k) as a polynomial of degree 1
constexpr Polynomial affine(Real a, Real b, int k) {
  if (k == 0) return {a + b, -b, -b};
  return k == 1 ? Polynomial{a, b} : Polynomial{a, 0, b};
}

constexpr std::array<Polynomial, kNodes> make_shapes() {
  std::array<Polynomial, kNodes> n{};
  for (int k = 0; k < 3; ++k) {
    const Polynomial p = multiply(affine(0, 0.5, k), 1, affine(-1, 3, k), 1);
    n[static_cast<std::size_t>(k)] = multiply(p, 2, affine(-2, 3, k), 1);
    const int next = (k + 1) % 3;
    const Polynomial edge = multiply(affine(0, 4.5, k), 1, affine(0, 1, next), 1);
    n[static_cast<std::size_t>(3 + 2 * k)] = multiply(edge, 2, affine(-1, 3, k), 1);
    n[static_cast<std::size_t>(4 + 2 * k)] = multiply(edge, 2, affine(-1, 3, next), 1);
  }
  n[9] = multiply(multiply(affine(0, 27, 0), 1, affine(0, 1, 1), 1), 2, affine(0, 1, 2), 1);
  return n;
}

// d/ds (which = 0) or d/dt of a cubic: a quadratic in the first six monomials.
constexpr Polynomial derivative(const Polynomial& p, int which) {
  if (which == 0) return {p[1], 2 * p[3], p[4], 3 * p[6], 2 * p[7], p[8]};
  return {p[2], p[4], 2 * p[5], p[7], 2 * p[8], 3 * p[9]};
}

inline constexpr std::array<Polynomial, kNodes> kShape = make_shapes();

// The same element by what it is made of where its centre is a quarter of the edge nodes less a sixth of the vertices:
// the values at the vertices, 0 to 2, and for edge e the derivatives along it, times its length, outward from vertex e
// and from vertex e+1, 3 + 2 e and 4 + 2 e.
inline constexpr int kFreedoms = 9;

constexpr std::array<Polynomial, kFreedoms> make_hermite() {
  std::array<Polynomial, kFreedoms> out{};
  // The freedom is `start` at the third of edge e after its vertex e, `end` at the one before the next vertex.
  const auto add = [&](std::size_t freedom, std::size_t e, Real start, Real end) {
    for (std::size_t i = 0; i < kCubicMonomials; ++i)
      out[freedom][i] += start * kShape[3 + 2 * e][i] + end * kShape[4 + 2 * e][i] + (start + end) / 4 * kShape[9][i];
  };
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < kCubicMonomials; ++i) out[k][i] = kShape[k][i] - kShape[9][i] / 6;
    add(k, k, 20.0 / 27, 7.0 / 27), add(k, (k + 2) % 3, 7.0 / 27, 20.0 / 27);
    add(3 + 2 * k, k, 4.0 / 27, 2.0 / 27), add(4 + 2 * k, k, 2.0 / 27, 4.0 / 27);
  }
  return out;
}

inline constexpr std::array<Polynomial, kFreedoms> kHermite = make_hermite();

constexpr std::array<Real, kCubicMonomials> monomials(Real s, Real t) {
  return {1, s, t, s * s, s * t, t * t, s * s * s, s * s * t, s * t * t, t * t * t};
}

constexpr Real evaluate(const Polynomial& p, Real s, Real t) {
  const auto m = monomials(s, t);
  Real sum = 0;
  for (std::size_t i = 0; i < m.size(); ++i) sum += p[i] * m[i];
  return sum;
}

// Integral of s^i t^j over the reference triangle divided by its area: 2 i! j! / (i + j + 2)!
constexpr Real mean_monomial(int i, int j) {
  Real value = 2;
  for (int k = 1; k <= i + j + 2; ++k) value /= k;
  for (int k = 1; k <= i; ++k) value *= k;
  for (int k = 1; k <= j; ++k) value *= k;
  return value;
}

}  // namespace sherd::cubic
