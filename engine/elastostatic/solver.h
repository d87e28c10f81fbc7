// The elastostatic stage (paper 4): displacement of the boundary under a load, by the direct formulation.
#pragma once
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "engine/elastostatic/deflation.h"
#include "engine/elastostatic/factored.h"
#include "engine/elastostatic/fast_operator.h"
#include "engine/elastostatic/krylov.h"
#include "engine/elastostatic/rigid_modes.h"
#include "engine/elastostatic/single_layer.h"
#include "engine/elastostatic/solution_history.h"
#include "engine/elastostatic/testing.h"

namespace sherd {

// Which vertices get Petrov-Galerkin rows (testing.h): none, those where elements are longer than `thin_ratio` times
// the wall is thick, or all.
enum class TestingRule { kCollocation, kAuto, kGalerkin };

// kAuto: triangular factors where they cost little (up to 1500 unknowns) or where elements are more than 2.5 times as
// long as the wall is thick (up to 12,000), a coarse space otherwise, and the factors after all where that does not
// converge. The fast operator has no factors: block-Jacobi first, a coarse space for slender walls and where that does
// not converge.
enum class Preconditioning { kAuto, kDeflation, kFactored };

// A dense matrix, or the fast multipole method (fast_operator.h). kAuto: whichever is sooner ready, as measured.
enum class OperatorKind { kAuto, kDense, kFast };

struct ElasticOptions {
  ReconstructionOptions reconstruction;
  TestingRule testing = TestingRule::kAuto;
  Real thin_ratio = 0.6;
  QuadratureOptions quadrature;
  KrylovOptions krylov;
  DeflationOptions deflation;
  Preconditioning preconditioning = Preconditioning::kAuto;
  // A coarse space from the start: what needs_coarse_space() said of an earlier ElasticBody of this mesh.
  bool coarse_space = false;
  OperatorKind kind = OperatorKind::kAuto;
  // kAuto: the most a dense matrix is made for. Bodies that are not bulky take a finer far field and many products.
  std::size_t dense_bulky_unknowns = 6000, dense_unknowns = 12000;
  FastOptions fast;
  bool double_storage = false;  // of the dense operator; float storage costs 3e-8 .. 2e-6 of the stress
  std::size_t max_bytes = std::size_t{6} << 30;  // refuse larger operators
};

struct ElasticSolution {
  bool ok = false;
  std::string reason;       // when not ok
  Vec3Column displacement;  // of the homogeneous problem at vertices, m (add particular.displacement for the whole)
  KrylovResult krylov;      // iterations and products of all attempts
  bool factored = false;    // preconditioned by triangular factors
  bool warm = false;        // started from earlier solutions
  // Share of the displacement (rms over the surface, 0 to 1) that is the rigid motion the completion absorbed: what of
  // the load did not balance, and the discretisation's own imbalance.
  Real incompatibility = 0;
};

// Everything that depends on the mesh and the material alone: kept as long as the mesh lives, one solve per load.
class ElasticBody {
 public:
  // mesh: valid (see surface_mesh.h). Throws nothing for numerical trouble: ready() is false with reason() when the
  // operator would not fit max_bytes.
  ElasticBody(const SurfaceMesh& mesh, const Elastic& material, const ElasticOptions& options);
  bool ready() const { return operator_ != nullptr; }
  const std::string& reason() const { return reason_; }
  // What the solver subtracts: the body force's polynomial and the mean stress of what remains, so that uniformly
  // stressed bodies are exact on any mesh. Pass it to solve() and to StressState.
  ParticularSolution particular(const Load& load) const;
  // Deterministic; not converged or not finite is ok = false with the reason. `history`, of solves of this mesh and
  // material alone: where the iteration starts from, and what a solution is added to.
  ElasticSolution solve(const Load& load, const ParticularSolution& particular,
                        SolutionHistory* history = nullptr) const;

  const Boundary& boundary() const { return boundary_; }
  const Elastic& material() const { return material_; }
  const ElasticOptions& options() const { return options_; }
  const LinearOperator& system() const { return *operator_; }  // without completion
  bool dense() const { return make_factors_ != nullptr; }      // a dense matrix, or the fast multipole method
  std::size_t bytes() const;                                   // of the operator, its factors and coarse space
  // A solve has found that plain iterations do not converge, or a coarse space was there from the start. Later solves
  // begin with it: a body made anew must be told, to solve bit for bit as this one would.
  bool needs_coarse_space() const;
  const Reconstruction& reconstruction() const { return reconstruction_; }
  const Testing& testing() const { return testing_; }

 private:
  template <class Scalar>
  void build_dense();
  void build_fast();
  void precondition();
  void deflate() const;
  // Makes the factors when they are not there yet; false when they do not fit max_bytes or a pivot vanished.
  bool factor() const;
  Vec3Column right_hand_side(const Load& load, const ParticularSolution& particular) const;
  KrylovResult iterate(std::span<const Real> b, std::span<Real> x, bool& factored) const;
  Real strained_size(std::span<const Real> homogeneous, const ParticularSolution& particular) const;

  Elastic material_;
  ElasticOptions options_;
  Boundary boundary_;
  std::vector<Real> edge_over_wall_;  // of a face
  Reconstruction reconstruction_;
  Testing testing_;
  RigidModes modes_;
  CavityModes cavities_;
  std::unique_ptr<LinearOperator> operator_;
  std::unique_ptr<CompletedOperator> completed_;
  std::vector<Mat3> inverse_blocks_;  // of the diagonal, for the preconditioner
  mutable std::unique_ptr<Deflation> deflation_;
  bool slender_ = false;
  std::size_t operator_bytes_ = 0;
  std::function<std::unique_ptr<FactoredInverse>()> make_factors_;
  mutable std::unique_ptr<FactoredInverse> factored_;
  mutable std::mutex factoring_;
  std::string reason_;
};

}  // namespace sherd
