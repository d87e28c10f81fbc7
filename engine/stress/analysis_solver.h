// One solid's solver behind Analysis, whichever the formulation.
#pragma once
#include <memory>

#include "engine/stress/analysis.h"
#include "engine/stress/stress_field.h"

namespace sherd {

struct SolverOptions {
  Formulation formulation = Formulation::kDirect;
  Real feature_angle = 35;
  Real tolerance = 1e-4;  // wanted of the stress
  bool double_storage = true;
  std::size_t max_bytes = 0;
};

class SolidSolver {
 public:
  virtual ~SolidSolver() = default;
  // Iterations, residual, converged, solved and reason go to `report`, times to `seconds`.
  virtual void solve(const Load& load, SolidReport& report, StageSeconds& seconds) = 0;
  // Of the load last solved; null before, or when that failed.
  virtual const StressField* field() const = 0;
};

// Unknowns of the formulation on a closed mesh of so many vertices and triangles.
std::size_t unknowns_of(Formulation formulation, std::size_t vertices, std::size_t triangles);
// Builds the operator.
std::unique_ptr<SolidSolver> make_solver(const SurfaceMesh& mesh, const Elastic& material,
                                         const SolverOptions& options);

// Adds the seconds of its own life to `sum`.
class StageTimer {
 public:
  explicit StageTimer(double& sum);
  ~StageTimer();
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  double& sum_;
  double start_;
};

}  // namespace sherd
