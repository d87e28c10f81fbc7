// Laws of the octree and of the sort it stands on.
#include "kernels/fmm/tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "kernels/core/error.h"
#include "kernels/core/parallel.h"
#include "tests/fmm/tree_support.h"

namespace sherd::fmm {
namespace {

using Index = Tree::Index;

void expect_same_boxes(const Tree& a, const Tree& b) {
  EXPECT_EQ(a.level_begin, b.level_begin);
  EXPECT_EQ(a.level, b.level);
  EXPECT_EQ(a.anchor, b.anchor);
  EXPECT_EQ(a.parent, b.parent);
  EXPECT_EQ(a.children, b.children);
  EXPECT_EQ(a.sources, b.sources);
  EXPECT_EQ(a.targets, b.targets);
}

TEST(ParallelSort, IsTheStableSortForAnyNumberOfThreads) {
  Random random(1);
  for (const std::size_t n : {0u, 1u, 2u, 1000u, 5000u, 300000u})
    for (const std::uint64_t mask : {~0ull, 0xFFull, 0xFF00ull << 48, 0ull}) {
      std::vector<KeyedIndex> items(n);
      for (std::size_t i = 0; i < n; ++i) items[i] = {random.next() & mask, static_cast<std::uint32_t>(i)};
      std::vector<KeyedIndex> expected = items, one = items;
      std::ranges::stable_sort(expected, {}, &KeyedIndex::key);
      {
        const ThreadLimit limit(1);
        parallel_sort(one);
      }
      const ThreadLimit limit(2);
      parallel_sort(items);
      for (std::size_t i = 0; i < n; ++i) {
        ASSERT_EQ(items[i].key, expected[i].key);
        ASSERT_EQ(items[i].index, expected[i].index);
        ASSERT_EQ(one[i].index, expected[i].index);
      }
    }
}

// Digits are rounded from coordinates whose own rounding is 2^-52 of the largest coordinate, a few operations long; the
// smallest normal number stands for the rounding of subnormal ones.
void expect_inside(const Tree& tree, Index box, const Vec3& p) {
  const Vec3 c = tree.centre(box);
  const Real side = tree.side(box);
  const Real reach = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z), tree.size});
  const Real slack = reach * 0x1p-49 + std::numeric_limits<Real>::min();
  for (int k = 0; k < 3; ++k) EXPECT_LE(std::abs(p[k] - c[k]), 0.5 * side + slack);
}

void expect_order(const std::vector<Index>& order, std::size_t n) {
  std::vector<Index> sorted = order, all(n);
  std::ranges::sort(sorted);
  std::iota(all.begin(), all.end(), Index{0});
  EXPECT_EQ(sorted, all);
}

void expect_children_fill(const Tree& tree, Index box) {
  Index source = tree.sources[box].begin, target = tree.targets[box].begin;
  for (Index c = tree.children[box].begin; c < tree.children[box].end; ++c) {
    EXPECT_EQ(tree.parent[c], box);
    EXPECT_EQ(tree.level[c], tree.level[box] + 1);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(tree.anchor[c][k] / 2, tree.anchor[box][k]);
    EXPECT_EQ(tree.sources[c].begin, source);
    EXPECT_EQ(tree.targets[c].begin, target);
    source = tree.sources[c].end, target = tree.targets[c].end;
    EXPECT_GT(tree.sources[c].size() + tree.targets[c].size(), 0u);
  }
  EXPECT_EQ(source, tree.sources[box].end);
  EXPECT_EQ(target, tree.targets[box].end);
}

TEST(Tree, BoxesHoldTheirPointsAndChildrenDivideThem) {
  for (const PointSet& set : point_sets())
    for (const std::size_t leaf_size : {1u, 10u, 100u}) {
      SCOPED_TRACE(set.name + ", leaves of " + std::to_string(leaf_size));
      const Tree tree(set.sources, set.targets, {leaf_size});
      expect_order(tree.source_order, set.sources.size());
      expect_order(tree.target_order, set.targets.size());
      EXPECT_GT(tree.size, 0);
      EXPECT_EQ(tree.box_count() == 0, set.sources.empty() && set.targets.empty());
      ASSERT_EQ(tree.level_begin.back(), tree.box_count());
      for (int l = 0; l < tree.level_count(); ++l) {
        const std::size_t at = static_cast<std::size_t>(l);
        EXPECT_LT(tree.level_begin[at], tree.level_begin[at + 1]);
        for (Index b = tree.level_begin[at]; b < tree.level_begin[at + 1]; ++b) EXPECT_EQ(tree.level[b], l);
      }
      for (Index b = 0; b < tree.box_count(); ++b) {
        if (!tree.leaf(b)) {
          expect_children_fill(tree, b);
          EXPECT_GT(std::max(tree.sources[b].size(), tree.targets[b].size()), leaf_size);
        }
        for (Index i = tree.sources[b].begin; i < tree.sources[b].end; ++i)
          expect_inside(tree, b, set.sources[tree.source_order[i]]);
        for (Index i = tree.targets[b].begin; i < tree.targets[b].end; ++i)
          expect_inside(tree, b, set.targets[tree.target_order[i]]);
      }
    }
}

// No 21 of these points share a cell of 2^-20.
TEST(Tree, LeavesAreNoFullerThanAskedWherePointsAreSeparable) {
  for (const PointSet& set : point_sets()) {
    if (set.name != "volume" && set.name != "sphere" && set.name != "plane" && set.name != "line") continue;
    const Tree tree(set.sources, set.targets, {20});
    for (Index b = 0; b < tree.box_count(); ++b)
      if (tree.leaf(b)) {
        EXPECT_LE(tree.sources[b].size(), 20u);
      }
  }
}

TEST(Tree, PointsInOnePlaceMakeOneBoxHoweverMany) {
  Vec3Column p(10000);
  EXPECT_EQ(Tree(p, p, {10}).box_count(), 1u);
  for (std::size_t i = 0; i < p.size(); ++i) p.set(i, {-0.0, 1e-3, 4e5});
  EXPECT_EQ(Tree(p, {}, {10}).box_count(), 1u);
}

// Two heaps 1e12 apart, each no larger than a key's cell: split once, not along a chain of twenty boxes.
TEST(Tree, HeapsThatCannotBeDividedEndTheSplitting) {
  const Vec3Column p = joined(random_points(300, 6, {1, 1, 1}), random_points(300, 7, {1, 1, 1}, {1e12, 0, 0}));
  const Tree tree(p, p, {100});
  EXPECT_EQ(tree.box_count(), 3u);
  EXPECT_EQ(tree.sources[1].size(), 300u);
}

TEST(Tree, ChainsOfSingleChildrenReachPointsThatAreHardToDivide) {
  // Cells of 2^-17 are shorter than 1e-5, so the first two points part at level 17 at the latest; the margin puts the
  // first at 10.4 cells of level 15, which the second shares.
  Vec3Column p;
  p.push_back({0, 0, 0}), p.push_back({1e-5, 0, 0}), p.push_back({1, 1, 1});
  const Tree tree(p, p, {1});
  for (Index b = 0; b < tree.box_count(); ++b)
    if (tree.leaf(b)) {
      EXPECT_EQ(tree.sources[b].size(), 1u);
    }
  EXPECT_EQ(tree.level_count(), 17);
}

TEST(Tree, SortedPointsGiveTheTreeOfAnyLeafSize) {
  const Vec3Column sources = sphere_points(3000, 1), targets = sphere_points(2000, 2);
  const SortedPoints sorted(sources, targets);
  for (const std::size_t leaf_size : {5u, 50u, 500u}) {
    const Tree a(sorted, {leaf_size}), b(sources, targets, {leaf_size});
    expect_same_boxes(a, b);
    EXPECT_EQ(a.source_order, b.source_order);
    EXPECT_EQ(a.target_order, b.target_order);
  }
}

TEST(Tree, EqualSetsGiveTheSameBoxesWhetherSharedOrNot) {
  const Vec3Column p = sphere_points(3000, 1);
  Vec3Column reversed;
  for (std::size_t i = p.size(); i-- > 0;) reversed.push_back(p[i]);
  expect_same_boxes(Tree(p, p, {30}), Tree(p, reversed, {30}));
}

TEST(Tree, DoesNotDependOnTheNumberOfThreads) {
  const Vec3Column p = sphere_points(150000, 3), q = graded_points(100000, 4);
  const auto make = [&](int threads) {
    const ThreadLimit limit(threads);
    return Tree(p, q, {60});
  };
  const Tree a = make(1), b = make(2);
  expect_same_boxes(a, b);
  EXPECT_EQ(a.source_order, b.source_order);
  EXPECT_EQ(a.target_order, b.target_order);
}

TEST(Tree, PermutingPointsKeepsTheBoxes) {
  for (const PointSet& set : point_sets()) {
    SCOPED_TRACE(set.name);
    const std::size_t n = set.sources.size();
    std::vector<std::size_t> from(n);
    std::iota(from.begin(), from.end(), std::size_t{0});
    Random random(5);
    for (std::size_t i = n; i > 1; --i) std::swap(from[i - 1], from[random.next() % i]);
    Vec3Column permuted;
    for (const std::size_t i : from) permuted.push_back(set.sources[i]);
    const Tree a(set.sources, set.targets, {7}), b(permuted, set.targets, {7});
    expect_same_boxes(a, b);
    const SortedPoints s(set.sources, set.targets), t(permuted, set.targets);
    EXPECT_EQ(s.source_keys, t.source_keys);
  }
}

TEST(Tree, PowersOfTwoScaleItExactly) {
  const Vec3Column p = sphere_points(2000, 1), q = graded_points(500, 2);
  const Tree tree(p, q, {10});
  for (const int exponent : {-900, -30, 3, 900}) {
    const auto scaled = [&](Vec3Column c) {
      for (std::vector<Real>* v : {&c.x, &c.y, &c.z})
        for (Real& x : *v) x = std::ldexp(x, exponent);
      return c;
    };
    const Tree other(scaled(p), scaled(q), {10});
    expect_same_boxes(tree, other);
    EXPECT_EQ(other.size, std::ldexp(tree.size, exponent));
    EXPECT_EQ(other.low.x, std::ldexp(tree.low.x, exponent));
  }
}

// Coordinates are multiples of 2^-30, so that moving them by up to 2^20 is exact.
TEST(Tree, ExactTranslationsKeepTheBoxes) {
  Vec3Column p = sphere_points(2000, 1);
  for (std::vector<Real>* v : {&p.x, &p.y, &p.z})
    for (Real& x : *v) x = std::round(x * 0x1p30) * 0x1p-30;
  const Tree tree(p, p, {10});
  for (const Vec3& move : {Vec3{1, 0, -8}, Vec3{1024, -0.5, 3}, Vec3{-0x1p20, 0x1p20, 0x1p20}}) {
    Vec3Column q;
    for (std::size_t i = 0; i < p.size(); ++i) q.push_back(p[i] + move);
    expect_same_boxes(tree, Tree(q, q, {10}));
  }
}

TEST(Tree, StretchEnlargesTheRootAndKeepsThePointsInTheirBoxes) {
  const Vec3Column p = sphere_points(2000, 1);
  const Tree plain(p, p, {10});
  for (const Real stretch : {1.25, 2.0}) {
    const Tree tree(SortedPoints(p, p, stretch), {10});
    EXPECT_DOUBLE_EQ(tree.size, stretch * plain.size);
    for (Index b = 0; b < tree.box_count(); ++b)
      for (Index i = tree.sources[b].begin; i < tree.sources[b].end; ++i)
        expect_inside(tree, b, p[tree.source_order[i]]);
  }
  EXPECT_THROW(SortedPoints(p, p, 0.5), InternalError);
}

TEST(Tree, NegativeZeroIsZero) {
  Vec3Column p = random_points(300, 1, {1, 1, 0}), q = p;
  for (Real& z : q.z) z = -0.0;
  expect_same_boxes(Tree(p, p, {10}), Tree(q, q, {10}));
}

TEST(Tree, TouchingIsSharingAPoint) {
  const Vec3Column p = graded_points(400, 3);
  const Tree tree(p, p, {5});
  for (Index a = 0; a < tree.box_count(); ++a)
    for (Index b = 0; b < tree.box_count(); ++b) {
      bool share = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto begin = [&](Index c) { return std::uint64_t{tree.anchor[c][k]} << (kMaxDepth - tree.level[c]); };
        const auto end = [&](Index c) { return begin(c) + (1ull << (kMaxDepth - tree.level[c])); };
        share = share && begin(a) <= end(b) && begin(b) <= end(a);
      }
      EXPECT_EQ(tree.touching(a, b), share);
    }
}

TEST(Tree, RefusesPointsThatAreNotFiniteNamingTheFirst) {
  for (const Real bad : {std::numeric_limits<Real>::quiet_NaN(), std::numeric_limits<Real>::infinity(),
                         -std::numeric_limits<Real>::infinity(), 1e308}) {
    Vec3Column p = sphere_points(40000, 1);
    const Vec3Column good = p;
    p.y[39000] = bad, p.z[20001] = bad, p.x[35000] = bad;
    for (const bool as_source : {true, false}) try {
        const Tree tree(as_source ? p : good, as_source ? good : p, {10});
        ADD_FAILURE();
      } catch (const InputError& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find(as_source ? "source point 20001 " : "target point 20001 "), std::string::npos) << text;
      }
  }
}

}  // namespace
}  // namespace sherd::fmm
