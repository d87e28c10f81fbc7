#include "engine/load/inertia_relief.h"

namespace sherd {
namespace {

Real area_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  return 0.5 * norm(cross(b - a, c - a));
}

// Degree 3 on a triangle, barycentric: quadratic traction times the lever is cubic.
struct RulePoint {
  Real s, t, weight;
};
constexpr RulePoint kCubicRule[] = {
    {1.0 / 3, 1.0 / 3, -27.0 / 48}, {0.2, 0.2, 25.0 / 48}, {0.6, 0.2, 25.0 / 48}, {0.2, 0.6, 25.0 / 48}};

}  // namespace

Resultant resultant(const SurfaceMesh& mesh, const Load& load, const Vec3& origin) {
  Resultant r;
  const auto add = [&](const Vec3& at, const Vec3& f) { r.force += f, r.moment += cross(at - origin, f); };
  for (std::size_t i = 0; i < load.panels.size(); ++i) {
    const auto& c = load.panels.corners[i];
    add((c[0] + c[1] + c[2]) / 3.0, load.panels.traction[i] * area_of(c[0], c[1], c[2]));
  }
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Vec3 a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
    const Real area = area_of(a, b, c);
    if (!load.face_traction.empty()) add((a + b + c) / 3.0, load.face_traction[t] * area);
    if (load.quadratic_traction.empty()) continue;
    for (const RulePoint& p : kCubicRule) {
      const std::array<Real, 6> shape = quadratic_shape(p.s, p.t);
      Vec3 traction;
      for (std::size_t k = 0; k < 6; ++k) traction += load.quadratic_traction[6 * t + k] * shape[k];
      add(a + (b - a) * p.s + (c - a) * p.t, traction * (area * p.weight));
    }
  }
  return r;
}

Resultant relieve(const SurfaceMesh& mesh, const MassProperties& mass, const Vec3& omega, Load& load) {
  const Resultant r = resultant(mesh, load, mass.centre);
  const Mat3& inertia = mass.inertia;
  const Vec3 alpha = inverse(inertia) * (r.moment - cross(omega, inertia * omega));
  const Mat3 spin = cross_matrix(omega);
  load.body_force.origin = mass.centre;
  load.body_force.constant = r.force * (-1 / mass.volume);
  load.body_force.linear = (cross_matrix(alpha) + spin * spin) * (-mass.mass / mass.volume);
  load.net_force = r.force + load.body_force.constant * mass.volume;
  load.net_moment = r.moment - inertia * alpha - cross(omega, inertia * omega);
  return r;
}

}  // namespace sherd
