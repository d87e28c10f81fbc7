#include "engine/fracture/synthetic_fields.h"

#include <cmath>
#include <numbers>

#include "kernels/core/random.h"

namespace sherd {

void FunctionField::principal_stress(const Vec3Column& points, std::vector<PrincipalStress>& out) const {
  out.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    out[i] = f_(points[i]);
    out[i].direction = sign_ * normalized(out[i].direction);
  }
  evaluations += points.size();
  ++batches;
}

FunctionField::Function constant_direction(const Vec3& e) {
  return [e](const Vec3&) { return PrincipalStress{1, e}; };
}

FunctionField::Function rotating_direction(const Vec3& e, const Vec3& axis, const Vec3& along, Real rate) {
  return [=, k = normalized(axis)](const Vec3& p) {
    const Real a = rate * dot(p, along);
    return PrincipalStress{1, std::cos(a) * e + std::sin(a) * cross(k, e) + (1 - std::cos(a)) * dot(k, e) * k};
  };
}

FunctionField::Function noisy_direction(const Vec3& e, Real amplitude, Real wavelength, std::uint64_t seed) {
  constexpr Real kTurn = 2 * std::numbers::pi;
  constexpr int kWaves = 3;
  struct Wave {
    Vec3 k, a;
    Real phase;
  };
  Random random(seed);
  const auto unit = [&] {
    Vec3 v;
    for (int i = 0; i < 3; ++i) v[i] = random.uniform(-1, 1);
    return normalized(v);
  };
  std::vector<Wave> waves;
  for (int i = 0; i < kWaves; ++i) {
    const Vec3 k = kTurn / wavelength * unit(), a = amplitude * unit();
    waves.push_back({k, a, random.uniform(0, kTurn)});
  }
  return [e, waves](const Vec3& p) {
    Vec3 sum = e;
    for (const Wave& w : waves) sum += std::sin(dot(w.k, p) + w.phase) * w.a;
    return PrincipalStress{1, sum};
  };
}

}  // namespace sherd
