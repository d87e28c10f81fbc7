#include "engine/load/tension_bound.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sherd {
namespace {

// In the unit ball, evenly: the additive recurrence of the plastic number's cousin in three dimensions (Roberts 2018),
// those of the cube that lie in the ball.
std::array<Vec3, 64> make_samples() {
  constexpr Real kStep[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
  std::array<Vec3, 64> out;
  std::size_t count = 0;
  for (int i = 1; count < out.size(); ++i) {
    Vec3 x;
    for (int k = 0; k < 3; ++k) {
      const Real t = 0.5 + i * kStep[k];
      x[k] = 2 * (t - std::floor(t)) - 1;
    }
    if (norm2(x) <= 1) out[count++] = x;
  }
  return out;
}

}  // namespace

Real tension_bound(const BoundedBody& body, const BoundedLoad& load) {
  constexpr Real kMargin = 4, kSlender = 0.16, kNotch = 4;
  // Of density (spin diagonal)^2; a disc has 0.1, a ring of section A spun about its diameter bends
  // with a moment of density A spin^2 R^3 / 4.
  constexpr Real kRotation = 0.25, kHoop = 0.5;
  const Real t = body.thickness, d = body.diagonal, notch = body.notched ? kNotch : 1;
  const Real bending = notch * load.force / (t * t) * (1 + kSlender * d / t), contact = load.pressure;
  return kMargin * std::max(bending, contact) +
         kRotation * (1 + kHoop * d / t) * load.density * load.spin * load.spin * d * d;
}

Real solidity(const TriangleBvh& body, const Vec3& point, Real radius) {
  static const std::array<Vec3, 64> samples = make_samples();
  const auto solid =
      std::count_if(samples.begin(), samples.end(), [&](const Vec3& x) { return body.inside(point + radius * x); });
  const Real share = std::min(Real{1}, 2 * static_cast<Real>(solid) / static_cast<Real>(samples.size()));
  return std::max(kLeastSolidity, share * std::sqrt(share));
}

bool has_reentrant_creases(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& twins) {
  constexpr Real kCosine = 0.766;  // of 40 degrees
  for (std::uint32_t e = 0; e < twins.size(); ++e) {
    const std::uint32_t other = twins[e];
    if (other == kNone || other < e) continue;
    const Vec3 n = normalized(mesh.area_normal2(e / 3)), m = normalized(mesh.area_normal2(other / 3));
    if (dot(n, m) > kCosine) continue;
    const Vec3 opposite = mesh.corner(other / 3, static_cast<int>((other % 3 + 2) % 3)),
               on_edge = mesh.corner(e / 3, static_cast<int>(e % 3));
    if (dot(n, opposite - on_edge) > 0) return true;
  }
  return false;
}

}  // namespace sherd
