// A planned sum at its limits: awkward points, refusals, threads, and the record of its tasks.
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <thread>

#include "kernels/core/error.h"
#include "kernels/core/parallel.h"
#include "tests/fmm/pairs_reference.h"
#include "tests/fmm/plan_support.h"

namespace sherd::fmm {
namespace {

using test::plan_case;
using test::PlanCase;
using test::relative_error;

// The sum from its definition with differences of the coordinates as given, in any range.
std::vector<double> kelvin(const PlanCase& c) {
  const std::size_t n = c.targets.size(), m = c.sources.size();
  std::vector<double> out(3 * n, 0.0);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < m; ++j) {
      Vec3 e = c.targets[i] - c.sources[j];
      const double reach = std::max({std::abs(e.x), std::abs(e.y), std::abs(e.z)});
      if (reach == 0) continue;
      e = e / reach;
      const double l = norm(e), inverse = 1 / l / reach;
      e = e / l;
      const Vec3 f{c.strengths[j], c.strengths[m + j], c.strengths[2 * m + j]};
      const Vec3 u = f * (c.constants.a * inverse) + e * (c.constants.b * dot(e, f) * inverse);
      out[i] += u.x, out[n + i] += u.y, out[2 * n + i] += u.z;
    }
  return out;
}

TEST(PlanLimits, AwkwardPointsGiveTheRightAnswer) {
  auto sets = point_sets();
  Vec3Column outlier = sphere_points(2000, 21);
  outlier.push_back({1e5, 2e5, -1e5});
  sets.push_back({"one point far away", outlier, outlier});
  for (const PointSet& set : sets)
    for (const std::size_t leaf_size : {std::size_t{0}, std::size_t{20}}) {
      if (set.name == "subnormal") continue;  // 1 / l overflows
      PlanCase c = plan_case(PairSum::kKelvinValue, set.sources, set.targets, leaf_size);
      const auto out = c.apply();
      for (const double v : out) ASSERT_TRUE(std::isfinite(v)) << set.name;
      // Targets apart from the sources have no near field that is exact: the error is of the far field alone.
      // Clusters that their root cube's digits cannot resolve keep coordinates about a cube 1e12 as large: 3e-5 of
      // their size.
      const bool together = set.sources == set.targets && set.name != "clusters 1e12 apart";
      EXPECT_LE(relative_error(out, kelvin(c)), together ? 1e-4 : 5e-4) << set.name << " leaves of " << leaf_size;
    }
}

TEST(PlanLimits, AGradedSurfaceKeepsItsGradients) {
  const Vec3Column points = graded_points(8000, 22);  // distances shrink by 1e4
  for (const Arithmetic a : {Arithmetic::kFloat, Arithmetic::kDouble}) {
    const PlanCase value = plan_case(PairSum::kKelvinValue, points, points, 50, a);
    EXPECT_LT(relative_error(value.apply(), value.direct()), 1e-4) << test::name(a);
    const PlanCase gradient = plan_case(PairSum::kKelvinGradient, points, points, 50, a);
    EXPECT_LT(relative_error(gradient.apply(), gradient.direct()), 4e-4) << test::name(a);
  }
}

std::string refusal(PlanCase& c) {
  try {
    c.apply();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(PlanLimits, RefusalsNameTheFault) {
  const Vec3Column points = sphere_points(500, 23);
  const PlanCase good = plan_case(PairSum::kElasticValue, points, points);
  const auto refused = [&](const auto& change, const std::string& text) {
    PlanCase c = good;
    change(c);
    const std::string got = refusal(c);
    EXPECT_NE(got.find(text), std::string::npos) << "'" << got << "' should say '" << text << "'";
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
  refused([](PlanCase& c) { c.strengths[503] = kNan; }, "strength 1 of source 3 is not finite");
  refused([](PlanCase& c) { c.strengths[0] = kInf; }, "strength 0 of source 0 is not finite");
  refused([](PlanCase& c) { c.strengths.pop_back(); }, "2999 strengths for 6 x 500");
  refused([](PlanCase& c) { c.sources.y[17] = kNan; }, "source point 17");
  refused([](PlanCase& c) { c.targets.z[3] = -kInf; }, "target point 3");
  refused([](PlanCase& c) { c.source_normals.x[5] = kNan; }, "source normal 5 is not finite");
  refused([](PlanCase& c) { c.source_normals.resize(499); }, "source normal a point (499 for 500");
  refused([](PlanCase& c) { c.constants.b = kNan; }, "constant is not finite");
  refused([](PlanCase& c) { c.constants.a = kInf; }, "constant is not finite");
  refused([](PlanCase& c) { c.options.tolerance = 1e-10; }, "tolerance 1e-10 is outside");
  refused([](PlanCase& c) { c.options.tolerance = 0.1; }, "tolerance 0.1 is outside");
  refused([](PlanCase& c) { c.options.tolerance = kNan; }, "tolerance nan is outside");
  refused([](PlanCase& c) { c.options.max_bytes = 100000; }, "more than the");
  PlanCase none = good;
  EXPECT_THROW(Plan(none.sum, none.constants, {none.sources, none.targets}, none.options), InputError);
  PlanCase traction = plan_case(PairSum::kKelvinTraction, points, points);
  EXPECT_THROW(Plan(traction.sum, traction.constants, {points, points}, traction.options), InputError);
  const Plan plan = good.plan();
  std::vector<double> small(3 * 500 - 1);
  EXPECT_THROW(plan.apply(good.strengths, small), InputError);
}

TEST(PlanLimits, MemoryIsPlannedBeforeItIsTaken) {
  const Vec3Column points = sphere_points(4000, 24);
  PlanCase c = plan_case(PairSum::kKelvinValue, points, points);
  const std::size_t bytes = c.plan().statistics().bytes;
  c.options.max_bytes = bytes;
  EXPECT_NO_THROW(c.plan());
  c.options.max_bytes = bytes - 1;
  EXPECT_THROW(c.plan(), InputError);
}

TEST(PlanLimits, TheSameBitsForAnyThreadsAndAnyRepetition) {
  const Vec3Column points = sphere_points(4000, 25);
  for (const Arithmetic a : {Arithmetic::kFloat, Arithmetic::kDouble}) {
    const PlanCase c = plan_case(PairSum::kElasticGradient, points, points, 40, a);
    std::vector<double> first;
    for (const int threads : {1, 2, 4}) {
      const ThreadLimit limit(threads);
      const Plan plan = c.plan();
      for (int repeat = 0; repeat < 2; ++repeat) {
        const auto out = c.apply(plan);
        if (first.empty()) first = out;
        ASSERT_EQ(out, first) << threads << " threads";
      }
    }
  }
}

TEST(PlanLimits, OnePlanServesSeveralThreadsAtOnce) {
  const Vec3Column points = sphere_points(3000, 26);
  const PlanCase c = plan_case(PairSum::kKelvinValue, points, points, 40, Arithmetic::kFloat);
  PlanCase d = c;
  d.strengths = test::random_numbers(c.strengths.size(), 27);
  const Plan plan = c.plan();
  const auto of_c = c.apply(plan), of_d = d.apply(plan);
  std::array<std::vector<double>, 4> got;
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (int repeat = 0; repeat < 5; ++repeat) got[t] = (t % 2 ? d : c).apply(plan);
    });
  for (std::thread& t : threads) t.join();
  for (std::size_t t = 0; t < 4; ++t) EXPECT_EQ(got[t], t % 2 ? of_d : of_c);
}

TEST(PlanLimits, FewPointsAreSummedDirectlyAndExactly) {
  const Vec3Column few = sphere_points(200, 28), many = sphere_points(8000, 28);
  const PlanCase a = plan_case(PairSum::kKelvinValue, few, few, 0), b = plan_case(PairSum::kKelvinValue, many, many, 0);
  EXPECT_TRUE(a.plan().statistics().direct);
  EXPECT_TRUE(a.plan().statistics().rank.empty());  // nor are translations made, which take seconds at 1e-9
  EXPECT_LT(relative_error(a.apply(), a.direct()), 1e-13);
  EXPECT_FALSE(b.plan().statistics().direct);
  PlanCase c = b;
  c.options.scheme = Scheme::kDirect;
  EXPECT_EQ(c.plan().statistics().direct_pairs, 8000.0 * 8000.0);
  EXPECT_LT(relative_error(c.apply(), c.direct()), 1e-13);
}

TEST(PlanLimits, TheTraceHoldsEveryTaskOnceInAnOrderThatIsPossible) {
  const Vec3Column points = sphere_points(6000, 29);
  const PlanCase c = plan_case(PairSum::kKelvinValue, points, points, 30);
  const Plan plan = c.plan();
  std::vector<double> out(3 * points.size());
  const std::vector<TaskRecord> records = plan.apply_traced(c.strengths, out);
  EXPECT_EQ(out, c.apply(plan));
  const TaskGraph& graph = plan.tasks();
  ASSERT_EQ(records.size(), graph.size());
  std::map<std::string, std::size_t> boxes;
  std::map<int, std::vector<std::pair<double, double>>> of_worker;
  for (TaskGraph::Task t = 0; t < graph.size(); ++t) {
    const TaskRecord& r = records[t];
    ASSERT_NE(r.name, nullptr);
    boxes[r.name] += r.boxes;
    ASSERT_LE(0, r.begin);
    ASSERT_LE(r.begin, r.end);
    of_worker[r.worker].emplace_back(r.begin, r.end);
    for (const TaskGraph::Task after : graph.after(t)) ASSERT_LE(r.end, records[after].begin);
  }
  // Every kind of work visits every box once.
  EXPECT_EQ(boxes.size(), 4u);
  for (const auto& [kind, count] : boxes) EXPECT_EQ(count, plan.statistics().boxes) << kind;
  for (auto& [worker, spans] : of_worker) {
    std::sort(spans.begin(), spans.end());
    for (std::size_t i = 1; i < spans.size(); ++i) ASSERT_LE(spans[i - 1].second, spans[i].first) << worker;
  }
  // Upward passes meet in the root's, and nothing goes down before the root's pass has.
  std::vector<TaskRecord> up, down;
  for (const TaskRecord& r : records) {
    if (std::string(r.name) == "upward") up.push_back(r);
    if (std::string(r.name) == "downward") down.push_back(r);
  }
  for (std::size_t i = 1; i < up.size(); ++i) {
    EXPECT_LE(up[i].end, up[0].begin);
    EXPECT_LE(down[0].end, down[i].begin);
  }
}

}  // namespace
}  // namespace sherd::fmm
