// The standard report: accuracy, growth, threads, crossover, and the paper's Table 2.
#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <thread>

#include "kernels/core/parallel.h"
#include "kernels/core/random.h"
#include "tools/bench/fmm.h"

namespace sherd::bench {
namespace {

using namespace fmm;
using Json = nlohmann::json;

void measured(const FmmProblem& problem, const FmmSetting& setting, const FmmOptions& o, Json& rows) {
  const FmmRow row = measure_fmm(problem, setting, o);
  print_fmm_row(row);
  rows.push_back(fmm_json(row));
}

void tolerances(const FmmOptions& o, Json& rows) {
  std::printf("\nEvery tolerance, Kelvin on a sphere, one thread\n");
  print_fmm_header();
  const FmmPoints cloud = sphere_cloud(23245);
  const FmmProblem problem(cloud, "kelvin");
  for (const double t : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9})
    measured(problem, {.precision = "double", .tolerance = t}, o, rows);
  for (const double t : {1e-3, 1e-4, 1e-5}) measured(problem, {.precision = "float", .tolerance = t}, o, rows);
}

void sizes(const FmmOptions& o, Json& rows) {
  std::printf("\nGrowth with the number of points, Kelvin on a sphere, one thread\n");
  print_fmm_header();
  for (const std::size_t n : {23245, 220332, 1000000}) {
    const FmmPoints cloud = sphere_cloud(n);
    const FmmProblem problem(cloud, "kelvin");
    for (const char* precision : {"float", "double"}) measured(problem, {.precision = precision}, o, rows);
  }
}

// Pairs a second of `threads` direct sums on processors of their own: what this machine gives to threads that share
// nothing.
double pinned_rate(int threads) {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  sched_getaffinity(0, sizeof(allowed), &allowed);
  std::vector<int> processors;
  for (int c = 0; c < CPU_SETSIZE; ++c)
    if (CPU_ISSET(c, &allowed)) processors.push_back(c);
  std::vector<double> rate(static_cast<std::size_t>(threads), 0);
  std::vector<std::thread> pool;
  for (std::size_t k = 0; k < rate.size(); ++k)
    pool.emplace_back([&, k] {
      cpu_set_t own;
      CPU_ZERO(&own);
      CPU_SET(processors[k % processors.size()], &own);
      pthread_setaffinity_np(pthread_self(), sizeof(own), &own);
      constexpr std::size_t kBlock = 128;
      Random random(k);
      std::vector<float> numbers(12 * kBlock);
      for (float& v : numbers) v = static_cast<float>(random.uniform(-1, 1));
      const auto at = [&](std::size_t c) { return numbers.data() + c * kBlock; };
      const PairSources<float> sources{kBlock, {at(0), at(1), at(2)}, {at(3), at(4), at(5)}};
      const PairTargets<float> targets{kBlock, {at(6), at(7), at(8)}, {}};
      float* const out[] = {at(9), at(10), at(11)};
      const float none[3]{};
      const auto sum = pair_function<float>(PairSum::kKelvinValue);
      const double start = wall_seconds();
      double pairs = 0, seconds = 0;
      while (seconds < 0.5) {
        for (int i = 0; i < 100; ++i) sum(sources, targets, none, {}, out);
        pairs += 100.0 * kBlock * kBlock, seconds = wall_seconds() - start;
      }
      rate[k] = pairs / seconds;
    });
  for (std::thread& t : pool) t.join();
  double sum = 0;
  for (const double r : rate) sum += r;
  return sum;
}

double apply_seconds(const Plan& plan, const FmmProblem& problem, int threads) {
  const ThreadLimit limit(threads);
  std::vector<double> out(problem.outputs() * problem.size());
  const double start = wall_seconds();
  plan.apply(problem.strengths(), out);
  return wall_seconds() - start;
}

void threads(const FmmOptions& o, Json& report) {
  const FmmPoints cloud = sphere_cloud(1000000);
  const FmmProblem problem(cloud, "kelvin");
  const Plan plan = problem.plan({.precision = "float"}, static_cast<std::size_t>(o.gigabytes * (1 << 30)));
  // Interleaved, so that other load falls on all alike; the best of each.
  double one = 1e300, two = 1e300, single = 0, both = 0;
  for (int k = 0; k < 4; ++k) {
    one = std::min(one, apply_seconds(plan, problem, 1)), two = std::min(two, apply_seconds(plan, problem, 2));
    single = std::max(single, pinned_rate(1)), both = std::max(both, pinned_rate(2));
  }
  const double scaling = one / two, control = both / single;
  std::printf(
      "\nTwo threads, 1 million points, float: %.3f s -> %.3f s, %.2fx; control (pinned direct sums) %.2fx; %.2f of "
      "it\n",
      one, two, scaling, control, scaling / control);
  report["threads"] = {
      {"one_s", one}, {"two_s", two}, {"scaling", scaling}, {"control", control}, {"relative", scaling / control}};
}

// The smallest N from which on the expansions win, both at their best of many runs.
void crossover(Json& report) {
  std::printf("\nCrossover with the direct sum, Kelvin on a sphere, tolerance 1e-4, one thread (ms; best leaf size)\n");
  std::printf("%8s %-7s %10s %10s %8s %10s\n", "points", "number", "direct", "expansions", "leaf", "automatic");
  const ThreadLimit limit(1);
  for (const char* precision : {"float", "double"}) {
    std::size_t smallest = 0;
    for (const std::size_t n : {600, 800, 1100, 1500, 2000, 2800, 4000, 5600, 8000}) {
      const FmmPoints cloud = sphere_cloud(n);
      const FmmProblem problem(cloud, "kelvin");
      const auto best = [&](const auto& run) {
        double least = 1e300, spent = 0;
        for (int k = 0; k < 5 || spent < 0.05; ++k) {
          const double s = run();
          least = std::min(least, s), spent += s;
        }
        return 1e3 * least;
      };
      const double direct = best([&] { return problem.direct_seconds(precision, n); });
      double expansions = std::numeric_limits<double>::infinity(), automatic = 0;  // ms
      std::size_t leaf = 0;
      bool direct_chosen = false;
      for (const std::size_t size : {0, 48, 80, 128, 200, 320}) {
        const Plan plan = problem.plan({.precision = precision, .leaf = size}, std::size_t{1} << 32);
        const double s = best([&] { return apply_seconds(plan, problem, 1); });
        if (size == 0) automatic = s, direct_chosen = plan.statistics().direct;
        if (!plan.statistics().direct && plan.statistics().far_pairs > 0 && s < expansions)
          expansions = s, leaf = plan.statistics().leaf_size;
      }
      if (expansions < direct && smallest == 0) smallest = n;
      if (expansions >= direct) smallest = 0;
      std::printf("%8zu %-7s %10.3f %10.3f %8zu %10.3f %s\n", n, precision, direct, expansions, leaf, automatic,
                  direct_chosen ? "(direct)" : "");
      report["crossover_rows"].push_back(
          {{"n", n},
           {"precision", precision},
           {"direct_s", 1e-3 * direct},
           {"expansions_s", std::isfinite(expansions) ? Json(1e-3 * expansions) : Json()},
           {"leaf_size", leaf},
           {"automatic_s", 1e-3 * automatic},
           {"automatic_direct", direct_chosen}});
    }
    std::printf("%s: expansions win from %zu points on\n", precision, smallest);
    report["crossover"][precision] = smallest;
  }
}

void paper_table(const FmmOptions& o, Json& rows) {
  // Zhu, Bridson & Greif 2015, Table 2: one thread of an i7-3770K; errors L_inf.
  struct Paper {
    const char* model;
    std::size_t n;
    double fmm, direct, error;
  };
  constexpr Paper kPaper[] = {{"star", 2675, 5.639, 0.095, 1.1e-5},
                              {"armadillo", 23245, 6.522, 7.071, 2.15e-4},
                              {"fertility", 220332, 56.642, 648.971, 7.7e-5},
                              {"moebius", 704480, 273.339, 6577.087, 4.3e-5},
                              {"dragon", 3609600, 949.959, 206429.02, 6.1e-5}};
  std::printf(
      "\nThe paper's Table 2 (its one thread on its models; here as many points on a sphere, one thread)\n"
      "Brute force of many points is extrapolated from a part of the targets (*)\n");
  for (const Paper& p : kPaper) {
    if (p.n > 1000000 && !o.large) {
      std::printf("%-10s %8zu: paper %.2f s, brute force %.0f s; here with --large\n", p.model, p.n, p.fmm, p.direct);
      continue;
    }
    std::printf("%-10s %8zu: paper %.2f s, brute force %.2f s, L_inf %.1e\n", p.model, p.n, p.fmm, p.direct, p.error);
    print_fmm_header();
    const FmmPoints cloud = sphere_cloud(p.n);
    const FmmProblem problem(cloud, "kelvin");
    Json row{{"model", p.model},      {"n", p.n},
             {"paper_fmm_s", p.fmm},  {"paper_direct_s", p.direct},
             {"paper_linf", p.error}, {"rows", Json::array()}};
    for (const char* precision : {"float", "double"}) measured(problem, {.precision = precision}, o, row["rows"]);
    if (p.n < 100000 || o.large) {
      FmmOptions once = o;
      once.applies = 1;
      measured(problem, {.scheme = "rbf-sphere", .tolerance = 1e-3}, once, row["rows"]);
    }
    for (const char* precision : {"float", "double"})
      measured(problem, {.precision = precision, .scheme = "direct"}, o, row["rows"]);
    rows.push_back(row);
  }
}

}  // namespace

void fmm_report(const FmmOptions& o, Json& report) {
  tolerances(o, report["tolerances"]);
  sizes(o, report["sizes"]);
  threads(o, report);
  crossover(report);
  paper_table(o, report["paper"]);
}

}  // namespace sherd::bench
