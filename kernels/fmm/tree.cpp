#include "kernels/fmm/tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/core/error.h"
#include "kernels/core/parallel.h"

namespace sherd::fmm {
namespace {

constexpr std::size_t kGrain = 1 << 14;
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
constexpr Real kLargest = 1e307;

struct Bounds {
  Vec3 low{kLargest, kLargest, kLargest}, high = -low;
  std::size_t bad = kNone;  // first point outside the coordinates' range
};

Bounds bounds_of(const Vec3Column& points, std::size_t begin, std::size_t end) {
  Bounds b;
  for (std::size_t i = begin; i < end; ++i) {
    const Vec3 p = points[i];
    // Written so that NaN fails.
    const bool good = std::abs(p.x) <= kLargest && std::abs(p.y) <= kLargest && std::abs(p.z) <= kLargest;
    if (!good) {
      b.bad = i;
      return b;
    }
    b.low = min(b.low, p), b.high = max(b.high, p);
  }
  return b;
}

Bounds bounds_of(const Vec3Column& points, const char* name) {
  if (points.y.size() != points.size() || points.z.size() != points.size() ||
      points.size() >= std::numeric_limits<Tree::Index>::max())
    throw InputError(
        fmt::format("fast multipole method: {} points have {}, {} and {} coordinates; equal numbers below "
                    "2^32 - 1 are needed",
                    name, points.x.size(), points.y.size(), points.z.size()));
  std::vector<Bounds> part((points.size() + kGrain - 1) / kGrain);
  parallel_for_chunks(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    part[begin / kGrain] = bounds_of(points, begin, end);
  });
  Bounds all;
  for (const Bounds& b : part) {
    if (b.bad != kNone) {
      const Vec3 p = points[b.bad];
      throw InputError(
          fmt::format("fast multipole method: {} point {} is ({}, {}, {}); coordinates must be finite and "
                      "at most {} in size; correct or remove the point",
                      name, b.bad, p.x, p.y, p.z, kLargest));
    }
    all.low = min(all.low, b.low), all.high = max(all.high, b.high);
  }
  return all;
}

// Coordinate -> digits. A power of two brings the largest coordinate near 1 first, so that nothing overflows and points
// scaled by powers of two get the same keys. The low corner is subtracted before the margin is added, so that a
// translation that is exact leaves the keys as they are.
struct Grid {
  Real scale = 1, margin = 0, cells = 0;
  Vec3 low;  // of the points, scaled

  std::uint64_t cell(Real x, Real low_x) const {
    return std::min(static_cast<std::uint64_t>(((x * scale - low_x) + margin) * cells),
                    (std::uint64_t{1} << kMaxDepth) - 1);
  }
};

// Two zero bits after each of the low 21.
std::uint64_t spread(std::uint64_t v) {
  v = (v | v << 32) & 0x1F00000000FFFFull;
  v = (v | v << 16) & 0x1F0000FF0000FFull;
  v = (v | v << 8) & 0x100F00F00F00F00Full;
  v = (v | v << 4) & 0x10C30C30C30C30C3ull;
  return (v | v << 2) & 0x1249249249249249ull;
}

void sort_points(const Vec3Column& points, const Grid& grid, std::vector<std::uint64_t>& keys,
                 std::vector<std::uint32_t>& order) {
  const std::size_t n = points.size();
  std::vector<KeyedIndex> items(n);
  parallel_for(n, kGrain, [&](std::size_t i) {
    const Vec3 p = points[i];
    items[i] = {spread(grid.cell(p.x, grid.low.x)) | spread(grid.cell(p.y, grid.low.y)) << 1 |
                    spread(grid.cell(p.z, grid.low.z)) << 2,
                static_cast<std::uint32_t>(i)};
  });
  parallel_sort(items);
  keys.resize(n), order.resize(n);
  parallel_for(n, kGrain, [&](std::size_t i) { keys[i] = items[i].key, order[i] = items[i].index; });
}

Real largest(const Vec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

// The cube holds the points with a margin, at its low corner: at the centre a nearly plane set would straddle the first
// cut. The margin is no power of two of the side, so the lowest points lie in no cut either. The cube is never smaller
// than 2^-26 of the largest coordinate, so that the smallest boxes (2^-46) stay well above the coordinates' rounding,
// nor so small that their sides leave the normal numbers.
Grid grid_of(const Bounds& bounds, Real stretch, SortedPoints& points) {
  constexpr Real kRelative = 0x1p-26, kSmallest = 0x1p-1000, kMargin = 1.3 * 0x1p-12;
  const Real reach = std::max(largest(bounds.low), largest(bounds.high));
  if (reach == 0) {
    points.size = 1;
    points.low = Vec3{-0.5, -0.5, -0.5};
    return {1, 0.5, std::ldexp(1.0, kMaxDepth), {}};
  }
  Grid grid;
  const int exponent = std::clamp(std::ilogb(reach), -1000, 1000);
  grid.scale = std::ldexp(1.0, -exponent);
  grid.low = bounds.low * grid.scale;
  const Real extent = largest(bounds.high * grid.scale - grid.low);
  const Real size =
      std::max(std::max(extent, kRelative * (reach * grid.scale)) * (stretch * (1 + 0x1p-10)), kSmallest * grid.scale);
  grid.margin = size * kMargin;
  grid.cells = std::ldexp(1.0, kMaxDepth) / size;
  points.size = std::ldexp(size, exponent);
  const Real margin = std::ldexp(grid.margin, exponent);
  points.low = bounds.low - Vec3{margin, margin, margin};
  return grid;
}

bool separable(const std::vector<std::uint64_t>& keys, const Tree::Range& range, std::size_t leaf_size) {
  return range.size() > leaf_size && keys[range.begin] != keys[range.end - 1];
}

// First place behind the points of octants 0 .. o, for each o.
std::array<Tree::Index, 8> octant_ends(const std::vector<std::uint64_t>& keys, const Tree::Range& range, int shift) {
  std::array<Tree::Index, 8> ends;
  const auto last = keys.begin() + range.end;
  auto place = keys.begin() + range.begin;
  for (unsigned o = 0; o < 8; ++o) {
    place = std::partition_point(place, last, [&](std::uint64_t key) { return ((key >> shift) & 7) <= o; });
    ends[o] = static_cast<Tree::Index>(place - keys.begin());
  }
  return ends;
}

}  // namespace

SortedPoints::SortedPoints(const Vec3Column& sources, const Vec3Column& targets, Real stretch)
    : same(&sources == &targets || sources == targets) {
  SHERD_CHECK(stretch >= 1 && stretch <= 2, "stretch {}", stretch);
  Bounds bounds = bounds_of(sources, "source");
  if (!same) {
    const Bounds more = bounds_of(targets, "target");
    bounds.low = min(bounds.low, more.low), bounds.high = max(bounds.high, more.high);
  }
  if (sources.empty() && targets.empty()) bounds.low = bounds.high = Vec3{};
  const Grid grid = grid_of(bounds, stretch, *this);
  sort_points(sources, grid, source_keys, source_order);
  if (same) {
    target_keys = source_keys, target_order = source_order;
  } else {
    sort_points(targets, grid, target_keys, target_order);
  }
}

Tree::Tree(const SortedPoints& points, const TreeOptions& options)
    : low(points.low),
      size(points.size),
      level_begin{0},
      source_order(points.source_order),
      target_order(points.target_order) {
  const Range all_sources{0, static_cast<Index>(source_order.size())};
  const Range all_targets{0, static_cast<Index>(target_order.size())};
  if (all_sources.size() + std::size_t{all_targets.size()} == 0) return;
  level.push_back(0), anchor.push_back({0, 0, 0}), parent.push_back(0), children.push_back({});
  sources.push_back(all_sources), targets.push_back(all_targets);
  while (level_begin.back() < box_count()) {
    const Index begin = level_begin.back(), end = static_cast<Index>(box_count());
    level_begin.push_back(end);
    for (Index box = begin; box < end; ++box)
      if (separable(points.source_keys, sources[box], options.leaf_size) ||
          separable(points.target_keys, targets[box], options.leaf_size))
        split(box, points);
  }
}

void Tree::add_box(Index parent_box, unsigned octant, Range source_range, Range target_range) {
  const std::array<std::uint32_t, 3> a = anchor[parent_box];
  level.push_back(static_cast<std::uint8_t>(level[parent_box] + 1));
  anchor.push_back({2 * a[0] + (octant & 1), 2 * a[1] + (octant >> 1 & 1), 2 * a[2] + (octant >> 2)});
  parent.push_back(parent_box);
  children.push_back({});
  sources.push_back(source_range), targets.push_back(target_range);
}

// Boxes at kMaxDepth have one key, so they are never split.
void Tree::split(Index box, const SortedPoints& points) {
  const int shift = 3 * (kMaxDepth - 1 - level[box]);
  const auto source_ends = octant_ends(points.source_keys, sources[box], shift);
  const auto target_ends = points.same ? source_ends : octant_ends(points.target_keys, targets[box], shift);
  const Index first = static_cast<Index>(box_count());
  Index source_begin = sources[box].begin, target_begin = targets[box].begin;
  for (unsigned o = 0; o < 8; ++o) {
    const Range s{source_begin, source_ends[o]}, t{target_begin, target_ends[o]};
    if (s.size() != 0 || t.size() != 0) add_box(box, o, s, t);
    source_begin = s.end, target_begin = t.end;
  }
  children[box] = {first, static_cast<Index>(box_count())};
}

Real Tree::side(Index box) const {
  return std::ldexp(size, -level[box]);
}

Vec3 Tree::centre(Index box) const {
  const std::array<std::uint32_t, 3>& a = anchor[box];
  return low + Vec3{a[0] + 0.5, a[1] + 0.5, a[2] + 0.5} * side(box);
}

bool Tree::touching(Index a, Index b) const {
  if (level[a] > level[b]) std::swap(a, b);
  const int finer = level[b] - level[a];
  for (std::size_t k = 0; k < 3; ++k)
    if (anchor[b][k] > (anchor[a][k] + 1) << finer || anchor[b][k] + 1 < anchor[a][k] << finer) return false;
  return true;
}

}  // namespace sherd::fmm
