// Isotropic brittle materials.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "kernels/core/vec3.h"

namespace sherd {

// SI units. Valid ranges: density > 0, young > 0, -1 < poisson < 0.5, strengths > 0 with propagation <= initiation,
// thickness >= 0, 0 <= restitution <= 1, friction >= 0.
struct Material {
  std::string name = "ceramic";
  Real density = 2400;  // kg/m^3
  Real young = 70e9;    // Pa
  Real poisson = 0.22;
  Real strength = 40e6;              // tensile stress that starts a crack (Rankine), Pa
  Real propagation_strength = 10e6;  // tensile stress that keeps it growing, Pa
  Real crack_thickness = 0;          // m; 0 asks for 1e-3 of the body's bounding-box diagonal
  Real restitution = 0.2;
  Real friction = 0.5;
};

struct MaterialPreset {
  Material material;
  std::string_view source;  // where the numbers come from
};
std::span<const MaterialPreset> material_presets();
std::optional<Material> find_material(std::string_view name);

inline Real shear_modulus(const Material& m) {
  return m.young / (2 * (1 + m.poisson));
}
inline Real lame_lambda(const Material& m) {
  return m.young * m.poisson / ((1 + m.poisson) * (1 - 2 * m.poisson));
}

}  // namespace sherd
