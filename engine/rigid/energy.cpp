#include "engine/rigid/energy.h"

#include <algorithm>

#include "engine/rigid/free_motion.h"
#include "kernels/core/error.h"

namespace sherd {

Energy energy(const Body& b, const Vec3& gravity) {
  return {0.5 * (b.mass.mass * norm2(b.velocity) + dot(b.angular_velocity, spin_momentum(b))),
          -b.mass.mass * dot(gravity, b.pose.position)};
}

Energy energy(std::span<const Body> bodies, const Vec3& gravity) {
  Energy sum;
  for (const Body& b : bodies) {
    if (b.fixed) continue;
    const Energy e = energy(b, gravity);
    sum.kinetic += e.kinetic, sum.potential += e.potential;
  }
  return sum;
}

EnergyBalance energy_balance(std::span<const Body> before, std::span<const Body> after, const RigidOptions& options,
                             const RigidStats& stats) {
  SHERD_CHECK(before.size() == after.size(), "{} bodies became {}", before.size(), after.size());
  EnergyBalance balance;
  balance.before = energy(before, options.gravity), balance.after = energy(after, options.gravity);
  balance.recovered = stats.recovery_work;
  constexpr Real kMoving = 1e-9, kHeight = 1e-11;
  const Real fall = norm(options.gravity) * options.dt;
  Real moving = 0, height = 0;
  for (const Body& b : before) {
    if (b.fixed) continue;
    const Real speed = std::sqrt(2 * energy(b, {}).kinetic / b.mass.mass) + fall;
    moving += b.mass.mass * speed * speed;
    height += b.mass.mass * norm(options.gravity) * norm(b.pose.position);
  }
  balance.tolerance = kMoving * moving + kHeight * height;
  return balance;
}

}  // namespace sherd
