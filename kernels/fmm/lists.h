// The lists that say how every source and target of a tree meet exactly once: directly, through a multipole, through a
// local expansion, or both.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/fmm/tree.h"

namespace sherd::fmm {

// Compressed rows: entries of row i are item[begin[i]] .. item[begin[i + 1] - 1].
template <class T>
struct Rows {
  std::vector<std::size_t> begin{0};
  std::vector<T> item;
  std::size_t size() const { return begin.size() - 1; }
  std::span<const T> operator[](std::size_t i) const { return {item.data() + begin[i], begin[i + 1] - begin[i]}; }
};

// Same level, not touching, parents touching: offset = target's anchor minus source's, each -3 .. 3.
struct FarPair {
  Tree::Index source;
  std::array<std::int8_t, 3> offset;
  friend bool operator==(const FarPair&, const FarPair&) = default;
};

struct ListOptions {
  // Boxes with fewer sources (targets) than this meet bigger leaves directly instead of through expansions.
  std::size_t multipole_from = 152, local_from = 152;
  // Far pairs with fewer point pairs than this are summed directly, leaf by leaf.
  std::size_t direct_below = 0;
};

// One row a target box. Every (source point, target point) is covered exactly once. Rows' entries ascend by box. Boxes
// without sources stand in no row, rows of boxes without targets are empty. Near leaves need not touch.
struct InteractionLists {
  InteractionLists(const Tree& tree, const ListOptions& options);
  Rows<Tree::Index> near;       // of a leaf: leaves summed directly
  Rows<FarPair> far;            // of any box: multipole to local
  Rows<Tree::Index> multipole;  // of a leaf: boxes (smaller, not touching) whose multipoles it evaluates
  Rows<Tree::Index> local;      // of any box: leaves (larger, not touching) whose points feed its local expansion
};

// Operation counts of a tree without making its lists, for choosing the leaf size: point pairs summed directly; far
// pairs; pairs of a target and a multipole it evaluates; pairs of a source and a local expansion it feeds.
struct ListCounts {
  double direct_pairs = 0, far_pairs = 0, multipole_points = 0, local_points = 0;
  friend bool operator==(const ListCounts&, const ListCounts&) = default;
};
ListCounts count_interactions(const Tree& tree, const ListOptions& options);

}  // namespace sherd::fmm
