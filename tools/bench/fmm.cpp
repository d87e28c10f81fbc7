#include "tools/bench/fmm.h"

#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <limits>

#include "kernels/core/error.h"
#include "kernels/core/parallel.h"
#include "kernels/core/random.h"
#include "kernels/fmm/far_field.h"

namespace sherd::bench {
namespace {

using namespace fmm;

struct Kernel {
  const char* name;
  PairSum sum;
};
constexpr Kernel kKernels[] = {{"kelvin", PairSum::kKelvinValue},
                               {"laplace", PairSum::kLaplaceValue},
                               {"laplace-gradient", PairSum::kLaplaceGradient},
                               {"dipole", PairSum::kDipoleValue},
                               {"dipole-gradient", PairSum::kDipoleGradient},
                               {"kelvin-gradient", PairSum::kKelvinGradient},
                               {"kelvin-stress", PairSum::kKelvinStress},
                               {"kelvin-traction", PairSum::kKelvinTraction},
                               {"elastic", PairSum::kElasticValue},
                               {"elastic-gradient", PairSum::kElasticGradient}};
// Kelvin's at Poisson's ratio 0.22 and shear modulus 1 / 16 pi (1 - nu), the rest of the order of one.
constexpr PairConstants<double> kConstants{3 - 4 * 0.22, 1, 0.7, 0.8, 1};
constexpr std::size_t kChecked = 1000;

double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

void reset_peak() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}
double peak_megabytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024;
  return 0;
}

void measure_plan(const FmmProblem& problem, const FmmOptions& options, FmmRow& row) {
  const double start = wall_seconds();
  const Plan plan = problem.plan(row.setting, static_cast<std::size_t>(options.gigabytes * (1 << 30)));
  row.setup_s = wall_seconds() - start;
  row.plan = plan.statistics();
  row.operators_s = row.plan.translations_seconds;
  std::vector<double> out(problem.outputs() * problem.size()), wall, cpu;
  double spent = 0;
  // Short applications are repeated for half a second: single ones are noise.
  for (int k = 0; k < options.applies || (spent < 0.5 && k < 50); ++k) {
    const double w = wall_seconds(), c = process_seconds();
    plan.apply(problem.strengths(), out);
    wall.push_back(wall_seconds() - w), cpu.push_back(process_seconds() - c);
    spent += wall.back();
  }
  row.apply_s = median(wall), row.apply_cpu_s = median(cpu);
  double near = 0, all = 0;
  for (const TaskRecord& t : plan.apply_traced(problem.strengths(), out)) {
    all += t.end - t.begin;
    if (std::string_view(t.name) == "near field") near += t.end - t.begin;
  }
  row.near_pairs_s = near > 0 ? row.plan.direct_pairs / near : 0;
  row.near_share = all > 0 ? near / all : 0;
  problem.errors(out, row);
}

void measure_direct(const FmmProblem& problem, FmmRow& row) {
  // 4e10 pairs are a minute in double precision.
  const double n = static_cast<double>(problem.size());
  const auto targets = static_cast<std::size_t>(std::min(n, std::ceil(1e10 / n)));
  row.extrapolated = targets < problem.size();
  std::vector<double> out;
  const double cpu = process_seconds();
  const double seconds = problem.direct_seconds(row.setting.precision, targets, row.extrapolated ? nullptr : &out);
  const double factor = n / static_cast<double>(targets);
  row.apply_s = seconds * factor, row.apply_cpu_s = (process_seconds() - cpu) * factor;
  row.near_pairs_s = n * n / row.apply_cpu_s, row.near_share = 1;
  row.plan.direct = true, row.plan.direct_pairs = n * n;
  if (!row.extrapolated) problem.errors(out, row);
}

int run_rows(const FmmOptions& o, nlohmann::json& rows) {
  const std::vector<FmmPoints> clouds = read_clouds(o);
  const auto or_one = [](auto values, auto standard) {
    if (values.empty()) values.push_back(standard);
    return values;
  };
  print_fmm_header();
  bool traced = false;
  for (const FmmPoints& cloud : clouds)
    for (const std::string& kernel : or_one(o.kernels, std::string("kelvin"))) {
      const FmmProblem problem(cloud, kernel);
      for (const std::string& scheme : or_one(o.schemes, std::string("default")))
        for (const std::string& precision : or_one(o.precisions, std::string("double")))
          for (const double tolerance : or_one(o.tolerances, 1e-4))
            for (const int threads : or_one(o.threads, 1)) {
              const FmmSetting setting{kernel, precision, scheme, tolerance, threads, o.leaf};
              const FmmRow row = measure_fmm(problem, setting, o);
              print_fmm_row(row);
              rows.push_back(fmm_json(row));
              if (o.trace.empty() || traced || !row.refused.empty() || scheme == "direct") continue;
              trace_fmm(problem, setting, o, o.trace);
              traced = true;
            }
    }
  return 0;
}

}  // namespace

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
double process_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

PairSum fmm_kernel(const std::string& name) {
  for (const Kernel& k : kKernels)
    if (name == k.name) return k.sum;
  throw InputError(fmt::format("--kernel {}: unknown", name));
}
std::vector<std::string> fmm_kernels() {
  std::vector<std::string> names;
  for (const Kernel& k : kKernels) names.emplace_back(k.name);
  return names;
}

FmmProblem::FmmProblem(const FmmPoints& cloud, const std::string& kernel) : cloud_(cloud), sum_(fmm_kernel(kernel)) {
  const std::size_t n = size(), own = first_normal(sum_);
  const bool normals = own < pair_shape(sum_).strengths;
  Random random(3);
  if (normals || pair_shape(sum_).target_normals) normals_ = sphere_cloud(n).points;
  strengths_.resize(own * n);
  for (double& s : strengths_) s = random.uniform(-1, 1);
  all_ = strengths_;
  if (normals)
    for (const auto* v : {&normals_.x, &normals_.y, &normals_.z}) all_.insert(all_.end(), v->begin(), v->end());
  for (std::size_t i = 0; i < kChecked; ++i) checked_.push_back(static_cast<std::uint32_t>(random.next() % n));
  right_.resize(outputs() * kChecked);
  direct_sum({.sum = sum_,
              .sources = cloud_.points,
              .strengths = all_,
              .targets = cloud_.points,
              .constants = kConstants,
              .target_normals = &normals_,
              .subset = checked_},
             right_);
}

Plan FmmProblem::plan(const FmmSetting& s, std::size_t max_bytes) const {
  PlanOptions o;
  o.tolerance = s.tolerance, o.leaf_size = s.leaf, o.max_bytes = max_bytes;
  o.arithmetic = s.precision == "float"   ? Arithmetic::kFloat
                 : s.precision == "mixed" ? Arithmetic::kMixed
                                          : Arithmetic::kDouble;
  o.scheme = s.scheme == "rbf-sphere" ? Scheme::kRbfSphere : Scheme::kFast;
  return Plan(sum_, kConstants, {cloud_.points, cloud_.points, &normals_, &normals_}, o);
}

double FmmProblem::direct_seconds(const std::string& precision, std::size_t targets, std::vector<double>* out) const {
  std::vector<std::uint32_t> subset(targets);
  for (std::size_t i = 0; i < targets; ++i) subset[i] = static_cast<std::uint32_t>(i);
  std::vector<double> own(outputs() * targets);
  const double start = wall_seconds();
  direct_sum({.sum = sum_,
              .sources = cloud_.points,
              .strengths = all_,
              .targets = cloud_.points,
              .constants = kConstants,
              .precision = precision == "float" ? Precision::kFloat : Precision::kDouble,
              .target_normals = &normals_,
              .subset = targets < size() ? std::optional<std::span<const std::uint32_t>>(subset) : std::nullopt},
             own);
  const double seconds = wall_seconds() - start;
  if (out) *out = std::move(own);
  return seconds;
}

void FmmProblem::errors(const std::vector<double>& out, FmmRow& row) const {
  double difference = 0, square = 0, worst = 0, largest = 0;
  for (std::size_t k = 0; k < outputs(); ++k)
    for (std::size_t i = 0; i < kChecked; ++i) {
      const double right = right_[k * kChecked + i], e = out[k * size() + checked_[i]] - right;
      difference += e * e, square += right * right;
      worst = std::max(worst, std::abs(e)), largest = std::max(largest, std::abs(right));
    }
  row.rel_l2 = square > 0 ? std::sqrt(difference / square) : std::sqrt(difference);
  row.rel_linf = largest > 0 ? worst / largest : worst;
}

FmmRow measure_fmm(const FmmProblem& problem, const FmmSetting& setting, const FmmOptions& options) {
  FmmRow row;
  row.setting = setting, row.points = problem.cloud().name, row.n = problem.size();
  const ThreadLimit limit(setting.threads);
  reset_peak();
  try {
    if (setting.scheme == "direct")
      measure_direct(problem, row);
    else
      measure_plan(problem, options, row);
  } catch (const InputError& e) {
    row.refused = e.what();
  }
  row.peak_mb = peak_megabytes();
  return row;
}

void print_fmm_header() {
  std::printf("%9s %-10s %-10s %-6s %7s %3s | %6s %7s %9s %9s %6s | %8s %8s | %5s %5s %7s %6s %7s\n", "points",
              "kernel", "scheme", "number", "tol", "thr", "oper.s", "setup s", "apply s", "cpu s", "cpu/1M", "rel L2",
              "rel Linf", "leaf", "rank", "Mpair/s", "near %", "peak MB");
}

void print_fmm_row(const FmmRow& r) {
  std::printf("%9zu %-10s %-10s %-6s %7.0e %3d | ", r.n, r.setting.kernel.c_str(), r.setting.scheme.c_str(),
              r.setting.precision.c_str(), r.setting.tolerance, r.setting.threads);
  if (!r.refused.empty()) {
    std::printf("%s\n", r.refused.c_str());
    return;
  }
  std::printf("%6.2f %7.3f %8.4f%c %8.4f%c %6.2f | ", r.operators_s, r.setup_s, r.apply_s, r.extrapolated ? '*' : ' ',
              r.apply_cpu_s, r.extrapolated ? '*' : ' ', 1e6 * r.apply_cpu_s / static_cast<double>(r.n));
  if (r.extrapolated)
    std::printf("%8s %8s", "", "");
  else
    std::printf("%8.1e %8.1e", r.rel_l2, r.rel_linf);
  std::printf(" | %5zu %5zu %7.0f %6.0f %7.0f%s\n", r.plan.leaf_size, r.plan.rank.empty() ? 0 : r.plan.rank[0],
              1e-6 * r.near_pairs_s, 100 * r.near_share, r.peak_mb, r.plan.direct ? "  direct" : "");
  std::fflush(stdout);
}

nlohmann::json fmm_json(const FmmRow& r) {
  nlohmann::json j{{"points", r.points},
                   {"n", r.n},
                   {"kernel", r.setting.kernel},
                   {"scheme", r.setting.scheme},
                   {"precision", r.setting.precision},
                   {"tolerance", r.setting.tolerance},
                   {"threads", r.setting.threads}};
  if (!r.refused.empty()) {
    j["refused"] = r.refused;
    return j;
  }
  const double n = static_cast<double>(r.n);
  j.update({{"setup_s", r.setup_s},
            {"operators_s", r.operators_s},
            {"tree_s", r.plan.tree_seconds},
            {"lists_s", r.plan.lists_seconds},
            {"arrays_s", r.plan.arrays_seconds},
            {"apply_s", r.apply_s},
            {"apply_cpu_s", r.apply_cpu_s},
            {"extrapolated", r.extrapolated},
            {"peak_mb", r.peak_mb},
            {"points_per_s", n / r.apply_s},
            {"near_pairs_per_s", r.near_pairs_s},
            {"near_share", r.near_share},
            {"direct", r.plan.direct},
            {"leaf_size", r.plan.leaf_size},
            {"boxes", r.plan.boxes},
            {"direct_pairs", r.plan.direct_pairs},
            {"far_pairs", r.plan.far_pairs},
            {"rank", r.plan.rank}});
  j["rel_l2"] = r.extrapolated ? nlohmann::json() : nlohmann::json(r.rel_l2);
  j["rel_linf"] = r.extrapolated ? nlohmann::json() : nlohmann::json(r.rel_linf);
  return j;
}

int run_fmm(const FmmOptions& o) {
  nlohmann::json result;
  try {
    const bool standard = o.points.empty() && o.mesh.empty() && o.surfaces.empty() && o.kernels.empty() &&
                          o.precisions.empty() && o.schemes.empty() && o.tolerances.empty() && o.threads.empty() &&
                          o.trace.empty() && o.leaf == 0;
    if (standard) {
      fmm_report(o, result);
    } else {
      result["rows"] = nlohmann::json::array();
      run_rows(o, result["rows"]);
    }
    if (!o.json.empty()) {
      std::ofstream file(o.json);
      file << result.dump(1) << '\n';
      file.flush();
      if (!file) throw InputError(fmt::format("cannot write {}; choose a folder that exists", o.json));
    }
  } catch (const InputError& e) {
    std::fprintf(stderr, "sherd-bench: %s\n", e.what());
    return 2;
  }
  return 0;
}

}  // namespace sherd::bench
