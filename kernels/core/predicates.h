// Exact signs of orientation determinants: floating-point filter first, then exact expansion arithmetic (Shewchuk
// 1997). Inputs are finite doubles without overflow or underflow in the products (coordinates between 1e-60 and 1e60 in
// size, or 0).
#pragma once
#include "kernels/core/expansion.h"
#include "kernels/core/vec3.h"

namespace sherd {

// Sign of ((b-a) x (c-a)) . (d-a): +1 when d lies on the side the normal of the counter-clockwise triangle abc points
// to.
int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
// Sign of (b-a) x (c-a) in the plane: +1 when abc turns counter-clockwise.
int orient2d(Real ax, Real ay, Real bx, Real by, Real cx, Real cy);

// A value known up to an absolute error.
struct FilteredValue {
  Real value, error;
};
// The determinant of orient3d (six times the volume of the tetrahedron abcd): in doubles with its rounding error, and
// exactly.
FilteredValue orient3d_value(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
Expansion orient3d_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace sherd
