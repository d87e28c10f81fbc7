// Adaptive octree over sources and targets, and the lists that say how every pair of them meets exactly once: directly,
// through a multipole, through a local expansion, or both.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/core/column.h"

namespace sherd::fmm {

inline constexpr int kMaxDepth = 20;

struct TreeOptions {
  std::size_t leaf_size = 160;  // a box with more sources or more targets is split (to kMaxDepth)
};

// Boxes level by level, along the Morton curve within a level, so that children are contiguous; structure of arrays.
// Only boxes with a source or a target exist. Points keep the order of their Morton keys, ties in the order given, so a
// box is a contiguous range of both orders.
class Tree {
 public:
  using Index = std::uint32_t;
  struct Range {
    Index begin = 0, end = 0;
    Index size() const { return end - begin; }
  };

  // Points finite (throws InputError otherwise). Coordinates in any unit; either set may be empty.
  Tree(const Vec3Column& sources, const Vec3Column& targets, const TreeOptions& options);

  std::size_t box_count() const { return level.size(); }
  int level_count() const { return static_cast<int>(level_begin.size()) - 1; }
  bool leaf(Index box) const { return children[box].size() == 0; }
  Real side(Index box) const;  // of the cube
  Vec3 centre(Index box) const;

  Vec3 low;                                          // corner of the root cube
  Real size = 0;                                     // its side, > 0 even for one point
  std::vector<Index> level_begin;                    // first box of each level, and the end
  std::vector<std::uint8_t> level;                   // of a box
  std::vector<std::array<std::uint32_t, 3>> anchor;  // of a box, in sides of its level from `low`
  std::vector<Index> parent;                         // of a box; the root's is itself
  std::vector<Range> children, sources, targets;     // of a box: boxes, places in the orders
  std::vector<Index> source_order, target_order;     // place -> index of the point as given
};

// Compressed rows: entries of row i are item[begin[i]] .. item[begin[i + 1] - 1].
template <class T>
struct Rows {
  std::vector<std::size_t> begin;
  std::vector<T> item;
  std::span<const T> operator[](std::size_t i) const { return {item.data() + begin[i], begin[i + 1] - begin[i]}; }
};

// Same level, not touching, parents touching: offset = target's anchor minus source's, each -3 .. 3.
struct FarPair {
  Tree::Index source;
  std::array<std::int8_t, 3> offset;
};

struct ListOptions {
  // Boxes with fewer sources (targets) than this meet bigger leaves directly instead of through expansions.
  std::size_t multipole_from = 152, local_from = 152;
  // Far pairs with fewer point pairs than this are summed directly.
  std::size_t direct_below = 0;
};

// Each row is a target box. Every (source point, target point) is covered exactly once. Rows' entries ascend.
struct InteractionLists {
  InteractionLists(const Tree& tree, const ListOptions& options);
  Rows<Tree::Index> near;       // of a leaf: leaves summed directly
  Rows<FarPair> far;            // of any box: multipole to local
  Rows<Tree::Index> multipole;  // of a leaf: boxes (smaller, not touching) whose multipoles it evaluates
  Rows<Tree::Index> local;      // of any box: leaves (larger, not touching) whose points feed its local expansion
};

// Operation counts of a tree without making its lists, for choosing the leaf size.
struct ListCounts {
  double direct_pairs = 0, far_pairs = 0, multipole_points = 0, local_points = 0;
};
ListCounts count_interactions(const Tree& tree, const ListOptions& options);

}  // namespace sherd::fmm
