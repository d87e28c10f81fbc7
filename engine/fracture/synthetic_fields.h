// Stress fields given by formulas: what tests, the crack campaign and demonstrations put in place of a solved load.
#pragma once
#include <atomic>
#include <functional>

#include "engine/fracture/crack_field.h"

namespace sherd {

// A field given by a function of position, whose direction need not be a unit vector. `sign` -1 flips every
// eigenvector, which no result may depend on.
class FunctionField : public CrackField {
 public:
  using Function = std::function<PrincipalStress(const Vec3&)>;
  explicit FunctionField(Function f, Real sign = 1) : f_(std::move(f)), sign_(sign) {}
  void principal_stress(const Vec3Column& points, std::vector<PrincipalStress>& out) const override;

  // What was asked so far: points, and calls.
  mutable std::atomic<std::size_t> evaluations = 0, batches = 0;

 private:
  Function f_;
  Real sign_;
};

// Directions for a FunctionField, each with the stress 1 Pa everywhere.
// The same everywhere: planes.
FunctionField::Function constant_direction(const Vec3& e);
// e turned about `axis` by `rate` radians per metre along `along`. Not the normals of any surface when `along` lies in
// the crack.
FunctionField::Function rotating_direction(const Vec3& e, const Vec3& axis, const Vec3& along, Real rate);
// e plus three fixed plane waves of the given amplitude (each component) and wavelength (m).
FunctionField::Function noisy_direction(const Vec3& e, Real amplitude, Real wavelength, std::uint64_t seed);

}  // namespace sherd
