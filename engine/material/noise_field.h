// Procedural gradient noise.
#pragma once
#include "engine/material/field_spec.h"

namespace sherd {

// Gradient noise (Perlin, Improving Noise, 2002) with random unit gradients at the points of a cubic lattice of half a
// wavelength, scaled so that its bound is 1.
class NoiseField final : public ScalarField {
 public:
  explicit NoiseField(const NoiseSpec& spec) : spec_(spec), bounds_(bounds_of(spec, {})) {}
  Real at(const Vec3& x) const override;
  Real lower() const override { return bounds_.lower; }
  Real upper() const override { return bounds_.upper; }

 private:
  NoiseSpec spec_;
  FieldBounds bounds_;
};

}  // namespace sherd
