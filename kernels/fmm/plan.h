// The fast multipole method: a sum over all pairs of points in time proportional to their number. Kernel-independent
// (Ying, Biros & Zorin 2004), with expansions compressed as translations.h says; few points are summed directly. Plan
// once, apply many times.
#pragma once
#include <memory>
#include <span>
#include <string>

#include "kernels/core/column.h"
#include "kernels/core/task_graph.h"
#include "kernels/fmm/direct.h"
#include "kernels/fmm/pairs.h"

namespace sherd::fmm {

// kMixed: expansions in single, pairs in double precision.
enum class Arithmetic : std::uint8_t { kFloat, kMixed, kDouble };

// kFast: translations.h. kRbfSphere: the reference of rbf.h, whose plans take more memory and reach 1e-7 for Laplace
// sums and 1e-4 for Kelvin's, with expansions in single precision 3e-4 and 3e-3. kDirect: no far field.
enum class Scheme : std::uint8_t { kFast, kRbfSphere, kDirect };

struct PlanOptions {
  Real tolerance = 1e-4;  // relative L2 error of the values, 1e-9 .. 1e-2; single precision reaches 1e-5
  Arithmetic arithmetic = Arithmetic::kDouble;
  Scheme scheme = Scheme::kFast;
  std::size_t leaf_size = 0;                      // 0: by the cost model
  std::size_t max_bytes = std::size_t{16} << 30;  // refuse plans that would take more
};

struct Points {
  const Vec3Column& sources;
  const Vec3Column& targets;
  const Vec3Column* source_normals = nullptr;  // of sums with dipoles
  const Vec3Column* target_normals = nullptr;  // of tractions
};

struct PlanStatistics {
  double translations_seconds = 0, tree_seconds = 0, lists_seconds = 0, arrays_seconds = 0;
  std::size_t leaf_size = 0, boxes = 0, leaves = 0, levels = 0;
  double direct_pairs = 0, far_pairs = 0;
  std::vector<std::size_t> rank;  // of each far field
  bool direct = false;            // everything is summed directly
  std::size_t bytes = 0;          // of the plan and one application
};

// When a task ran, for --trace and the summary table.
struct TaskRecord {
  const char* name;
  std::size_t boxes;
  int worker;
  double begin, end;  // seconds from the start of the application
};

class Plan {
 public:
  // Points are copied. Throws InputError where sizes do not fit, a coordinate is not finite, the tolerance is out of
  // range or the memory does not suffice.
  Plan(PairSum sum, const PairConstants<double>& constants, const Points& points, const PlanOptions& options);
  ~Plan();
  Plan(Plan&&) noexcept;
  Plan& operator=(Plan&&) noexcept;

  // Columns that apply() takes: pair_shape(sum).strengths without the normal's; and gives.
  std::size_t strengths() const;
  std::size_t outputs() const;
  // strengths: columns of as many numbers as there are sources; out: columns of as many as there are targets,
  // overwritten. Several sets of strengths stand one after another in both arrays: translations serve all together.
  // Thread safe; the same bits for any number of threads. Throws InputError where sizes do not fit or a strength is not
  // finite.
  void apply(std::span<const double> strengths, std::span<double> out, std::size_t sets = 1) const;
  // The same, and when each task ran; numbered as in tasks().
  std::vector<TaskRecord> apply_traced(std::span<const double> strengths, std::span<double> out) const;
  const TaskGraph& tasks() const;
  const PlanStatistics& statistics() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sherd::fmm
