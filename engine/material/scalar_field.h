// A quantity of the material that may vary from place to place: strength, crack thickness.
#pragma once
#include <memory>

#include "kernels/core/vec3.h"

namespace sherd {

struct Material;

// Of material space (the mesh's own coordinates, m). Immutable, thread-safe, deterministic; finite for finite x.
class ScalarField {
 public:
  virtual ~ScalarField() = default;
  virtual Real at(const Vec3& x) const = 0;
  // Bounds over all x: lower() <= at(x) <= upper().
  virtual Real lower() const = 0;
  virtual Real upper() const = 0;
};
using ScalarFieldPtr = std::shared_ptr<const ScalarField>;

ScalarFieldPtr constant_field(Real value);

// What cracks ask of a body's material. Never null; propagation_strength <= strength at every point.
struct MaterialFields {
  ScalarFieldPtr strength;              // tensile stress that starts a crack, Pa
  ScalarFieldPtr propagation_strength;  // tensile stress that keeps it growing, Pa
  ScalarFieldPtr crack_thickness;       // m, > 0
};

// The material's numbers everywhere. `diagonal`: of the body's bounding box, m (Material::crack_thickness 0 means
// kDefaultThickness of it).
MaterialFields constant_fields(const Material& material, Real diagonal);
inline constexpr Real kDefaultThickness = 1e-3;

}  // namespace sherd
