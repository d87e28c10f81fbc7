// What pulls at a body during a contact: surface tractions on panels, a body force, both in material space.
#pragma once
#include <array>
#include <vector>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

// A force spread over a disc of the surface: t(x) = force * weight(|x - centre|) / normalisation on the faces marked in
// `faces`, weight(r) = sqrt(1 - (r/radius)^2) (the Hertz pressure), 0 beyond the radius.
struct ContactPatch {
  Vec3 centre;                       // on the surface, m
  Real radius = 0;                   // m
  Vec3 axis;                         // outward unit normal there
  Vec3 force;                        // N
  Real normalisation = 0;            // integral of the weight over the marked faces, m^2
  std::vector<std::uint32_t> faces;  // ascending
};

// b(x) = constant + linear (x - origin), N/m^3, with div sigma + b = 0.
struct BodyForce {
  Vec3 constant;
  Mat3 linear;
  Vec3 origin;
};

// Flat sub-triangles with constant traction; together the patches, resolved independently of the mesh.
struct TractionPanels {
  std::vector<std::array<Vec3, 3>> corners;
  Vec3Column traction;              // Pa
  std::vector<std::uint32_t> face;  // the mesh triangle each lies in
  std::size_t size() const { return corners.size(); }
};

struct Load {
  TractionPanels panels;
  std::vector<ContactPatch> patches;
  Vec3Column face_traction;  // constant traction per triangle of the mesh, Pa; empty: none
  // Traction that varies over each triangle, in addition: six values a triangle, at its corners and at the midpoints of
  // its edges 0-1, 1-2, 2-0, quadratic between them, Pa; empty: none.
  Vec3Column quadratic_traction;
  BodyForce body_force;
  Vec3 net_force;   // of panels and body force together; zero to rounding after inertia relief, N
  Vec3 net_moment;  // about the centre of mass, N m
};

// The six quadratic shape functions at the barycentric coordinates (1 - s - t, s, t), in the order of
// Load::quadratic_traction.
std::array<Real, 6> quadratic_shape(Real s, Real t);
// Traction of the patches, the face and the quadratic tractions at the point x of face `face` of the mesh, Pa.
Vec3 traction_at(const Load& load, const SurfaceMesh& mesh, const Vec3& x, std::uint32_t face);

}  // namespace sherd
