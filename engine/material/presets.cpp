#include <array>

#include "engine/material/material.h"

namespace sherd {
namespace {

// Strength of a brittle solid depends on its flaws, size and surface: each `source` gives the usual range and what was
// chosen. The stress is that of the body without the crack, so the propagation strength stands for what a running crack
// needs far from its tip: Griffith's K_Ic / sqrt(pi a) for a crack of a = 0.1 m, rounded. That length is a modelling
// choice; lower values let cracks run farther. Restitution and friction are for pieces knocking on stone or like
// materials, rounded.
const std::array<MaterialPreset, 6> kPresets{{
    {{.name = "glass",
      .density = 2500,
      .young = 70e9,
      .poisson = 0.22,
      .strength = 45e6,
      .propagation_strength = 1.3e6,
      .restitution = 0.3,
      .friction = 0.4},
     "annealed soda-lime float glass; density, modulus and characteristic bending strength 45 MPa as in EN 572-1; "
     "Poisson's ratio 0.20-0.24 in handbooks; toughness 0.75 MPa m^1/2"},
    {{.name = "ceramic",
      .density = 2400,
      .young = 70e9,
      .poisson = 0.22,
      .strength = 40e6,
      .propagation_strength = 1.8e6,
      .restitution = 0.2,
      .friction = 0.5},
     "vitrified stoneware; handbook ranges 2200-2500 kg/m^3, 40-75 GPa, 0.20-0.25, bending strength 30-60 MPa; "
     "the dense, stiff end chosen, strength in the middle; toughness about 1 MPa m^1/2"},
    {{.name = "porcelain",
      .density = 2400,
      .young = 65e9,
      .poisson = 0.23,
      .strength = 55e6,
      .propagation_strength = 2.1e6,
      .restitution = 0.25,
      .friction = 0.45},
     "siliceous (table and electrical) porcelain; IEC 60672-3 group C 110 asks for at least 2200 kg/m^3, 60 GPa and "
     "50 MPa bending strength unglazed, 60 MPa glazed; usual values slightly above the limits chosen; toughness about "
     "1.2 MPa m^1/2"},
    {{.name = "plaster",
      .density = 1150,
      .young = 4e9,
      .poisson = 0.2,
      .strength = 2.5e6,
      .propagation_strength = 0.25e6,
      .restitution = 0.1,
      .friction = 0.6},
     "dry cast gypsum plaster; handbook ranges 1000-1300 kg/m^3, 2-8 GPa, 0.15-0.25, tensile strength 1.5-4 MPa, by "
     "water-plaster ratio; middle values chosen; toughness 0.1-0.2 MPa m^1/2"},
    {{.name = "concrete",
      .density = 2400,
      .young = 31e9,
      .poisson = 0.2,
      .strength = 2.6e6,
      .propagation_strength = 0.9e6,
      .restitution = 0.1,
      .friction = 0.6},
     "plain concrete C25/30; Eurocode 2 (EN 1992-1-1, table 3.1) gives mean tensile strength 2.6 MPa and modulus 31 "
     "GPa, "
     "Poisson's ratio 0.2 uncracked; density 2300-2400 kg/m^3; toughness 0.2-1.4 MPa m^1/2, 0.5 chosen"},
    {{.name = "brick",
      .density = 1800,
      .young = 12e9,
      .poisson = 0.18,
      .strength = 3e6,
      .propagation_strength = 0.5e6,
      .restitution = 0.15,
      .friction = 0.6},
     "fired clay brick; handbook ranges 1600-2100 kg/m^3, 5-20 GPa, 0.1-0.25, tensile strength about a tenth of the "
     "20-50 MPa compressive strength; middle values chosen; toughness about 0.3 MPa m^1/2"},
}};

}  // namespace

std::span<const MaterialPreset> material_presets() {
  return kPresets;
}

std::optional<Material> find_material(std::string_view name) {
  for (const MaterialPreset& preset : kPresets)
    if (preset.material.name == name) return preset.material;
  return std::nullopt;
}

}  // namespace sherd
