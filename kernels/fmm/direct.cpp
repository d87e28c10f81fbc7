#include "kernels/fmm/direct.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "kernels/core/error.h"
#include "kernels/core/parallel.h"

namespace sherd::fmm {
namespace {

constexpr std::size_t kTile = 128, kBlock = 128;  // sources, targets that meet at a time
static_assert(kBlock % kPairPad == 0);

void check_size(const char* what, std::size_t size, std::size_t expected) {
  if (size != expected)
    throw InputError(
        fmt::format("direct sum: {} {} given, {} expected; pass one column after another", size, what, expected));
}
void check_finite(const char* what, std::span<const double> values, std::size_t points) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      throw InputError(
          fmt::format("direct sum: {} of point {} is not finite; remove or repair that point", what, i % points));
}
void check_points(const char* what, const Vec3Column& points) {
  for (const std::vector<Real>* column : {&points.x, &points.y, &points.z}) {
    check_size(what, column->size(), points.size());
    check_finite(what, *column, points.size());
  }
}

void check(const DirectSum& d, std::span<double> out) {
  const PairShape shape = pair_shape(d.sum);
  check_points("source coordinate", d.sources), check_points("target coordinate", d.targets);
  check_size("strengths", d.strengths.size(), shape.strengths * d.sources.size());
  check_finite("strength", d.strengths, d.sources.size());
  if (shape.target_normals) {
    if (!d.target_normals) throw InputError("direct sum: tractions need the targets' normals; pass target_normals");
    check_size("target normals", d.target_normals->size(), d.targets.size());
    check_points("target normal", *d.target_normals);
  }
  if (d.subset)
    for (const std::uint32_t i : *d.subset)
      if (i >= d.targets.size())
        throw InputError(fmt::format("direct sum: no target {} among {}; shorten the subset", i, d.targets.size()));
  check_size("outputs", out.size(), shape.outputs * (d.subset ? d.subset->size() : d.targets.size()));
}

// In the units of the sum: lengths / length, strengths as scale[k] says, results times 1 / unit[k].
struct Units {
  double length = 1;
  std::array<double, kMaxStrengths> scale{};
  std::array<double, kMaxOutputs> unit{};
};

// Results fall with this power of the distance.
int decay(PairSum sum, std::size_t output) {
  switch (sum) {
    case PairSum::kLaplaceValue:
    case PairSum::kKelvinValue:
    case PairSum::kElasticValue:
      return 1;
    case PairSum::kLaplaceGradient:
      return output == 0 ? 1 : 2;
    case PairSum::kDipoleGradient:
      return output == 0 ? 2 : 3;
    default:
      return 2;
  }
}
enum class Strength {
  kPlain,
  kPerLength,
  kNormal
};  // kPerLength: its sum falls by one power more than the plain one's
Strength strength_kind(PairSum sum, std::size_t k) {
  switch (sum) {
    case PairSum::kDipoleValue:
    case PairSum::kDipoleGradient:
      return k == 0 ? Strength::kPlain : Strength::kNormal;
    case PairSum::kElasticValue:
      return k < 3 ? Strength::kPlain : k < 6 ? Strength::kPerLength : Strength::kNormal;
    case PairSum::kElasticGradient:
      return k < 6 ? Strength::kPlain : k < 9 ? Strength::kPerLength : Strength::kNormal;
    default:
      return Strength::kPlain;
  }
}

Units no_units() {
  Units u;
  u.scale.fill(1), u.unit.fill(1);
  return u;
}
Units single_precision_units(const DirectSum& d) {
  Units u = no_units();
  double extent = 0;
  for (const auto& [a, b] :
       {std::pair{&d.sources.x, &d.targets.x}, {&d.sources.y, &d.targets.y}, {&d.sources.z, &d.targets.z}}) {
    const auto [a0, a1] = std::minmax_element(a->begin(), a->end());
    const auto [b0, b1] = std::minmax_element(b->begin(), b->end());
    extent = std::max(extent, std::max(*a1, *b1) - std::min(*a0, *b0));
  }
  if (extent > 0) u.length = extent;
  const std::size_t n = d.sources.size();
  double largest = 0;
  for (std::size_t k = 0; k < pair_shape(d.sum).strengths; ++k) {
    const Strength kind = strength_kind(d.sum, k);
    if (kind == Strength::kNormal) continue;
    if (kind == Strength::kPerLength) u.scale[k] /= u.length;
    for (const double s : d.strengths.subspan(k * n, n)) largest = std::max(largest, std::abs(s * u.scale[k]));
  }
  if (largest == 0) return u;
  for (std::size_t k = 0; k < pair_shape(d.sum).strengths; ++k)
    if (strength_kind(d.sum, k) != Strength::kNormal) u.scale[k] /= largest;
  for (std::size_t k = 0; k < pair_shape(d.sum).outputs; ++k) u.unit[k] = largest / std::pow(u.length, decay(d.sum, k));
  return u;
}

// Order in which consecutive tiles are compact: halves along the longest side, cut between tiles.
void split(const Vec3Column& points, std::span<std::uint32_t> order) {
  const std::size_t tiles = (order.size() + kTile - 1) / kTile;
  if (tiles < 2) return;
  Vec3 low = points[order[0]], high = low;
  for (const std::uint32_t i : order) low = min(low, points[i]), high = max(high, points[i]);
  const Vec3 side = high - low;
  const std::vector<Real>& along = side.x >= side.y && side.x >= side.z ? points.x
                                   : side.y >= side.z                   ? points.y
                                                                        : points.z;
  const std::size_t middle = tiles / 2 * kTile;
  std::nth_element(
      order.begin(), order.begin() + static_cast<std::ptrdiff_t>(middle), order.end(),
      [&](std::uint32_t i, std::uint32_t j) { return along[i] != along[j] ? along[i] < along[j] : i < j; });
  split(points, order.first(middle)), split(points, order.subspan(middle));
}

// The sources in tiles, in the sum's units, about each tile's centre.
template <class T>
struct Sources {
  std::size_t count = 0;
  std::array<std::vector<T>, 3> x;
  std::array<std::vector<T>, kMaxStrengths> strength;
  std::vector<Vec3> centre;  // of a tile

  Sources(const DirectSum& d, const Units& u, bool centred) : count(d.sources.size()) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    if (centred) split(d.sources, order);
    const std::size_t strengths = pair_shape(d.sum).strengths;
    for (auto& column : x) column.resize(count);
    for (std::size_t k = 0; k < strengths; ++k) strength[k].resize(count);
    centre.resize((count + kTile - 1) / kTile);
    parallel_for_chunks(count, kTile, [&](std::size_t begin, std::size_t end) {
      Vec3 low = d.sources[order[begin]], high = low;
      for (std::size_t j = begin; j < end; ++j)
        low = min(low, d.sources[order[j]]), high = max(high, d.sources[order[j]]);
      const Vec3 middle = centred ? low + (high - low) * 0.5 : Vec3{};
      centre[begin / kTile] = middle;
      for (std::size_t j = begin; j < end; ++j) {
        const Vec3 y = (d.sources[order[j]] - middle) / u.length;
        for (int k = 0; k < 3; ++k) x[static_cast<std::size_t>(k)][j] = static_cast<T>(y[k]);
        for (std::size_t k = 0; k < strengths; ++k)
          strength[k][j] = static_cast<T>(d.strengths[k * count + order[j]] * u.scale[k]);
      }
    });
  }
  PairSources<T> tile(std::size_t begin) const {
    PairSources<T> s{std::min(kTile, count - begin), {}, {}};
    for (std::size_t k = 0; k < 3; ++k) s.x[k] = x[k].data() + begin;
    for (std::size_t k = 0; k < kMaxStrengths; ++k)
      s.strength[k] = strength[k].empty() ? nullptr : strength[k].data() + begin;
    return s;
  }
};

// Up to kBlock targets and what they have received.
template <class T>
struct Block {
  Vec3 point[kBlock];
  T x[3][kBlock]{}, normal[3][kBlock]{}, partial[kMaxOutputs][kBlock];
  double total[kMaxOutputs][kBlock]{};
};

template <class T>
void sum_block(const DirectSum& d, const Units& u, const Sources<T>& sources, std::size_t begin, std::size_t end,
               std::span<double> out) {
  const PairShape shape = pair_shape(d.sum);
  const std::size_t count = end - begin, all = out.size() / shape.outputs, padded = padded_count(count);
  const PairFunction<T> function = pair_function<T>(d.sum, d.instructions);
  const PairConstants<T> constants{static_cast<T>(d.constants.a), static_cast<T>(d.constants.b),
                                   static_cast<T>(d.constants.c), static_cast<T>(d.constants.lambda),
                                   static_cast<T>(d.constants.mu)};
  Block<T> b;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t target = d.subset ? (*d.subset)[begin + i] : begin + i;
    b.point[i] = d.targets[target];
    if (shape.target_normals)
      for (int k = 0; k < 3; ++k) b.normal[k][i] = static_cast<T>((*d.target_normals)[target][k]);
  }
  const PairTargets<T> targets{padded, {b.x[0], b.x[1], b.x[2]}, {b.normal[0], b.normal[1], b.normal[2]}};
  T* partial[kMaxOutputs];
  for (std::size_t k = 0; k < kMaxOutputs; ++k) partial[k] = b.partial[k];
  const T shift[3]{};
  for (std::size_t tile = 0; tile < sources.centre.size(); ++tile) {
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 x = (b.point[i] - sources.centre[tile]) / u.length;
      for (int k = 0; k < 3; ++k) b.x[k][i] = static_cast<T>(x[k]);
    }
    for (std::size_t k = 0; k < shape.outputs; ++k) std::fill_n(b.partial[k], padded, T(0));
    function(sources.tile(tile * kTile), targets, shift, constants, partial);
    for (std::size_t k = 0; k < shape.outputs; ++k)
      for (std::size_t i = 0; i < count; ++i) b.total[k][i] += static_cast<double>(b.partial[k][i]);
  }
  for (std::size_t k = 0; k < shape.outputs; ++k)
    for (std::size_t i = 0; i < count; ++i) out[k * all + begin + i] = b.total[k][i] * u.unit[k];
}

template <class T>
void run(const DirectSum& d, const Units& u, bool centred, std::span<double> out) {
  const Sources<T> sources(d, u, centred);
  const std::size_t targets = out.size() / pair_shape(d.sum).outputs;
  parallel_for_chunks(targets, kBlock,
                      [&](std::size_t begin, std::size_t end) { sum_block(d, u, sources, begin, end, out); });
}

}  // namespace

void direct_sum(const DirectSum& d, std::span<double> out) {
  check(d, out);
  if (d.sources.empty() || out.empty()) {
    std::fill(out.begin(), out.end(), 0.0);
    return;
  }
  // In double the difference of the coordinates as given is exact to rounding; shifting or scaling them would not be.
  if (d.precision == Precision::kDouble)
    run<double>(d, no_units(), false, out);
  else
    run<float>(d, single_precision_units(d), true, out);
}

}  // namespace sherd::fmm
