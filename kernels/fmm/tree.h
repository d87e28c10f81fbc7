// Adaptive octree over sources and targets.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "kernels/core/column.h"

namespace sherd::fmm {

inline constexpr int kMaxDepth = 20;

// The points along the Morton curve of their root cube: all of a tree that does not depend on the leaf size, made once
// for several trees.
struct SortedPoints {
  // Coordinates finite and at most 1e307, fewer than 2^32 - 1 a set (throws InputError otherwise); in any unit. Either
  // set may be empty; equal sets are sorted once.
  // stretch (1 .. 2) enlarges the root cube: on a surface a level more or less divides the points of a leaf by four, so
  // the sizes in between are reached by the root's size only.
  SortedPoints(const Vec3Column& sources, const Vec3Column& targets, Real stretch = 1);

  Vec3 low;           // corner of the root cube
  Real size = 0;      // its side, > 0 even for one point
  bool same = false;  // targets are the sources, in the same order
  // Keys of kMaxDepth digits 0..7 (x lowest), ascending, ties in the order given; and place -> index of the point as
  // given.
  std::vector<std::uint64_t> source_keys, target_keys;
  std::vector<std::uint32_t> source_order, target_order;
};

struct TreeOptions {
  std::size_t leaf_size = 160;  // a box with more sources or more targets is split
};

// Boxes level by level, along the Morton curve within a level, so that children are contiguous; structure of arrays.
// Only boxes with a source or a target exist: no point, no box. Points keep the order of their Morton keys, ties in the
// order given, so a box is a contiguous range of both orders. Splitting ends at kMaxDepth, and where it cannot separate
// the points that are too many; such a leaf may be arbitrarily full.
class Tree {
 public:
  using Index = std::uint32_t;
  struct Range {
    Index begin = 0, end = 0;
    Index size() const { return end - begin; }
    friend bool operator==(const Range&, const Range&) = default;
  };

  Tree(const SortedPoints& points, const TreeOptions& options);
  Tree(const Vec3Column& source_points, const Vec3Column& target_points, const TreeOptions& options)
      : Tree(SortedPoints(source_points, target_points), options) {}

  std::size_t box_count() const { return level.size(); }
  int level_count() const { return static_cast<int>(level_begin.size()) - 1; }
  bool leaf(Index box) const { return children[box].size() == 0; }
  Real side(Index box) const;  // of the cube
  Vec3 centre(Index box) const;
  // Whether the closed cubes share a point.
  bool touching(Index a, Index b) const;

  Vec3 low;                                          // corner of the root cube
  Real size = 0;                                     // its side, > 0 even for one point
  std::vector<Index> level_begin;                    // first box of each level, and the end
  std::vector<std::uint8_t> level;                   // of a box
  std::vector<std::array<std::uint32_t, 3>> anchor;  // of a box, in sides of its level from `low`
  std::vector<Index> parent;                         // of a box; the root's is itself
  std::vector<Range> children, sources, targets;     // of a box: boxes, places in the orders
  std::vector<Index> source_order, target_order;     // place -> index of the point as given

 private:
  void add_box(Index parent_box, unsigned octant, Range source_range, Range target_range);
  void split(Index box, const SortedPoints& points);
};

}  // namespace sherd::fmm
