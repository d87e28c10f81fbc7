// Included by one translation unit per processor, with SHERD_LANE_KERNELS naming its table and SHERD_LANE_WIDTH the
// lanes of one register. Internal linkage throughout.
#include <cmath>
#if SHERD_LANE_WIDTH == 8
#include <immintrin.h>
#endif

#include "engine/elastostatic/lane_kernels.h"

namespace sherd {
namespace {

constexpr std::size_t kWidth = SHERD_LANE_WIDTH;
constexpr int kFreedoms = kPanelFreedoms;
using V [[gnu::vector_size(8 * SHERD_LANE_WIDTH)]] = double;

inline V load(const double* p) {
  V v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}
inline void store(double* p, V v) {
  __builtin_memcpy(p, &v, sizeof v);
}
// 1 / sqrt(a) to rounding where a is above `least`, else 0.
#if SHERD_LANE_WIDTH == 8
// The processor's estimate is within 2^-14, so d <= 1.3e-4: 7e-17 after the series of (1 - d)^(-1/2) to d^3. Half the
// time of root and division.
inline V inverse_root_above(V a, double least) {
  const V y = _mm512_maskz_rsqrt14_pd(_mm512_cmp_pd_mask(a, _mm512_set1_pd(least), _CMP_GT_OQ), a);
  const V d = 1 - (a * y) * y;
  return (y * d) * ((d * 0.3125 + 0.375) * d + 0.5) + y;
}
#else
inline V inverse_root_above(V a, double least) {
  V r;
  for (std::size_t k = 0; k < kWidth; ++k) r[k] = a[k] > least ? 1 / std::sqrt(a[k]) : 0;
  return r;
}
#endif

}  // namespace
}  // namespace sherd

#include "engine/elastostatic/lane_moments_source.h"

namespace sherd {
namespace {

// Kernel (order xx, yy, zz, yz, xz, xy) and double layer of a point at the targets x, times w.
inline void point_values(const V x[3], const double* y, const double* n, V w, const LaneConstants& c, V kernel[6],
                         V& angle) {
  const V r0 = x[0] - y[0], r1 = x[1] - y[1], r2 = x[2] - y[2];
  const V inverse = inverse_root_above(r0 * r0 + r1 * r1 + r2 * r2, 0);
  const V scaled = inverse * w, cube = scaled * inverse * inverse, diagonal = scaled * c.one, dyad = cube * c.two;
  const V d0 = dyad * r0, d1 = dyad * r1, d2 = dyad * r2;
  kernel[0] = diagonal + d0 * r0, kernel[1] = diagonal + d1 * r1, kernel[2] = diagonal + d2 * r2;
  kernel[3] = d1 * r2, kernel[4] = d0 * r2, kernel[5] = d0 * r1;
  angle = cube * (r0 * n[0] + r1 * n[1] + r2 * n[2]) * c.angle;
}

inline void multiply(const V k[6], const double* v, V out[3]) {
  out[0] = k[0] * v[0] + k[5] * v[1] + k[4] * v[2];
  out[1] = k[5] * v[0] + k[1] * v[1] + k[3] * v[2];
  out[2] = k[4] * v[0] + k[3] * v[1] + k[2] * v[2];
}

// M u = sum over freedoms (grad N_a n^T - n grad N_a^T) u_a: the panel's blocks go to its freedoms.
template <int N>
inline void scatter(const LanePanel& f, const V kernel[][6], const V angle[kFreedoms], const double (*table_s)[N],
                    const double (*table_t)[N], const std::uint32_t* local, double* freedoms) {
  V ks[3][N], kt[3][N], kn[3][N];
  for (int b = 0; b < N; ++b) {
    V s[3], t[3], n[3];
    multiply(kernel[b], f.gradient_s, s), multiply(kernel[b], f.gradient_t, t), multiply(kernel[b], f.normal, n);
    for (int i = 0; i < 3; ++i) ks[i][b] = s[i], kt[i][b] = t[i], kn[i][b] = n[i];
  }
  for (int i = 0; i < 3; ++i)
    for (int a = 0; a < kFreedoms; ++a) {
      V p{}, vs{}, vt{};
      for (int b = 0; b < N; ++b) {
        const double s = table_s[a][b], t = table_t[a][b];
        p += ks[i][b] * s + kt[i][b] * t;
        vs += kn[i][b] * s, vt += kn[i][b] * t;
      }
      double* block = freedoms + kLaneBlock * local[a] + 3 * kLanes * static_cast<std::size_t>(i);
      for (int j = 0; j < 3; ++j) {
        V v = load(block + kLanes * static_cast<std::size_t>(j)) + p * f.normal[j] - vs * f.gradient_s[j] -
              vt * f.gradient_t[j];
        if (i == j) v += angle[a];
        store(block + kLanes * static_cast<std::size_t>(j), v);
      }
    }
}

template <int N>
inline void points(const LanePanel& f, const double (*y)[3], const double (*table_s)[N], const double (*table_t)[N],
                   const double (*shape)[N], const LaneConstants& c, const double* x, const double* mask,
                   const std::uint32_t* local, double* freedoms, double* total) {
  for (std::size_t h = 0; h < kLanes; h += kWidth) {
    const V target[3] = {load(x + h), load(x + kLanes + h), load(x + 2 * kLanes + h)};
    const V w = mask ? load(mask + h) * f.area : V{} + f.area;
    V kernel[N][6], value[N], angle[kFreedoms], sum = load(total + h);
    for (int q = 0; q < N; ++q) {
      point_values(target, y[q], f.normal, w, c, kernel[q], value[q]);
    }
    for (int a = 0; a < kFreedoms; ++a) {
      angle[a] = V{};
      for (int q = 0; q < N; ++q) angle[a] += value[q] * shape[a][q];
      if (a < 3) sum += angle[a];  // the vertices' shape functions add up to 1
    }
    store(total + h, sum);
    scatter<N>(f, kernel, angle, table_s, table_t, local, freedoms + h);
  }
}

void three_points(const LanePanel& f, const LaneTables& t, const LaneConstants& c, const double* x,
                  const std::uint32_t* local, double* freedoms, double* total) {
  points<3>(f, f.three, t.three_s, t.three_t, t.three_shape, c, x, nullptr, local, freedoms, total);
}

void six_points(const LanePanel& f, const LaneTables& t, const LaneConstants& c, const double* x, const double* mask,
                const std::uint32_t* local, double* freedoms, double* total) {
  points<6>(f, f.six, t.six_s, t.six_t, t.six_shape, c, x, mask, local, freedoms, total);
}

void moments(const LanePanel& f, const LaneTables& t, const LaneMoments& m, const std::uint32_t* local,
             double* freedoms, double* total) {
  for (std::size_t h = 0; h < kLanes; h += kWidth) {
    V kernel[6][6], moment[10], angle[kFreedoms];
    for (int b = 0; b < 6; ++b)
      for (int k = 0; k < 6; ++k) kernel[b][k] = load(m.kernel[b][k] + h);
    for (int b = 0; b < 10; ++b) moment[b] = load(m.angle[b] + h);
    store(total + h, load(total + h) + moment[0]);
    for (int a = 0; a < kFreedoms; ++a) {
      angle[a] = V{};
      for (int b = 0; b < 10; ++b) angle[a] += moment[b] * t.monomial_shape[a][b];
    }
    scatter<6>(f, kernel, angle, t.monomial_s, t.monomial_t, local, freedoms + h);
  }
}

inline void add_block(double* out, const double* in, double w) {
  for (std::size_t i = 0; i < kLaneBlock; i += kWidth) store(out + i, load(out + i) + load(in + i) * w);
}

// What the freedoms load a corner's gradient with, [row][column]: the sums over its terms of x and y times the blocks,
// plus those of z times the blocks and the frames.
inline void load_corner(const LaneGather& g, const LaneGather::Corner& c, const double* freedoms, V gx[9], V gy[9]) {
  for (std::size_t i = 0; i < 9; i += 3) {
    V sx[3]{}, sy[3]{}, sz[3]{};
    for (std::uint32_t e = c.first_term; e < c.last_term; ++e) {
      const LaneGather::Term& t = g.terms[e];
      const double* in = freedoms + kLaneBlock * t.freedom + kLanes * i;
      for (std::size_t j = 0; j < 3; ++j) {
        const V v = load(in + kLanes * j);
        sx[j] += v * t.x, sy[j] += v * t.y, sz[j] += v * t.z;
      }
    }
    const double *fx = c.frame_x, *fy = c.frame_y;
    for (std::size_t j = 0; j < 3; ++j) {
      gx[i + j] = sx[j] + sz[0] * fx[j] + sz[1] * fx[3 + j] + sz[2] * fx[6 + j];
      gy[i + j] = sy[j] + sz[0] * fy[j] + sz[1] * fy[3 + j] + sz[2] * fy[6 + j];
    }
  }
}

void gather(const LaneGather& g, const double* freedoms, double* vertices) {
  for (std::size_t k = 0; k < g.entry_count; ++k)
    add_block(vertices + kLaneBlock * g.entries[k].vertex, freedoms + kLaneBlock * g.entries[k].freedom,
              g.entries[k].weight);
  for (std::size_t k = 0; k < g.corner_count; ++k)
    for (std::size_t h = 0; h < kLanes; h += kWidth) {
      const LaneGather::Corner& c = g.corners[k];
      V gx[9], gy[9];
      load_corner(g, c, freedoms + h, gx, gy);
      for (std::uint32_t e = c.first_gradient; e < c.last_gradient; ++e) {
        const LaneGather::Gradient& r = g.gradients[e];
        double* out = vertices + kLaneBlock * r.vertex + h;
        for (std::size_t i = 0; i < 9; ++i) store(out + kLanes * i, load(out + kLanes * i) + gx[i] * r.x + gy[i] * r.y);
      }
    }
}

void kelvin_sum(const LaneSources& s, double ratio, double least, const double* x, const double* weight, double* u) {
  for (std::size_t h = 0; h < kLanes; h += kWidth) {
    const V x0 = load(x + h), x1 = load(x + kLanes + h), x2 = load(x + 2 * kLanes + h), w = load(weight + h);
    V u0{}, u1{}, u2{};
    for (std::size_t i = 0; i < s.count; ++i) {
      const V r0 = x0 - s.x[i], r1 = x1 - s.y[i], r2 = x2 - s.z[i];
      const V inverse = inverse_root_above(r0 * r0 + r1 * r1 + r2 * r2, least);
      const V radial = (r0 * s.fx[i] + r1 * s.fy[i] + r2 * s.fz[i]) * (inverse * inverse) * inverse,
              direct = inverse * ratio;
      u0 += direct * s.fx[i], u1 += direct * s.fy[i], u2 += direct * s.fz[i];
      u0 += radial * r0, u1 += radial * r1, u2 += radial * r2;
    }
    store(u + h, load(u + h) + w * u0), store(u + kLanes + h, load(u + kLanes + h) + w * u1);
    store(u + 2 * kLanes + h, load(u + 2 * kLanes + h) + w * u2);
  }
}

void gradient_sum(const LaneElements& s, double kelvin, double ratio, double least, const double* x, double* gradient) {
  constexpr double kQuarterPi = 0.079577471545947667884;  // 1 / (4 pi)
  for (std::size_t h = 0; h < kLanes; h += kWidth) {
    const V x0 = load(x + h), x1 = load(x + kLanes + h), x2 = load(x + 2 * kLanes + h);
    V g[3][3];
    for (std::size_t i = 0; i < 9; ++i) g[i / 3][i % 3] = load(gradient + i * kLanes + h);
    for (std::size_t p = 0; p < s.count; ++p) {
      const V r[3] = {x0 - s.y[0][p], x1 - s.y[1][p], x2 - s.y[2][p]};
      const V l2 = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
      const V inverse = inverse_root_above(l2, least);
      const V inverse2 = inverse * inverse, inverse3 = inverse2 * inverse, c = inverse3 * kelvin;
      const double f[3] = {s.density[0][p], s.density[1][p], s.density[2][p]};
      const V rf = r[0] * f[0] + r[1] * f[1] + r[2] * f[2], radial = rf * inverse2 * -3;
      // c / l^3 [ -(3 - 4 nu) f_i r_k + r_i f_k + (r f) d_ik - 3 (r f) r_i r_k / l^2 ]
      const V a = inverse3 * -kQuarterPi;  // gradient of 1/l over 4 pi: a r
      const V an = a * (r[0] * s.normal[0][p] + r[1] * s.normal[1][p] + r[2] * s.normal[2][p]);
      for (int i = 0; i < 3; ++i) {
        const double *row0 = s.gradient[3 * i], *row1 = s.gradient[3 * i + 1], *row2 = s.gradient[3 * i + 2];
        const V ga = (r[0] * row0[p] + r[1] * row1[p] + r[2] * row2[p]) * a;
        const V along = c * (radial * r[i] - ratio * f[i]) + a * s.guenter[i][p], ri = c * r[i];
        for (int k = 0; k < 3; ++k)
          g[i][k] += along * r[k] + ri * f[k] + an * s.gradient[3 * i + k][p] - ga * s.normal[k][p];
        g[i][i] += c * rf;
      }
    }
    for (std::size_t i = 0; i < 9; ++i) store(gradient + i * kLanes + h, g[i / 3][i % 3]);
  }
}

void add_weighted(const double* in, const double* weight, const std::uint32_t* local, double* freedoms) {
  for (int a = 0; a < kFreedoms; ++a) add_block(freedoms + kLaneBlock * local[a], in, weight[a]);
}

}  // namespace

extern const LaneKernels SHERD_LANE_KERNELS;
const LaneKernels SHERD_LANE_KERNELS = {three_points, six_points, moments,      panel_moments,
                                        gather,       kelvin_sum, gradient_sum, add_weighted};

}  // namespace sherd
