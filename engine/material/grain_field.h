// Grains with strengths of their own and weaker (or stronger) boundaries.
#pragma once
#include "engine/material/field_spec.h"

namespace sherd {

class GrainField final : public ScalarField {
 public:
  explicit GrainField(const GrainSpec& spec) : spec_(spec), bounds_(bounds_of(spec, {})) {}
  Real at(const Vec3& x) const override;
  Real lower() const override { return bounds_.lower; }
  Real upper() const override { return bounds_.upper; }

  struct Place {
    std::array<std::int64_t, 3> grain;  // names the grain x lies in
    Real to_boundary = 0;               // distance from its boundary, m
  };
  Place place(const Vec3& x) const;

 private:
  GrainSpec spec_;
  FieldBounds bounds_;
};

}  // namespace sherd
