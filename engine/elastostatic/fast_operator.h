// The direct formulation's operator without a dense matrix: three point sources a panel summed by the fast multipole
// method, corrected near the target by stored blocks (near_field.h). Cost and memory grow with the number of panels.
// Both parts use the Guenter form (dense_operator.h): over a part of the surface the forms differ.
#pragma once
#include "engine/elastostatic/linear_operator.h"
#include "engine/elastostatic/near_field.h"
#include "kernels/fmm/plan.h"

namespace sherd {

struct FastOptions {
  Real tolerance = 0;  // of the far field; 0: far_tolerance() of the body
  fmm::Arithmetic arithmetic = fmm::Arithmetic::kMixed;
  std::size_t leaf_size = 0;  // of its tree; 0: as the cost model says, which sums few points directly
};

// Bending of slender bodies divides errors of the operator by its small singular values, which fall with the square of
// thickness (2 volume / area) over length (diagonal): 1e-5 for bulky bodies, down to 1e-8.
Real far_tolerance(const Boundary& boundary);
// Whether that is 1e-5: thickness at least a tenth of the length.
bool is_bulky(const Boundary& boundary);

class FastOperator final : public LinearOperator {
 public:
  // Keeps references to boundary, reconstruction and testing. options.tolerance > 0.
  FastOperator(const Boundary& boundary, const Reconstruction& reconstruction, Real nu, const Testing& testing,
               const FastOptions& options);
  std::size_t size() const override { return 3 * boundary_.mesh.vertex_count(); }
  void apply(std::span<const Real> x, std::span<Real> y) const override;
  // Eight vectors share the far field's translations.
  void apply_block(std::span<const Real> x, std::size_t count, std::span<Real> y) const override;
  Mat3 diagonal_block(std::size_t p) const override;

  // Estimates, for so many triangles, vertices and, of these, tested ones (not collocated): memory, and why an operator
  // that would take more than max_bytes must not be made; empty when it fits.
  static std::size_t estimated_bytes(std::size_t triangles, std::size_t vertices, std::size_t tested);
  static std::string too_large(const Boundary& boundary, const Testing& testing, std::size_t max_bytes);
  std::size_t bytes() const { return near_.bytes() + plan_->statistics().bytes; }
  const NearField& near_field() const { return near_; }
  const fmm::Plan& plan() const { return *plan_; }

 private:
  // Strengths f and w of the point sources, six columns, for values at the nodes.
  void strengths(const Vec3Column& nodes, std::span<double> out) const;
  Vec3Column without_own(const Vec3Column& u, const Vec3Column& nodes, std::span<const double> far) const;
  void apply_sets(std::span<const Real> x, std::size_t sets, std::span<Real> y) const;  // vector after vector

  const Boundary& boundary_;
  const Reconstruction& reconstruction_;
  const Testing& testing_;
  NearField near_;
  std::unique_ptr<fmm::Plan> plan_;
  std::vector<Real> total_;  // double layer of 1 at each point, as the two parts see it
};

}  // namespace sherd
