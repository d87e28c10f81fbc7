// Closed-form integrals of 1/l, e e/l and the solid angle over a flat triangle with constant density, and their
// gradients. Conventions: triangle v0 v1 v2 counter-clockwise about the unit normal n, target x, l = |x - y|, e = (x -
// y)/l. Exact to rounding at every distance below some thirty edge lengths, on the plane, on edge extensions and
// (values) on edges and vertices; beyond, cancellation costs about one digit per factor three in distance: use a Gauss
// rule there. Gradients are logarithmically singular on the triangle's edges; clamps keep them finite.
#pragma once
#include "kernels/core/vec3.h"

namespace sherd {

// Geometry of a triangle that the integrals share. A zero-area triangle has normal 0 and must not be integrated.
struct PanelFrame {
  Vec3 vertex[3];
  Vec3 tangent[3];  // of edge e: vertex[e] -> vertex[e+1], unit
  Vec3 outward[3];  // in the plane, unit, pointing out of the triangle across edge e
  Vec3 normal;
  Real length[3];
  Real area = 0;
  Real longest2 = 0;  // longest edge squared
  Vec3 centroid() const { return (vertex[0] + vertex[1] + vertex[2]) / 3.0; }
  // Gradient of the linear shape function that is 1 at corner a.
  Vec3 shape_gradient(int a) const { return outward[(a + 1) % 3] * (-length[(a + 1) % 3] / (2 * area)); }
};
PanelFrame make_panel(const Vec3& v0, const Vec3& v1, const Vec3& v2);

// Which limit to take when the target lies on the triangle itself.
enum class Side { kAway, kOnSurface, kInterior };  // kInterior: limit from inside the body (against the normal)

// Lengths in metres: A and M in m, Omega without unit, gradients one power of a metre less.
struct PanelValues {
  Real inverse = 0;      // A = integral of 1/l
  Mat3 dyad;             // M_ij = integral of e_i e_j / l
  Real solid_angle = 0;  // Omega = integral of (x-y).n / l^3, positive on the side of n
  Vec3 shape_angle;      // component a: integral of N_a (x-y).n / l^3, N_a the linear shape function of corner a
};
// side kOnSurface sets the normal distance and the solid angle to zero (principal value).
void integrate_panel(const PanelFrame& panel, const Vec3& x, Side side, PanelValues& out);

struct PanelGradients {
  Vec3 inverse;  // A,k
  Mat3 dyad[3];  // dyad[k][i][j] = M_ij,k
};
void integrate_panel_gradient(const PanelFrame& panel, const Vec3& x, Side side, PanelGradients& out);

}  // namespace sherd
