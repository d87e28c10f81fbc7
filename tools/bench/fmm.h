// sherd-bench fmm: time and error of the fast multipole method.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "kernels/fmm/plan.h"

namespace sherd::bench {

struct FmmOptions {
  std::string points, mesh;           // files; empty: none
  std::vector<std::string> surfaces;  // sphere:N, cube:N
  std::vector<std::string> kernels, precisions, schemes;
  std::vector<double> tolerances;
  std::vector<int> threads;
  std::size_t leaf = 0;  // 0: by the cost model
  int applies = 3;       // at least; the median counts
  bool large = false;    // in the report: 3.6 million points
  double gigabytes = 16;
  std::string json, trace;  // files; empty: none
};
// Prints the tables; returns the exit code. Without points, kernels, tolerances, precisions, schemes and threads: the
// standard report.
int run_fmm(const FmmOptions& options);

struct FmmPoints {
  std::string name;
  Vec3Column points;
};
// Points on the unit sphere, or in the unit cube, at random.
FmmPoints sphere_cloud(std::size_t n);
// InputError names the file, the line and the remedy.
std::vector<FmmPoints> read_clouds(const FmmOptions& options);

struct FmmSetting {
  std::string kernel = "kelvin", precision = "double", scheme = "default";
  double tolerance = 1e-4;
  int threads = 1;
  std::size_t leaf = 0;
};
struct FmmRow {
  FmmSetting setting;
  std::string points;
  std::size_t n = 0;
  double operators_s = 0, setup_s = 0;  // setup with operators, which take time when first used only
  double apply_s = 0, apply_cpu_s = 0;  // wall and processor, medians
  bool extrapolated = false;            // direct sums of many points: from a part of the targets
  double rel_l2 = 0, rel_linf = 0;      // at 1000 random targets
  double peak_mb = 0, near_pairs_s = 0, near_share = 0;
  fmm::PlanStatistics plan;
  std::string refused;  // why there are no numbers
};
fmm::PairSum fmm_kernel(const std::string& name);
std::vector<std::string> fmm_kernels();
// A problem of one cloud: targets are the sources; strengths at random about zero; normals at random.
class FmmProblem {
 public:
  FmmProblem(const FmmPoints& cloud, const std::string& kernel);
  fmm::Plan plan(const FmmSetting& setting, std::size_t max_bytes) const;
  const std::vector<double>& strengths() const { return strengths_; }
  std::size_t size() const { return cloud_.points.size(); }
  std::size_t outputs() const { return fmm::pair_shape(sum_).outputs; }
  void errors(const std::vector<double>& out, FmmRow& row) const;
  // Seconds of a direct sum to the first `targets` targets.
  double direct_seconds(const std::string& precision, std::size_t targets, std::vector<double>* out = nullptr) const;
  const FmmPoints& cloud() const { return cloud_; }

 private:
  const FmmPoints& cloud_;
  fmm::PairSum sum_;
  Vec3Column normals_;
  std::vector<double> strengths_;  // without normals
  std::vector<double> all_;        // with them
  std::vector<std::uint32_t> checked_;
  std::vector<double> right_;
};
FmmRow measure_fmm(const FmmProblem& problem, const FmmSetting& setting, const FmmOptions& options);
void print_fmm_header();
void print_fmm_row(const FmmRow& row);
nlohmann::json fmm_json(const FmmRow& row);

// Tables of the standard report, under `report`'s keys.
void fmm_report(const FmmOptions& options, nlohmann::json& report);

// Traces one application: Chrome trace-event JSON to `path`, a summary to the terminal. InputError when the file cannot
// be written.
void trace_fmm(const FmmProblem& problem, const FmmSetting& setting, const FmmOptions& options,
               const std::string& path);

double process_seconds();  // of processor time, all threads
double wall_seconds();

}  // namespace sherd::bench
