// Walk over pairs (source box, target box) from (root, root) down, level by level of target boxes. Each box inherits
// from its parent the boxes that touch the parent (of the parent's level, or larger leaves) and the leaves that all
// below the parent meet directly; so a row is made by one visit, and rows of consecutive boxes follow one another.
#include "kernels/fmm/lists.h"

#include <algorithm>

#include "kernels/core/parallel.h"

namespace sherd::fmm {
namespace {

using Index = Tree::Index;
constexpr std::size_t kGrain = 64;  // boxes

// One target box's entries, unsorted, and what its children inherit.
struct Visit {
  std::vector<Index> near, multipole, local, touching, direct;
  std::vector<FarPair> far;

  void clear() {
    for (std::vector<Index>* v : {&near, &multipole, &local, &touching, &direct}) v->clear();
    far.clear();
  }
};

class Visitor {
 public:
  Visitor(const Tree& tree, const ListOptions& options) : tree_(tree), options_(options) {}

  void root(Visit& v) const {
    v.clear();
    if (tree_.sources[0].size() == 0 || tree_.targets[0].size() == 0) return;
    v.touching.push_back(0);
    if (tree_.leaf(0)) v.near.push_back(0);
  }

  void box(Index b, std::span<const Index> parent_touching, std::span<const Index> parent_direct, Visit& v) const {
    v.clear();
    if (tree_.targets[b].size() == 0) return;
    v.direct.assign(parent_direct.begin(), parent_direct.end());
    for (const Index a : parent_touching) {
      if (tree_.leaf(a))
        meet_larger_leaf(a, b, v);
      else
        meet_children(a, b, v);
    }
    if (!tree_.leaf(b)) return;
    for (const Index a : v.touching) meet_touching(a, b, v);
    v.near.insert(v.near.end(), v.direct.begin(), v.direct.end());
  }

 private:
  void meet_larger_leaf(Index a, Index b, Visit& v) const {
    if (tree_.touching(a, b))
      v.touching.push_back(a);
    else if (tree_.targets[b].size() >= options_.local_from)
      v.local.push_back(a);
    else
      v.direct.push_back(a);
  }

  // Of a's children, which have b's level.
  void meet_children(Index a, Index b, Visit& v) const {
    const std::array<std::uint32_t, 3>& at = tree_.anchor[b];
    for (Index c = tree_.children[a].begin; c < tree_.children[a].end; ++c) {
      if (tree_.sources[c].size() == 0) continue;
      std::array<std::int8_t, 3> offset;
      bool touching = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const int o = static_cast<int>(at[k]) - static_cast<int>(tree_.anchor[c][k]);
        offset[k] = static_cast<std::int8_t>(o);
        touching = touching && o >= -1 && o <= 1;
      }
      if (touching)
        v.touching.push_back(c);
      else if (std::size_t{tree_.sources[c].size()} * tree_.targets[b].size() < options_.direct_below)
        add_leaves(c, v.direct);
      else
        v.far.push_back({c, offset});
    }
  }

  // b: a leaf; a: touching it, of its level or smaller, or a larger leaf.
  void meet_touching(Index a, Index b, Visit& v) const {
    if (tree_.leaf(a)) {
      v.near.push_back(a);
      return;
    }
    for (Index c = tree_.children[a].begin; c < tree_.children[a].end; ++c) {
      if (tree_.sources[c].size() == 0) continue;
      if (tree_.touching(c, b))
        meet_touching(c, b, v);
      else if (tree_.sources[c].size() >= options_.multipole_from)
        v.multipole.push_back(c);
      else
        add_leaves(c, v.near);
    }
  }

  void add_leaves(Index a, std::vector<Index>& out) const {
    if (tree_.sources[a].size() == 0) return;
    if (tree_.leaf(a)) out.push_back(a);
    for (Index c = tree_.children[a].begin; c < tree_.children[a].end; ++c) add_leaves(c, out);
  }

  const Tree& tree_;
  const ListOptions& options_;
};

template <class T>
void add_row(Rows<T>& rows, const std::vector<T>& row) {
  rows.item.insert(rows.item.end(), row.begin(), row.end());
  rows.begin.push_back(rows.item.size());
}

template <class T>
void append(Rows<T>& rows, const Rows<T>& more) {
  const std::size_t before = rows.item.size();
  rows.item.insert(rows.item.end(), more.item.begin(), more.item.end());
  for (std::size_t i = 1; i < more.begin.size(); ++i) rows.begin.push_back(before + more.begin[i]);
}

struct Inherited {
  Rows<Index> touching, direct;
};

// Visits every box. Part keeps what is wanted of a chunk of boxes: add(box, visit); take(part) gets the chunks in the
// order of boxes.
template <class Part, class Take>
void walk(const Tree& tree, const ListOptions& options, const Part& empty, const Take& take) {
  const Visitor visitor(tree, options);
  Inherited above;
  for (int l = 0; l < tree.level_count(); ++l) {
    const Index first = tree.level_begin[static_cast<std::size_t>(l)];
    const std::size_t count = tree.level_begin[static_cast<std::size_t>(l) + 1] - first;
    const Index first_above = l == 0 ? 0 : tree.level_begin[static_cast<std::size_t>(l) - 1];
    std::vector<Part> parts((count + kGrain - 1) / kGrain, empty);
    std::vector<Inherited> below(parts.size());
    parallel_for_chunks(count, kGrain, [&](std::size_t begin, std::size_t end) {
      Visit v;
      for (std::size_t i = begin; i < end; ++i) {
        const Index b = first + static_cast<Index>(i);
        if (l == 0) {
          visitor.root(v);
        } else {
          const Index p = tree.parent[b] - first_above;
          visitor.box(b, above.touching[p], above.direct[p], v);
        }
        parts[begin / kGrain].add(b, v);
        if (tree.leaf(b)) v.touching.clear(), v.direct.clear();
        add_row(below[begin / kGrain].touching, v.touching);
        add_row(below[begin / kGrain].direct, v.direct);
      }
    });
    above = {};
    for (std::size_t c = 0; c < parts.size(); ++c) {
      take(parts[c]);
      append(above.touching, below[c].touching);
      append(above.direct, below[c].direct);
    }
  }
}

// Far rows ascend as they come: from the split boxes among those that touch the parent, which ascend by induction.
struct ListPart {
  Rows<Index> near, multipole, local;
  Rows<FarPair> far;

  void add(Index, Visit& v) {
    for (std::vector<Index>* row : {&v.near, &v.multipole, &v.local}) std::ranges::sort(*row);
    add_row(near, v.near), add_row(multipole, v.multipole), add_row(local, v.local), add_row(far, v.far);
  }
};

// Whole numbers below 2^53, so the sums are exact in any order.
struct CountPart {
  const Tree* tree;
  ListCounts counts;

  void add(Index b, const Visit& v) {
    const double targets = tree->targets[b].size();
    double near = 0;
    for (const Index a : v.near) near += tree->sources[a].size();
    counts.direct_pairs += near * targets;
    counts.far_pairs += static_cast<double>(v.far.size());
    counts.multipole_points += static_cast<double>(v.multipole.size()) * targets;
    for (const Index a : v.local) counts.local_points += tree->sources[a].size();
  }
};

}  // namespace

InteractionLists::InteractionLists(const Tree& tree, const ListOptions& options) {
  walk(tree, options, ListPart{}, [&](const ListPart& part) {
    append(near, part.near), append(multipole, part.multipole), append(local, part.local), append(far, part.far);
  });
}

ListCounts count_interactions(const Tree& tree, const ListOptions& options) {
  ListCounts sum;
  walk(tree, options, CountPart{&tree, {}}, [&](const CountPart& part) {
    sum.direct_pairs += part.counts.direct_pairs;
    sum.far_pairs += part.counts.far_pairs;
    sum.multipole_points += part.counts.multipole_points;
    sum.local_points += part.counts.local_points;
  });
  return sum;
}

}  // namespace sherd::fmm
