// A crack in a torus that came round the hole and on over its own beginning, which it never meets.
#pragma once
#include <numbers>

#include "tests/fracture/crack_support.h"

namespace sherd::helicoid {

constexpr Real kTurn = 2 * std::numbers::pi;
constexpr Real kPast = 0.8;                   // rad: how far the front has come beyond a whole turn
constexpr Real kStep = 0.1;                   // of the strip's nodes, rad and m
constexpr Real kInner = 0.55, kOuter = 1.45;  // m: the strip's borders, outside of the torus

inline const Specimen& torus() {
  static const Specimen s(make_torus(1, 0.4, 0.12));
  return s;
}

// Its layers lie closer than what counts as running along, and farther apart than they must.
inline Real pitch() {
  return 1.2 * torus().h;
}

// The normals of all helicoids of this pitch around y: no two turns of one ever meet. The strip's start has no stress.
inline FunctionField::Function helicoids() {
  return [c = pitch() / kTurn](const Vec3& p) {
    const Real r = std::hypot(p.x, p.z);
    return PrincipalStress{p.y < -0.45 * pitch() ? 0.0 : 1.0, Vec3{-c * p.z / r, r, c * p.x / r}};
  };
}

// A strip of a helicoid, from a start inside of the torus round its hole and on over its own beginning.
inline CrackSheet strip() {
  CrackSheet s;
  const auto columns = static_cast<std::uint32_t>(std::lround((kTurn + kPast) / kStep));
  const auto rows = static_cast<std::uint32_t>(std::lround((kOuter - kInner) / kStep));
  const FunctionField field(helicoids());
  for (std::uint32_t i = 0; i <= columns; ++i)
    for (std::uint32_t j = 0; j <= rows; ++j) {
      const Real angle = i * kStep, r = kInner + j * kStep;
      s.position.push_back({r * std::sin(angle), pitch() * (angle - 0.5 * kTurn) / kTurn, r * std::cos(angle)});
      s.state.push_back(j == 0 || j == rows ? NodeState::kExited
                        : i == columns      ? NodeState::kActive
                        : i == 0            ? NodeState::kArrested
                                            : NodeState::kInterior);
      if (i == columns || j == rows) continue;
      const std::uint32_t a = i * (rows + 1) + j, b = a + rows + 1;
      s.triangles.push_back({a, a + 1, b + 1}), s.triangles.push_back({a, b + 1, b});
    }
  std::vector<PrincipalStress> stress;
  field.principal_stress(s.position, stress);
  for (const PrincipalStress& e : stress) s.normal.push_back(e.direction);
  s.reference_stress = 1, s.seed_normal = s.normal[0];
  return s;
}

}  // namespace sherd::helicoid
