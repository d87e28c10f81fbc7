// The formulas of the pair sums (pair_sums.h), one body a sum, in five steps so that loops, instruction sets and
// devices can be generic around them:
//   pack    once a source: constants times strengths, p[0 .. kPacked - 1]. V: a number or a vector over sources.
//   add     every pair: r = x - y, inverse = 1 / l or 0, the packed source p, added to acc[0 .. kAccumulators - 1]
//   finish  once a target: acc -> out[0 .. outputs - 1]
// `Lanes` is the caller's policy: Number (float or double) and Vector (what holds the targets: the number itself, or a
// vector of them). Where one source is compiled for several processors Lanes must be a type of internal linkage: then
// every instance here has it too, and the linker cannot mix processors.
//
// All sums are written with the unit vector e = r * inverse, not with powers of 1/l: then nothing over- or underflows
// before the result does. Every term has a factor `inverse`, so pairs with inverse = 0 add nothing.
#pragma once
#include "kernels/core/vec3.h"
#include "kernels/fundamental/pair_sums.h"

namespace sherd::fmm {

// Pairs closer than the square root of this count as coincident: 1/l^2 stays finite. (float: l = 8.7e-19.)
template <class T>
SHERD_HD constexpr T least_square() {
  return sizeof(T) == 4 ? T(0x1p-120) : T(0x1p-1000);
}

template <PairSum S, class Lanes>
struct PairBody;

// a . b[at .. at + 2]
template <class V, class P>
SHERD_HD inline V dot3(const V* a, const P& b, int at) {
  return a[0] * b[at] + a[1] * b[at + 1] + a[2] * b[at + 2];
}

template <class Lanes>
struct PairBody<PairSum::kLaplaceValue, Lanes> {
  using T = typename Lanes::Number;
  using V = typename Lanes::Vector;
  static constexpr int kPacked = 1, kAccumulators = 1;
  template <class U>
  SHERD_HD static void pack(const PairConstants<T>& c, const U* s, U* p) {
    p[0] = s[0] * c.c;
  }
  template <class P>
  SHERD_HD static void add(const PairConstants<T>&, const V*, V inverse, const P& p, V* acc) {
    acc[0] += inverse * p[0];
  }
  SHERD_HD static void finish(const PairConstants<T>&, const V* acc, const V*, V* out) { out[0] = acc[0]; }
};

template <class Lanes>
struct PairBody<PairSum::kLaplaceGradient, Lanes> {
  using T = typename Lanes::Number;
  using V = typename Lanes::Vector;
  static constexpr int kPacked = 1, kAccumulators = 4;
  template <class U>
  SHERD_HD static void pack(const PairConstants<T>& c, const U* s, U* p) {
    p[0] = s[0] * c.c;
  }
  template <class P>
  SHERD_HD static void add(const PairConstants<T>&, const V* r, V inverse, const P& p, V* acc) {
    const V value = inverse * p[0], slope = value * inverse;
    acc[0] += value;
    for (int i = 0; i < 3; ++i) acc[1 + i] += slope * (r[i] * inverse);
  }
  SHERD_HD static void finish(const PairConstants<T>&, const V* acc, const V*, V* out) {
    out[0] = acc[0];
    for (int i = 1; i < 4; ++i) out[i] = -acc[i];
  }
};

// m = c q n. The value is m . e / l^2, its gradient (m - 3 (m . e) e) / l^3.
template <class Lanes>
struct PairBody<PairSum::kDipoleValue, Lanes> {
  using T = typename Lanes::Number;
  using V = typename Lanes::Vector;
  static constexpr int kPacked = 3, kAccumulators = 1;
  template <class U>
  SHERD_HD static void pack(const PairConstants<T>& c, const U* s, U* p) {
    for (int i = 0; i < 3; ++i) p[i] = s[0] * c.c * s[1 + i];
  }
  template <class P>
  SHERD_HD static void add(const PairConstants<T>&, const V* r, V inverse, const P& p, V* acc) {
    acc[0] += dot3(r, p, 0) * inverse * (inverse * inverse);
  }
  SHERD_HD static void finish(const PairConstants<T>&, const V* acc, const V*, V* out) { out[0] = acc[0]; }
};

template <class Lanes>
struct PairBody<PairSum::kDipoleGradient, Lanes> {
  using T = typename Lanes::Number;
  using V = typename Lanes::Vector;
  static constexpr int kPacked = 3, kAccumulators = 4;
  template <class U>
  SHERD_HD static void pack(const PairConstants<T>& c, const U* s, U* p) {
    for (int i = 0; i < 3; ++i) p[i] = s[0] * c.c * s[1 + i];
  }
  template <class P>
  SHERD_HD static void add(const PairConstants<T>&, const V* r, V inverse, const P& p, V* acc) {
    const V e[3] = {r[0] * inverse, r[1] * inverse, r[2] * inverse};
    const V along = dot3(e, p, 0), square = inverse * inverse, cube = square * inverse, radial = along * T(-3);
    acc[0] += along * square;
    for (int i = 0; i < 3; ++i) acc[1 + i] += cube * (radial * e[i] + p[i]);
  }
  SHERD_HD static void finish(const PairConstants<T>&, const V* acc, const V*, V* out) {
    for (int i = 0; i < 4; ++i) out[i] = acc[i];
  }
};

template <class Lanes>
struct PairBody<PairSum::kKelvinValue, Lanes> {
  using T = typename Lanes::Number;
  using V = typename Lanes::Vector;
  static constexpr int kPacked = 6, kAccumulators = 3;
  template <class U>
  SHERD_HD static void pack(const PairConstants<T>& c, const U* s, U* p) {
    for (int i = 0; i < 3; ++i) p[i] = s[i] * c.a, p[3 + i] = s[i] * c.b;
  }
  template <class P>
  SHERD_HD static void add(const PairConstants<T>&, const V* r, V inverse, const P& p, V* acc) {
    const V e[3] = {r[0] * inverse, r[1] * inverse, r[2] * inverse};
    const V along = dot3(e, p, 3);
    for (int i = 0; i < 3; ++i) acc[i] += inverse * (along * e[i] + p[i]);
  }
  SHERD_HD static void finish(const PairConstants<T>&, const V* acc, const V*, V* out) {
    for (int i = 0; i < 3; ++i) out[i] = acc[i];
  }
};

// l^2 u_i,k = b (e . f) d_ik - a f_i e_k + b e_i f_k - 3 b (e . f) e_i e_k. Its symmetric part but the first term is
// g_i e_k + e_i g_k with g = (b - a)/2 f - 3/2 b (e . f) e, its antisymmetric part (h_k e_i - h_i e_k), h = (a + b)/2
// f: ten sums instead of eighteen.
template <class Lanes>
struct PairBody<PairSum::kKelvinGradient, Lanes> {
  using T = typename Lanes::Number;
  using V = typename Lanes::Vector;
  static constexpr int kPacked = 9, kAccumulators = 10;  // xx, yy, zz, yz, xz, xy; trace; antisymmetric yz, xz, xy
  template <class U>
  SHERD_HD static void pack(const PairConstants<T>& c, const U* s, U* p) {
    for (int i = 0; i < 3; ++i) {
      p[i] = s[i] * (T(0.5) * (c.b - c.a));
      p[3 + i] = s[i] * (T(-1.5) * c.b);
      p[6 + i] = s[i] * (T(0.5) * (c.a + c.b));
    }
  }
  template <class P>
  SHERD_HD static void add(const PairConstants<T>&, const V* r, V inverse, const P& p, V* acc) {
    const V e[3] = {r[0] * inverse, r[1] * inverse, r[2] * inverse};
    const V along = dot3(e, p, 3), square = inverse * inverse;
    const V w[3] = {e[0] * square, e[1] * square, e[2] * square};
    const V g[3] = {along * e[0] + p[0], along * e[1] + p[1], along * e[2] + p[2]};
    for (int i = 0; i < 3; ++i) acc[i] += g[i] * w[i];
    acc[3] += g[1] * w[2], acc[4] += g[0] * w[2], acc[5] += g[0] * w[1];
    acc[3] += g[2] * w[1], acc[4] += g[2] * w[0], acc[5] += g[1] * w[0];
    acc[6] += along * square;
    acc[7] += w[1] * p[8], acc[8] += w[0] * p[8], acc[9] += w[0] * p[7];
    acc[7] -= w[2] * p[7], acc[8] -= w[2] * p[6], acc[9] -= w[1] * p[6];
  }
  SHERD_HD static void finish(const PairConstants<T>&, const V* acc, const V*, V* out) {
    const V trace = acc[6] * T(-2.0 / 3.0);
    out[0] = acc[0] * T(2) + trace, out[4] = acc[1] * T(2) + trace, out[8] = acc[2] * T(2) + trace;
    out[5] = acc[3] + acc[7], out[7] = acc[3] - acc[7];
    out[2] = acc[4] + acc[8], out[6] = acc[4] - acc[8];
    out[1] = acc[5] + acc[9], out[3] = acc[5] - acc[9];
  }
};

// l^2 stress = (lambda (b - a) + 2 mu b) (e . f) d_ik + g_i e_k + e_i g_k, g = mu (b - a) f - 3 mu b (e . f) e.
template <class Lanes>
struct StressSums {
  using T = typename Lanes::Number;
  using V = typename Lanes::Vector;
  static constexpr int kPacked = 6, kAccumulators = 7;  // xx, yy, zz, yz, xz, xy; e . f
  template <class U>
  SHERD_HD static void pack(const PairConstants<T>& c, const U* s, U* p) {
    for (int i = 0; i < 3; ++i) p[i] = s[i] * (c.mu * (c.b - c.a)), p[3 + i] = s[i];
  }
  template <class P>
  SHERD_HD static void add(const PairConstants<T>& c, const V* r, V inverse, const P& p, V* acc) {
    const V e[3] = {r[0] * inverse, r[1] * inverse, r[2] * inverse};
    const V along = dot3(e, p, 3), square = inverse * inverse, radial = along * (T(-3) * c.mu * c.b);
    const V w[3] = {e[0] * square, e[1] * square, e[2] * square};
    const V g[3] = {radial * e[0] + p[0], radial * e[1] + p[1], radial * e[2] + p[2]};
    for (int i = 0; i < 3; ++i) acc[i] += g[i] * w[i];
    acc[3] += g[1] * w[2], acc[4] += g[0] * w[2], acc[5] += g[0] * w[1];
    acc[3] += g[2] * w[1], acc[4] += g[2] * w[0], acc[5] += g[1] * w[0];
    acc[6] += along * square;
  }
  SHERD_HD static void stress(const PairConstants<T>& c, const V* acc, V* out) {
    const V trace = acc[6] * (c.lambda * (c.b - c.a) + T(2) * c.mu * c.b);
    for (int i = 0; i < 3; ++i) out[i] = acc[i] * T(2) + trace, out[3 + i] = acc[3 + i];
  }
};

template <class Lanes>
struct PairBody<PairSum::kKelvinStress, Lanes> : StressSums<Lanes> {
  using T = typename Lanes::Number;
  using V = typename Lanes::Vector;
  SHERD_HD static void finish(const PairConstants<T>& c, const V* acc, const V*, V* out) {
    StressSums<Lanes>::stress(c, acc, out);
  }
};

// The target's normal multiplies the summed stress: cheaper than tractions pair by pair.
template <class Lanes>
struct PairBody<PairSum::kKelvinTraction, Lanes> : StressSums<Lanes> {
  using T = typename Lanes::Number;
  using V = typename Lanes::Vector;
  SHERD_HD static void finish(const PairConstants<T>& c, const V* acc, const V* n, V* out) {
    V s[6];
    StressSums<Lanes>::stress(c, acc, s);
    out[0] = s[0] * n[0] + s[5] * n[1] + s[4] * n[2];
    out[1] = s[5] * n[0] + s[1] * n[1] + s[3] * n[2];
    out[2] = s[4] * n[0] + s[3] * n[1] + s[2] * n[2];
  }
};

template <class Lanes>
struct PairBody<PairSum::kElasticValue, Lanes> {
  using T = typename Lanes::Number;
  using V = typename Lanes::Vector;
  static constexpr int kPacked = 12, kAccumulators = 3;  // a f, b f, c w, n
  template <class U>
  SHERD_HD static void pack(const PairConstants<T>& c, const U* s, U* p) {
    for (int i = 0; i < 3; ++i)
      p[i] = s[i] * c.a, p[3 + i] = s[i] * c.b, p[6 + i] = s[3 + i] * c.c, p[9 + i] = s[6 + i];
  }
  template <class P>
  SHERD_HD static void add(const PairConstants<T>&, const V* r, V inverse, const P& p, V* acc) {
    const V e[3] = {r[0] * inverse, r[1] * inverse, r[2] * inverse};
    const V along = dot3(e, p, 3), dipole = dot3(e, p, 9) * inverse;
    for (int i = 0; i < 3; ++i) acc[i] += inverse * (dipole * p[6 + i] + (along * e[i] + p[i]));
  }
  SHERD_HD static void finish(const PairConstants<T>&, const V* acc, const V*, V* out) {
    for (int i = 0; i < 3; ++i) out[i] = acc[i];
  }
};

// l^2 gradient = b (e . f) d_ik + h_i e_k + b e_i f_k + c w_i n_k / l,
// h = -(a f + c g) - 3 b (e . f) e - 3 c (e . n) / l w.
template <class Lanes>
struct PairBody<PairSum::kElasticGradient, Lanes> {
  using T = typename Lanes::Number;
  using V = typename Lanes::Vector;
  static constexpr int kPacked = 21, kAccumulators = 10;  // -(a f + c g), b f, c w, -3 n, c w_i n_k; [3 i + k], trace
  template <class U>
  SHERD_HD static void pack(const PairConstants<T>& c, const U* s, U* p) {
    for (int i = 0; i < 3; ++i) {
      p[i] = s[i] * -c.a - s[3 + i] * c.c, p[3 + i] = s[i] * c.b, p[6 + i] = s[6 + i] * c.c,
      p[9 + i] = s[9 + i] * T(-3);
      for (int k = 0; k < 3; ++k) p[12 + 3 * i + k] = p[6 + i] * s[9 + k];
    }
  }
  template <class P>
  SHERD_HD static void add(const PairConstants<T>&, const V* r, V inverse, const P& p, V* acc) {
    const V e[3] = {r[0] * inverse, r[1] * inverse, r[2] * inverse};
    const V along = dot3(e, p, 3), dipole = dot3(e, p, 9) * inverse, radial = along * T(-3);
    const V square = inverse * inverse, cube = square * inverse;
    const V w[3] = {e[0] * square, e[1] * square, e[2] * square};
    for (int i = 0; i < 3; ++i) {
      const V h = dipole * p[6 + i] + (radial * e[i] + p[i]);
      for (int k = 0; k < 3; ++k) acc[3 * i + k] += h * w[k];
      for (int k = 0; k < 3; ++k) acc[3 * i + k] += w[i] * p[3 + k];
      for (int k = 0; k < 3; ++k) acc[3 * i + k] += cube * p[12 + 3 * i + k];
    }
    acc[9] += along * square;
  }
  SHERD_HD static void finish(const PairConstants<T>&, const V* acc, const V*, V* out) {
    for (int i = 0; i < 9; ++i) out[i] = i % 4 == 0 ? acc[i] + acc[9] : acc[i];
  }
};

}  // namespace sherd::fmm
