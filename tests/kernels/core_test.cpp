// Laws of the core: eigensystems, matrices, deterministic parallel sums.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "kernels/core/column.h"
#include "kernels/core/error.h"
#include "kernels/core/parallel.h"
#include "kernels/core/random.h"
#include "kernels/core/symmetric.h"
#include "kernels/core/task_graph.h"

namespace sherd {
namespace {

Sym3 random_tensor(Random& r) {
  return {r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1)};
}

TEST(EigenSymmetric, RebuildsTheTensorFromAnOrthonormalSystem) {
  Random random(1);
  for (int n = 0; n < 1000; ++n) {
    const Real scale = std::pow(10.0, random.uniform(-12, 12));
    const Sym3 s = random_tensor(random) * scale;
    const Eigen3 e = eigen_symmetric(s);
    Mat3 rebuilt;
    for (int k = 0; k < 3; ++k) rebuilt += outer(e.vector[k], e.vector[k]) * e.value[k];
    const Mat3 m = to_matrix(s);
    for (int i = 0; i < 9; ++i) EXPECT_NEAR(rebuilt[i / 3][i % 3], m[i / 3][i % 3], 1e-14 * 3 * scale);
    EXPECT_GE(e.value[0], e.value[1]);
    EXPECT_GE(e.value[1], e.value[2]);
    EXPECT_NEAR(dot(cross(e.vector[0], e.vector[1]), e.vector[2]), 1, 1e-14);
  }
}

TEST(EigenSymmetric, RepeatedAndZeroEigenvaluesAreExact) {
  for (const Sym3& s : {Sym3{}, Sym3{2, 2, 2, 0, 0, 0}, Sym3{1, 1, -3, 0, 0, 0}}) {
    const Eigen3 e = eigen_symmetric(s);
    EXPECT_EQ(e.value[0] + e.value[1] + e.value[2], s.xx + s.yy + s.zz);
    EXPECT_NEAR(norm(e.vector[0]), 1, 1e-15);
  }
}

TEST(Mat3, InverseTimesMatrixIsTheIdentity) {
  Random random(2);
  for (int n = 0; n < 100; ++n) {
    Mat3 a;
    for (int i = 0; i < 9; ++i) a[i / 3][i % 3] = random.uniform(-1, 1) + (i % 4 == 0 ? 3 : 0);
    const Mat3 p = inverse(a) * a;
    for (int i = 0; i < 9; ++i) EXPECT_NEAR(p[i / 3][i % 3], i % 4 == 0 ? 1 : 0, 1e-13);
  }
}

TEST(Vec3, AnyPerpendicularIsAUnitVectorAcross) {
  Random random(3);
  for (int n = 0; n < 1000; ++n) {
    const Vec3 a = normalized(Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
    EXPECT_NEAR(norm(any_perpendicular(a)), 1, 1e-14);
    EXPECT_NEAR(dot(any_perpendicular(a), a), 0, 1e-14);
  }
  EXPECT_NEAR(dot(any_perpendicular({0, 0, -1}), Vec3{0, 0, -1}), 0, 1e-15);
}

TEST(Parallel, SumHasTheSameBitsForAnyNumberOfThreads) {
  std::vector<Real> values(100'003);
  Random random(4);
  for (Real& v : values) v = random.uniform(-1, 1) * std::pow(10.0, random.uniform(-8, 8));
  const auto sum = [&](int threads) {
    const ThreadLimit limit(threads);
    return parallel_sum<Real>(values.size(), 1000, [&](std::size_t i) { return values[i]; });
  };
  const Real one = sum(1);
  for (const int threads : {2, 3, 4, 8}) EXPECT_EQ(sum(threads), one);
}

TEST(ThreadLimit, OneMeansTheCallersThreadAlone) {
  const ThreadLimit one(1);
  std::atomic<int> elsewhere = 0;
  const auto here = std::this_thread::get_id();
  parallel_for(200, 1, [&](std::size_t) {
    if (std::this_thread::get_id() != here) ++elsewhere;
    std::this_thread::sleep_for(std::chrono::microseconds(200));  // time enough for another thread to take part
  });
  EXPECT_EQ(elsewhere, 0);
}

TEST(TaskGraph, EveryTaskRunsOnceAfterItsPredecessors) {
  // Two layers of a tree with a common root, twice from the same graph.
  TaskGraph graph;
  const TaskGraph::Task root = graph.add();
  std::vector<TaskGraph::Task> leaves;
  for (int i = 0; i < 300; ++i) {
    const TaskGraph::Task middle = graph.add(), leaf = graph.add();
    graph.precede(root, middle), graph.precede(middle, leaf), graph.precede(root, leaf);
    leaves.push_back(leaf);
  }
  for (int run = 0; run < 2; ++run) {
    std::atomic<int> clock = 0;
    std::vector<int> at(graph.size(), -1);
    graph.run([&](TaskGraph::Task t) {
      EXPECT_EQ(at[t], -1);
      at[t] = clock++;
    });
    EXPECT_EQ(at[root], 0);
    for (const TaskGraph::Task leaf : leaves) EXPECT_LT(at[leaf - 1], at[leaf]);
    EXPECT_EQ(clock, static_cast<int>(graph.size()));
  }
}

TEST(TaskGraph, ACircleIsAnError) {
  TaskGraph graph;
  const TaskGraph::Task a = graph.add(), b = graph.add();
  graph.precede(a, b), graph.precede(b, a);
  EXPECT_THROW(graph.run([](TaskGraph::Task) {}), InternalError);
}

TEST(Parallel, EveryIndexIsVisitedOnce) {
  for (const std::size_t n : {0u, 1u, 7u, 8u, 9u, 1000u}) {
    std::vector<int> visits(n, 0);
    parallel_for(n, 8, [&](std::size_t i) { ++visits[i]; });
    for (const int v : visits) EXPECT_EQ(v, 1);
  }
}

}  // namespace
}  // namespace sherd
