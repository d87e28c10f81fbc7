#include "engine/elastostatic/particular.h"

#include "kernels/fundamental/kelvin.h"

namespace sherd {

ParticularSolution::ParticularSolution(const BodyForce& force, const Elastic& material, const Sym3& uniform)
    : force_(force),
      material_(material),
      symmetric_(to_matrix(symmetric_part(force.linear))),
      antisymmetric_(force.linear - symmetric_),
      strain_(to_matrix(uniform) * (0.5 / material.mu) -
              Mat3::identity() * (trace(to_matrix(uniform)) * material.lambda() /
                                  (2 * material.mu * (3 * material.lambda() + 2 * material.mu)))),
      uniform_(uniform),
      zero_(trace(strain_ * strain_) == 0 && norm2(force.constant) == 0 &&
            trace(transpose(force.linear) * force.linear) == 0) {}

Vec3 ParticularSolution::displacement(const Vec3& at) const {
  if (zero_) return {};
  const Real mu = material_.mu, lambda = material_.lambda(), k = -1 / (28 * (lambda + 2 * mu));
  const Vec3 x = at - force_.origin, b0 = force_.constant, sx = symmetric_ * x;
  const Real x2 = norm2(x);
  Vec3 u = strain_ * x + (x * dot(b0, x) - b0 * (0.5 * x2)) * (-1 / (3 * lambda + 2 * mu));
  u += antisymmetric_ * x * (-x2 / (10 * mu));
  u += (sx * x2 + x * dot(x, sx)) * (2 * k) - x * (0.4 * k * trace(symmetric_) * x2);
  return u;
}

Sym3 ParticularSolution::stress(const Vec3& at) const {
  if (zero_) return {};
  const Real k = -1 / (28 * (material_.lambda() + 2 * material_.mu));
  const Vec3 x = at - force_.origin, v = antisymmetric_ * x, sx = symmetric_ * x;
  const Real x2 = norm2(x);
  Sym3 s = uniform_;
  const Real pressure = dot(force_.constant, x);
  s.xx -= pressure, s.yy -= pressure, s.zz -= pressure;
  s += symmetric_part(outer(x, v)) * -0.4;
  const Mat3 h = (symmetric_ * x2 + outer(sx, x) * 2.0 + outer(x, sx) * 2.0 + Mat3::identity() * dot(x, sx)) * (2 * k) -
                 (Mat3::identity() * x2 + outer(x, x) * 2.0) * (0.4 * k * trace(symmetric_));
  return s + kelvin::hooke(h, material_);
}

}  // namespace sherd
