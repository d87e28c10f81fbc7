#include "engine/stress/analysis_solver.h"

#include <chrono>

#include "engine/stress/stress.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// On a thin wall the smallest singular values of the system are 1e-2 and below even when preconditioned, so that the
// stress errs by that much more than the residual.
constexpr Real kResidualShare = 0.01;
constexpr Real kLeastResidual = 1e-12;  // what double precision reaches

class DirectSolver final : public SolidSolver {
 public:
  DirectSolver(const SurfaceMesh& mesh, const Elastic& material, const SolverOptions& options)
      : options_(options),
        bvh_(mesh),
        recovery_(mesh, {options.feature_angle, {}}),
        body_(mesh, material, elastic_options(options)) {
    if (!body_.ready()) throw InputError(body_.reason());
  }

  void solve(const Load& load, SolidReport& report, StageSeconds& seconds) override {
    state_.reset();
    const ParticularSolution particular(load.body_force, body_.material());
    ElasticSolution solution;
    {
      const StageTimer timer(seconds.solve);
      solution = body_.solve(load, particular);
    }
    report.iterations = solution.krylov.iterations, report.products = solution.krylov.products;
    report.residual = solution.krylov.residual;
    report.converged = solution.ok, report.reason = solution.reason;
    report.solved = solution.ok || (solution.krylov.residual <= options_.tolerance && finite(solution.displacement));
    if (!report.solved) return;
    const StageTimer timer(seconds.recover);
    state_ = std::make_unique<StressState>(body_, recovery_, bvh_, load, particular, solution);
  }
  const StressField* field() const override { return state_.get(); }

 private:
  static ElasticOptions elastic_options(const SolverOptions& o) {
    ElasticOptions e;
    e.krylov.tolerance = std::max(kLeastResidual, kResidualShare * o.tolerance);
    e.double_storage = o.double_storage, e.max_bytes = o.max_bytes;
    return e;
  }
  static bool finite(const Vec3Column& u) {
    for (std::size_t i = 0; i < u.size(); ++i)
      if (!is_finite(u[i])) return false;
    return !u.empty();
  }

  SolverOptions options_;
  TriangleBvh bvh_;
  SurfaceRecovery recovery_;
  ElasticBody body_;
  std::unique_ptr<StressState> state_;
};

}  // namespace

StageTimer::StageTimer(double& sum) : sum_(sum), start_(now()) {}
StageTimer::~StageTimer() {
  sum_ += now() - start_;
}

std::size_t unknowns_of(Formulation formulation, std::size_t vertices, std::size_t triangles) {
  return 3 * (formulation == Formulation::kDirect ? vertices : triangles);
}

std::unique_ptr<SolidSolver> make_solver(const SurfaceMesh& mesh, const Elastic& material,
                                         const SolverOptions& options) {
  SHERD_CHECK(options.formulation == Formulation::kDirect, "refused by require_options()");
  return std::make_unique<DirectSolver>(mesh, material, options);
}

}  // namespace sherd
