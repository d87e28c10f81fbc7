#include "engine/material/scalar_field.h"

#include "engine/material/material.h"

namespace sherd {
namespace {

class ConstantField final : public ScalarField {
 public:
  explicit ConstantField(Real value) : value_(value) {}
  Real at(const Vec3&) const override { return value_; }
  Real lower() const override { return value_; }
  Real upper() const override { return value_; }

 private:
  Real value_;
};

}  // namespace

ScalarFieldPtr constant_field(Real value) {
  return std::make_shared<ConstantField>(value);
}

MaterialFields constant_fields(const Material& material, Real diagonal) {
  const Real thickness = material.crack_thickness > 0 ? material.crack_thickness : kDefaultThickness * diagonal;
  return {constant_field(material.strength), constant_field(material.propagation_strength), constant_field(thickness)};
}

}  // namespace sherd
