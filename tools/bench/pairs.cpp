#include "tools/bench/pairs.h"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "kernels/core/random.h"
#include "kernels/fmm/pairs.h"

namespace sherd::bench {
namespace {

using namespace fmm;

struct Sum {
  PairSum sum;
  const char* name;
};
constexpr Sum kSums[] = {{PairSum::kLaplaceValue, "laplace value"}, {PairSum::kLaplaceGradient, "laplace gradient"},
                         {PairSum::kDipoleValue, "dipole value"},   {PairSum::kDipoleGradient, "dipole gradient"},
                         {PairSum::kKelvinValue, "kelvin value"},   {PairSum::kKelvinGradient, "kelvin gradient"},
                         {PairSum::kKelvinStress, "kelvin stress"}, {PairSum::kKelvinTraction, "kelvin traction"},
                         {PairSum::kElasticValue, "elastic value"}, {PairSum::kElasticGradient, "elastic gradient"}};
constexpr struct {
  Instructions instructions;
  const char* name;
} kProcessors[] = {
    {Instructions::kPortable, "portable"}, {Instructions::kAvx2, "avx2"}, {Instructions::kAvx512, "avx512"}};

// Million pairs a second of a hand-tuned program on one core of an AMD Zen 4, where there is one; 0 otherwise. Double
// precision with two Newton steps.
double reference(PairSum sum, bool single, Instructions instructions) {
  struct Row {
    PairSum sum;
    double avx512, avx2, twice;
  };
  constexpr Row rows[] = {{PairSum::kKelvinValue, 2710, 2007, 1075},
                          {PairSum::kKelvinTraction, 1784, 1331, 755},
                          {PairSum::kKelvinStress, 1420, 1040, 615},
                          {PairSum::kKelvinGradient, 1106, 852, 474}};
  for (const Row& r : rows)
    if (r.sum == sum && instructions != Instructions::kPortable) {
      const bool wide = instructions == Instructions::kAvx512;
      return single ? (wide ? r.avx512 : r.avx2) : (wide ? r.twice : 0);
    }
  return 0;
}

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

template <class T>
double million_pairs_per_second(PairSum sum, Instructions instructions, const PairsOptions& o) {
  const std::size_t targets = (o.targets + kPairPad - 1) / kPairPad * kPairPad;
  Random random(1);
  const auto column = [&](std::size_t n) {
    std::vector<T> v(n);
    for (T& a : v) a = static_cast<T>(random.uniform(-1, 1));
    return v;
  };
  std::vector<std::vector<T>> x, y, strength, out(kMaxOutputs, std::vector<T>(targets));
  for (int k = 0; k < 6; ++k) x.push_back(column(targets));
  for (int k = 0; k < 3; ++k) y.push_back(column(o.sources));
  PairSources<T> sources{o.sources, {y[0].data(), y[1].data(), y[2].data()}, {}};
  for (std::size_t k = 0; k < kMaxStrengths; ++k) {
    strength.push_back(column(o.sources));
    sources.strength[k] = strength[k].data();
  }
  const PairTargets<T> block{targets, {x[0].data(), x[1].data(), x[2].data()}, {x[3].data(), x[4].data(), x[5].data()}};
  T* results[kMaxOutputs];
  for (std::size_t k = 0; k < kMaxOutputs; ++k) results[k] = out[k].data();
  const PairConstants<T> constants{T(1.2), T(0.7), T(0.4), T(0.9), T(0.5)};
  const T shift[3] = {T(0.1), T(0.2), T(0.3)};
  const PairFunction<T> function = pair_function<T>(sum, instructions);
  const double pairs = 1e-6 * static_cast<double>(targets * o.sources);
  double best = 0;
  for (int repeat = 0; repeat < o.repeats; ++repeat) {
    const double start = cpu_seconds();
    double spent = 0;
    std::size_t calls = 0;
    while (spent < o.seconds) {
      for (int k = 0; k < 20; ++k, ++calls) function(sources, block, shift, constants, results);
      spent = cpu_seconds() - start;
    }
    best = std::max(best, pairs * static_cast<double>(calls) / spent);
  }
  return best;
}

}  // namespace

int run_pairs(const PairsOptions& options) {
  nlohmann::json rows = nlohmann::json::array();
  std::printf("Million pairs a second, one thread, CPU time; blocks of %zu targets and %zu sources\n", options.targets,
              options.sources);
  std::printf("%-18s %-8s %-10s %9s %10s %7s\n", "sum", "number", "processor", "rate", "reference", "share");
  for (const bool single : {true, false})
    for (const Sum& s : kSums)
      for (const auto& p : kProcessors) {
        if (p.instructions > best_instructions()) continue;
        const double rate = single ? million_pairs_per_second<float>(s.sum, p.instructions, options)
                                   : million_pairs_per_second<double>(s.sum, p.instructions, options);
        const double known = reference(s.sum, single, p.instructions);
        const char* number = single ? "float" : "double";
        std::printf("%-18s %-8s %-10s %9.0f", s.name, number, p.name, rate);
        if (known > 0)
          std::printf(" %10.0f %6.0f%%\n", known, 100 * rate / known);
        else
          std::printf("\n");
        rows.push_back({{"sum", s.name},
                        {"precision", number},
                        {"instructions", p.name},
                        {"mpairs_s", rate},
                        {"reference_mpairs_s", known > 0 ? nlohmann::json(known) : nlohmann::json()}});
      }
  if (options.json.empty()) return 0;
  std::ofstream file(options.json);
  file << nlohmann::json{{"targets", options.targets}, {"sources", options.sources}, {"rows", rows}}.dump(1) << '\n';
  file.flush();
  if (file) return 0;
  std::fprintf(stderr, "sherd-bench: cannot write %s; choose a folder that exists\n", options.json.c_str());
  return 2;
}

}  // namespace sherd::bench
