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
  constexpr Real kMargin = 1.5, kContact = 0.8, kSlender = 0.16;
  constexpr Real kRotation = 0.25;  // of density (spin diagonal)^2; a disc has 0.1
  const Real t = body.thickness, d = body.diagonal;
  const Real bending = load.force / (t * t) * (1 + kSlender * d / t), contact = kContact * load.pressure;
  return kMargin * std::max(bending, contact) + kRotation * load.density * load.spin * load.spin * d * d;
}

Real solidity(const TriangleBvh& body, const Vec3& point, Real radius) {
  static const std::array<Vec3, 64> samples = make_samples();
  const auto solid =
      std::count_if(samples.begin(), samples.end(), [&](const Vec3& x) { return body.inside(point + radius * x); });
  return std::clamp(2 * static_cast<Real>(solid) / static_cast<Real>(samples.size()), kLeastSolidity, Real{1});
}

}  // namespace sherd
