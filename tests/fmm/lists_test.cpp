// Laws of the interaction lists, by brute force over all pairs of points.
#include "kernels/fmm/lists.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "kernels/core/parallel.h"
#include "tests/fmm/tree_support.h"

namespace sherd::fmm {
namespace {

using Index = Tree::Index;

std::vector<ListOptions> all_options() {
  return {{12, 12, 0}, {0, 0, 0}, {1000000, 1000000, 0}, {8, 20, 60}, {5, 3, 1000}};
}

void expect_same_lists(const InteractionLists& a, const InteractionLists& b) {
  EXPECT_EQ(a.near.begin, b.near.begin);
  EXPECT_EQ(a.near.item, b.near.item);
  EXPECT_EQ(a.far.begin, b.far.begin);
  EXPECT_EQ(a.far.item, b.far.item);
  EXPECT_EQ(a.multipole.begin, b.multipole.begin);
  EXPECT_EQ(a.multipole.item, b.multipole.item);
  EXPECT_EQ(a.local.begin, b.local.begin);
  EXPECT_EQ(a.local.item, b.local.item);
}

// How often each (target place, source place) is met.
class Coverage {
 public:
  explicit Coverage(const Tree& tree)
      : tree_(tree), columns_(tree.source_order.size()), met_(tree.target_order.size() * columns_) {}
  void add(Index target_box, Index source_box) {
    for (Index t = tree_.targets[target_box].begin; t < tree_.targets[target_box].end; ++t)
      for (Index s = tree_.sources[source_box].begin; s < tree_.sources[source_box].end; ++s) ++met_[t * columns_ + s];
  }
  bool once() const {
    return std::ranges::all_of(met_, [](std::uint8_t m) { return m == 1; });
  }

 private:
  const Tree& tree_;
  std::size_t columns_;
  std::vector<std::uint8_t> met_;
};

void expect_far_pair(const Tree& tree, const ListOptions& options, Index b, const FarPair& far) {
  EXPECT_EQ(tree.level[b], tree.level[far.source]);
  EXPECT_FALSE(tree.touching(b, far.source));
  EXPECT_TRUE(tree.touching(tree.parent[b], tree.parent[far.source]));
  int reach = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(far.offset[k], static_cast<int>(tree.anchor[b][k]) - static_cast<int>(tree.anchor[far.source][k]));
    reach = std::max(reach, std::abs(static_cast<int>(far.offset[k])));
  }
  EXPECT_TRUE(reach == 2 || reach == 3);
  EXPECT_GE(std::size_t{tree.targets[b].size()} * tree.sources[far.source].size(),
            std::max<std::size_t>(1, options.direct_below));
}

void expect_row(const Tree& tree, const InteractionLists& lists, const ListOptions& options, Index b, Coverage& met) {
  EXPECT_TRUE(std::ranges::is_sorted(lists.near[b]));
  EXPECT_TRUE(std::ranges::is_sorted(lists.multipole[b]));
  EXPECT_TRUE(std::ranges::is_sorted(lists.local[b]));
  EXPECT_TRUE(std::ranges::is_sorted(lists.far[b], {}, &FarPair::source));
  if (!tree.leaf(b) || tree.targets[b].size() == 0) {
    EXPECT_TRUE(lists.near[b].empty() && lists.multipole[b].empty());
  }
  for (const Index a : lists.near[b]) {
    EXPECT_TRUE(tree.leaf(a));
    EXPECT_GT(tree.sources[a].size(), 0u);
    met.add(b, a);
  }
  for (const FarPair& far : lists.far[b]) {
    expect_far_pair(tree, options, b, far);
    met.add(b, far.source);
  }
  for (const Index a : lists.multipole[b]) {
    EXPECT_GT(tree.level[a], tree.level[b]);
    EXPECT_FALSE(tree.touching(a, b));
    EXPECT_TRUE(tree.touching(tree.parent[a], b));
    EXPECT_GE(tree.sources[a].size(), std::max<std::size_t>(1, options.multipole_from));
    met.add(b, a);
  }
  for (const Index a : lists.local[b]) {
    EXPECT_TRUE(tree.leaf(a));
    EXPECT_LT(tree.level[a], tree.level[b]);
    EXPECT_FALSE(tree.touching(a, b));
    EXPECT_TRUE(tree.touching(a, tree.parent[b]));
    EXPECT_GE(tree.targets[b].size(), std::max<std::size_t>(1, options.local_from));
    EXPECT_GT(tree.sources[a].size(), 0u);
    met.add(b, a);
  }
}

// By definition of the numbers.
ListCounts counts_of(const Tree& tree, const InteractionLists& lists) {
  ListCounts c;
  c.far_pairs = static_cast<double>(lists.far.item.size());
  for (Index b = 0; b < tree.box_count(); ++b) {
    for (const Index a : lists.near[b]) c.direct_pairs += double{tree.sources[a].size() * 1.0} * tree.targets[b].size();
    c.multipole_points += static_cast<double>(lists.multipole[b].size()) * tree.targets[b].size();
    for (const Index a : lists.local[b]) c.local_points += tree.sources[a].size();
  }
  return c;
}

TEST(InteractionLists, CoverEveryPairOnceByBoxesFarEnough) {
  for (const PointSet& set : point_sets()) {
    const SortedPoints points(set.sources, set.targets);
    for (const std::size_t leaf_size : {1u, 9u, 60u}) {
      const Tree tree(points, {leaf_size});
      for (const ListOptions& options : all_options()) {
        SCOPED_TRACE(set.name + ", leaves of " + std::to_string(leaf_size));
        const InteractionLists lists(tree, options);
        ASSERT_EQ(lists.near.size(), tree.box_count());
        ASSERT_EQ(lists.far.size(), tree.box_count());
        ASSERT_EQ(lists.multipole.size(), tree.box_count());
        ASSERT_EQ(lists.local.size(), tree.box_count());
        Coverage met(tree);
        for (Index b = 0; b < tree.box_count(); ++b) expect_row(tree, lists, options, b, met);
        EXPECT_TRUE(met.once());
        EXPECT_EQ(count_interactions(tree, options), counts_of(tree, lists));
      }
    }
  }
}

// Otherwise the laws above hold for want of entries.
TEST(InteractionLists, GradedPointsFillEveryList) {
  const Vec3Column p = graded_points(1500, 5);
  const Tree tree(p, p, {9});
  const InteractionLists lists(tree, {2, 2, 0});
  EXPECT_GT(lists.near.item.size(), 100u);
  EXPECT_GT(lists.far.item.size(), 100u);
  EXPECT_GT(lists.multipole.item.size(), 100u);
  EXPECT_GT(lists.local.item.size(), 100u);
}

// Every far pair has at least one pair of points, and none as many as all.
TEST(InteractionLists, FarPairsWithFewerPointPairsThanAskedAreDirect) {
  const Vec3Column p = sphere_points(600, 1);
  const Tree tree(p, p, {1});
  const InteractionLists lists(tree, {1, 1, 0});
  const bool single =
      std::ranges::any_of(lists.far.item, [&](const FarPair& far) { return tree.sources[far.source].size() == 1; });
  EXPECT_TRUE(single);
  expect_same_lists(lists, InteractionLists(tree, {1, 1, 1}));
  EXPECT_LT(InteractionLists(tree, {1, 1, 2}).far.item.size(), lists.far.item.size());
  EXPECT_TRUE(InteractionLists(tree, {1, 1, 600 * 600}).far.item.empty());
}

// Pairs of boxes (a, b) and (b, a) are treated alike when sources and targets are the same points.
TEST(InteractionLists, AreSymmetricForEqualSets) {
  const Vec3Column p = graded_points(1500, 5);
  const Tree tree(p, p, {9});
  const InteractionLists lists(tree, {6, 6, 0});
  for (Index b = 0; b < tree.box_count(); ++b) {
    for (const Index a : lists.near[b]) EXPECT_TRUE(std::ranges::binary_search(lists.near[a], b));
    for (const FarPair& far : lists.far[b])
      EXPECT_TRUE(std::ranges::binary_search(lists.far[far.source], b, {}, &FarPair::source));
    for (const Index a : lists.multipole[b]) EXPECT_TRUE(std::ranges::binary_search(lists.local[a], b));
    for (const Index a : lists.local[b]) EXPECT_TRUE(std::ranges::binary_search(lists.multipole[a], b));
  }
}

TEST(InteractionLists, DoNotDependOnTheNumberOfThreads) {
  const Vec3Column p = sphere_points(30000, 1), q = graded_points(20000, 2);
  const Tree tree(p, q, {20});
  const ListOptions options{20, 20, 50};
  const auto make = [&](int threads) {
    const ThreadLimit limit(threads);
    return InteractionLists(tree, options);
  };
  expect_same_lists(make(1), make(2));
}

TEST(InteractionLists, DoNotDependOnScaleOrPlaceByPowersOfTwo) {
  Vec3Column p = sphere_points(2000, 1), q;
  for (std::vector<Real>* v : {&p.x, &p.y, &p.z})
    for (Real& x : *v) x = std::round(x * 0x1p30) * 0x1p-30;
  for (std::size_t i = 0; i < p.size(); ++i) q.push_back((p[i] + Vec3{64, -2, 1024}) * 0x1p-40);
  const ListOptions options{10, 10, 20};
  expect_same_lists(InteractionLists(Tree(p, p, {12}), options), InteractionLists(Tree(q, q, {12}), options));
}

// A body's surface: the near field holds the touching leaves' pairs, a bounded number a point whatever the size.
TEST(InteractionLists, DirectPairsAPointStayBoundedAsPointsGrow) {
  double largest = 0;
  for (const std::size_t n : {2000u, 8000u, 32000u, 128000u}) {
    const Vec3Column p = sphere_points(n, 1);
    const ListCounts c = count_interactions(Tree(p, p, {128}), {});
    largest = std::max(largest, c.direct_pairs / static_cast<double>(n));
  }
  // A surface meets at most 3 x 3 touching columns of one or two full leaves each: 9 * 2 * 128.
  EXPECT_LE(largest, 2304);
}

}  // namespace
}  // namespace sherd::fmm
