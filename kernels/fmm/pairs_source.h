// Included by one translation unit per processor, which defines SHERD_PAIRS_NAME, its table, SHERD_PAIRS_BYTES, the
// size of one register, and SHERD_PAIRS_ROOT, which reciprocal square root it uses. Internal linkage throughout: code
// shared with other translation units must not be compiled for a processor that may be absent.
#include "kernels/fmm/pairs_table.h"
#include "kernels/fundamental/pair_bodies.h"

#define SHERD_ROOT_PORTABLE 0
#define SHERD_ROOT_AVX2 1
#define SHERD_ROOT_AVX512 2
#if SHERD_PAIRS_ROOT != SHERD_ROOT_PORTABLE
#include <immintrin.h>
#endif

namespace sherd::fmm {
namespace {

using FloatVector [[gnu::vector_size(SHERD_PAIRS_BYTES)]] = float;
using DoubleVector [[gnu::vector_size(SHERD_PAIRS_BYTES)]] = double;

// 1 / sqrt(a) from an estimate y: one Newton step, y (1 + d/2) with d = 1 - a y^2. Relative error 3/8 d^2.
template <class V>
inline V newton(V a, V y) {
  using T = decltype(a[0] + 0);
  const V d = T(1) - (a * y) * y;
  return (y * T(0.5)) * d + y;
}
// The series of (1 - d)^(-1/2) to d^3; relative error 35/128 d^4.
template <class V>
inline V quartic(V a, V y) {
  using T = decltype(a[0] + 0);
  const V d = T(1) - (a * y) * y;
  return (y * d) * ((d * T(0.3125) + T(0.375)) * d + T(0.5)) + y;
}
inline float root(float a) {
  return __builtin_sqrtf(a);
}
inline double root(double a) {
  return __builtin_sqrt(a);
}
template <class V>
inline V by_division(V a) {
  using T = decltype(a[0] + 0);
  V roots;
  for (std::size_t k = 0; k < sizeof(V) / sizeof(T); ++k) roots[k] = root(a[k]);
  constexpr T least = least_square<T>();
  const V inverse = T(1) / roots;
  return a > least ? inverse : V{};
}

// Constants, as calls of shared inline functions could be left in unoptimized builds.
[[maybe_unused]] constexpr float kLeastSingle = least_square<float>();
[[maybe_unused]] constexpr double kLeastDouble = least_square<double>();

inline FloatVector inverse_root(FloatVector a) {
#if SHERD_PAIRS_ROOT == SHERD_ROOT_AVX512
  // Estimate within 2^-14: 1e-8 after the step, so rounding decides.
  const __mmask16 apart = _mm512_cmp_ps_mask(a, _mm512_set1_ps(kLeastSingle), _CMP_GT_OQ);
  return newton<FloatVector>(a, _mm512_maskz_rsqrt14_ps(apart, a));
#elif SHERD_PAIRS_ROOT == SHERD_ROOT_AVX2
  // Estimate within 1.5 2^-12: 2e-7 after the step.
  const __m256 apart = _mm256_cmp_ps(a, _mm256_set1_ps(kLeastSingle), _CMP_GT_OQ);
  return newton<FloatVector>(a, _mm256_and_ps(apart, _mm256_rsqrt_ps(a)));
#else
  return by_division(a);
#endif
}
inline DoubleVector inverse_root(DoubleVector a) {
#if SHERD_PAIRS_ROOT == SHERD_ROOT_AVX512
  // Estimate within 2^-14, so d <= 1.3e-4: 7e-17 after the step.
  const __mmask8 apart = _mm512_cmp_pd_mask(a, _mm512_set1_pd(kLeastDouble), _CMP_GT_OQ);
  return quartic<DoubleVector>(a, _mm512_maskz_rsqrt14_pd(apart, a));
#else
  return by_division(a);
#endif
}

template <class N, class V>
struct Lanes {
  using Number = N;
  using Vector = V;
};
using FloatLanes = Lanes<float, FloatVector>;
using DoubleLanes = Lanes<double, DoubleVector>;

template <class V, class T>
inline V load(const T* p) {
  V v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}
template <class V, class T>
inline void add_to(T* p, V v) {
  v += load<V>(p);
  __builtin_memcpy(p, &v, sizeof v);
}

// A tile of packed sources: rows of kTile numbers at fixed distances, so that the loop over pairs needs one pointer.
constexpr std::size_t kTile = 128;
template <class T>
struct Column {
  const T* at;
  T operator[](int k) const { return at[static_cast<std::size_t>(k) * kTile]; }
};

template <PairSum S, class L>
struct Tile {
  using T = typename L::Number;
  using V = typename L::Vector;
  using Body = PairBody<S, L>;
  static constexpr PairShape kShape = pair_shape(S);
  static constexpr std::size_t kWidth = sizeof(V) / sizeof(T), kStrengths = kShape.strengths,
                               kRows = 3 + static_cast<std::size_t>(Body::kPacked);
  static_assert(kTile % kWidth == 0 && kPairPad % kWidth == 0);

  // Up to kTile sources from `first`. Lanes after the last hold zeros, which nobody reads.
  void fill(const PairSources<T>& s, std::size_t first, std::size_t count, const PairConstants<T>& constants) {
    for (std::size_t j = 0; j < count; j += kWidth) {
      const std::size_t lanes = count - j < kWidth ? count - j : kWidth;
      V strength[kStrengths], packed[static_cast<std::size_t>(Body::kPacked)];
      for (std::size_t k = 0; k < 3; ++k) put(k, j, part(s.x[k] + first + j, lanes));
      for (std::size_t k = 0; k < kStrengths; ++k) strength[k] = part(s.strength[k] + first + j, lanes);
      Body::pack(constants, strength, packed);
      for (std::size_t k = 3; k < kRows; ++k) put(k, j, packed[k - 3]);
    }
  }
  static V part(const T* p, std::size_t lanes) {
    if (lanes == kWidth) return load<V>(p);
    V v{};
    for (std::size_t k = 0; k < lanes; ++k) v[k] = p[k];
    return v;
  }
  void put(std::size_t row, std::size_t j, V v) { __builtin_memcpy(row_ + row * kTile + j, &v, sizeof v); }

  // What kVectors registers of targets from `i` receive from the first `count` sources.
  template <std::size_t kVectors>
  void sum(std::size_t count, const PairTargets<T>& targets, std::size_t i, const T* shift,
           const PairConstants<T>& constants, T* const* out) const {
    constexpr std::size_t kSums = static_cast<std::size_t>(Body::kAccumulators);
    V x[kVectors][3], acc[kVectors][kSums];
    for (std::size_t v = 0; v < kVectors; ++v) {
      for (std::size_t k = 0; k < 3; ++k) x[v][k] = load<V>(targets.x[k] + i + v * kWidth) + shift[k];
      for (std::size_t k = 0; k < kSums; ++k) acc[v][k] = V{};
    }
    for (std::size_t j = 0; j < count; ++j) {
      const Column<T> y{row_ + j}, p{row_ + 3 * kTile + j};
      for (std::size_t v = 0; v < kVectors; ++v) {
        const V r[3] = {x[v][0] - y[0], x[v][1] - y[1], x[v][2] - y[2]};
        Body::add(constants, r, inverse_root(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]), p, acc[v]);
      }
    }
    for (std::size_t v = 0; v < kVectors; ++v) {
      V normal[3]{}, result[kShape.outputs];
      if constexpr (kShape.target_normals)
        for (std::size_t k = 0; k < 3; ++k) normal[k] = load<V>(targets.normal[k] + i + v * kWidth);
      Body::finish(constants, acc[v], normal, result);
      for (std::size_t k = 0; k < kShape.outputs; ++k) add_to(out[k] + i + v * kWidth, result[k]);
    }
  }

 private:
  alignas(64) T row_[kRows * kTile];
};

template <PairSum S, class L>
void pair_sum(const PairSources<typename L::Number>& sources, const PairTargets<typename L::Number>& targets,
              const typename L::Number shift[3], const PairConstants<typename L::Number>& constants,
              typename L::Number* const out[]) {
  using Block = Tile<S, L>;
  // Registers of targets that share a source's broadcasts, as far as the accumulators stay in registers.
  constexpr std::size_t kVectors = SHERD_PAIRS_VECTORS(Block::Body::kAccumulators), kStep = kVectors * Block::kWidth;
  const PairConstants<typename L::Number> c = constants;
  Block tile;
  for (std::size_t first = 0; first < sources.count; first += kTile) {
    const std::size_t count = sources.count - first < kTile ? sources.count - first : kTile;
    tile.fill(sources, first, count, c);
    std::size_t i = 0;
    for (; i + kStep <= targets.count; i += kStep) tile.template sum<kVectors>(count, targets, i, shift, c, out);
    for (; i < targets.count; i += Block::kWidth) tile.template sum<1>(count, targets, i, shift, c, out);
  }
}

template <class L>
constexpr PairTable<typename L::Number> make_table() {
  return {{pair_sum<PairSum::kLaplaceValue, L>, pair_sum<PairSum::kLaplaceGradient, L>,
           pair_sum<PairSum::kDipoleValue, L>, pair_sum<PairSum::kDipoleGradient, L>,
           pair_sum<PairSum::kKelvinValue, L>, pair_sum<PairSum::kKelvinGradient, L>,
           pair_sum<PairSum::kKelvinStress, L>, pair_sum<PairSum::kKelvinTraction, L>,
           pair_sum<PairSum::kElasticValue, L>, pair_sum<PairSum::kElasticGradient, L>}};
}

}  // namespace

extern const PairTables SHERD_PAIRS_NAME;
const PairTables SHERD_PAIRS_NAME = {make_table<FloatLanes>(), make_table<DoubleLanes>()};

}  // namespace sherd::fmm
