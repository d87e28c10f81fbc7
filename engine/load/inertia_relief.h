// Makes any load on a free body self-equilibrated: what its tractions leave over accelerates the body rigidly.
#pragma once
#include "engine/body/mass.h"
#include "engine/load/load.h"

namespace sherd {

struct Resultant {
  Vec3 force;   // N
  Vec3 moment;  // about the origin asked for, N m
};

// Of panels, face tractions and quadratic tractions together, exact to rounding; body forces are not counted.
Resultant resultant(const SurfaceMesh& mesh, const Load& load, const Vec3& origin);

// Sets the body force b(x) = -rho [F/m + alpha x d + omega x (omega x d)], d = x - centre, I alpha = M - omega x (I
// omega), rho = mass/volume, which balances the tractions' F and M. `mass` exactly of `mesh`, so that the load balances
// to rounding; `omega`: angular velocity in material axes, rad/s. Returns F and M (about the centre of mass).
Resultant relieve(const SurfaceMesh& mesh, const MassProperties& mass, const Vec3& omega, Load& load);

}  // namespace sherd
