// The paper's formulation (its eq. 4-8), kept as the reference the direct one is compared with: u = V rho, the Kelvin
// single layer of a density that is constant on each triangle, collocated at the centroids,
//   rho/2 + K* rho = t - sigma_p n      (K*: principal value of the traction of V rho; n outward, also in cavities),
// where sigma_p balances the body force. Accurate on smooth bodies; at sharp edges the density is singular and stress
// errs by tens of percent, in plate bending by its sign (design notes, section 5): use engine/elastostatic/solver.h for
// answers.
#pragma once
#include <memory>
#include <string>

#include "engine/elastostatic/krylov.h"
#include "engine/elastostatic/newton.h"
#include "engine/elastostatic/rigid_modes.h"

namespace sherd {

enum class KrylovMethod { kBicgstab, kGmres };

struct IndirectOptions {
  QuadratureOptions quadrature;
  KrylovOptions krylov;
  KrylovMethod method = KrylovMethod::kBicgstab;  // the paper's
  BodyForcePotential body_force = BodyForcePotential::kPolynomial;
  bool double_storage = false;                   // of the dense operator
  std::size_t max_bytes = std::size_t{6} << 30;  // refuse larger dense operators: (3 triangles)^2 numbers
};

struct IndirectSolution {
  bool ok = false;
  std::string reason;  // when not ok
  Vec3Column density;  // of the single layer per triangle, Pa
  KrylovResult krylov;
  // |R^T W (t - sigma_p n)| / (|t|_W + |sigma_p n|_W) over the faces' means: the share of the load in its net force and
  // moment, which the completion absorbed. Tractions that vary over a face keep their force but not their moment: a
  // balanced load of such reads O(h^2), not 0.
  Real incompatibility = 0;
};

// Everything that depends on the mesh and the material alone.
class IndirectBody {
 public:
  // mesh: valid (see surface_mesh.h), one solid. Throws nothing for numerical trouble: ready() is false with reason()
  // when the operator would not fit max_bytes.
  IndirectBody(const SurfaceMesh& mesh, const Elastic& material, const IndirectOptions& options);
  bool ready() const { return operator_ != nullptr; }
  const std::string& reason() const { return reason_; }
  // `particular`: of the whole body force of the load (ignored for BodyForcePotential::kNewton, see BodyForceField).
  // Deterministic; not converged or not finite is ok = false with the reason.
  IndirectSolution solve(const Load& load, const ParticularSolution& particular) const;
  // Stress that balances the load's body force, as solve() takes it.
  BodyForceField body_force_field(const Load& load, const ParticularSolution& particular) const;

  const Boundary& boundary() const { return boundary_; }
  const Elastic& material() const { return material_; }
  const IndirectOptions& options() const { return options_; }
  const LinearOperator& system() const { return *operator_; }  // 1/2 + K*, without completion

 private:
  template <class Scalar>
  void build();

  Elastic material_;
  IndirectOptions options_;
  Boundary boundary_;
  RigidModes modes_;
  std::unique_ptr<LinearOperator> operator_;
  std::unique_ptr<CompletedOperator> completed_;
  std::vector<Mat3> inverse_blocks_;  // of the diagonal, block-Jacobi
  std::string reason_;
};

}  // namespace sherd
