// Contact impulses to forces on patches of the surface (paper 6.2: f = impulse / contact duration).
#pragma once
#include "engine/contact/contact.h"
#include "engine/load/load.h"
#include "engine/mesh/bvh.h"

namespace sherd {

struct ContactLoadOptions {
  Real time_step = 1e-3;  // s
  Real duration = 0;      // s; 0: Hertz
  Real min_duration =
      1e-3;  // s; lower bound of the Hertz time. The default is the time step: what the simulation resolves
  Real patch_radius = 0;      // m; 0: Hertz
  Real min_patch_radius = 0;  // m; 0: 2 % of the bounding-box diagonal
};

// A contact seen from one body, material space.
struct BodyContact {
  Vec3 point;             // m
  Vec3 force;             // N, on this body
  Real duration = 0;      // s
  Real patch_radius = 0;  // m
};

// Duration and patch of a contact from the point of view of `body`; `other` is null for the ground (rigid, flat).
// Slow contacts (the Hertz time grows like v^-1/5) never last longer than the step that carries their impulse needs: an
// impulse of a resting contact is weight * time_step, so its duration is the time step.
// `radius`: effective radius of curvature of the two surfaces, 1/R = 1/R1 + 1/R2 (the ground is flat), m.
// `diagonal`: of the body's bounding box, m.
BodyContact body_contact(const Body& body, const Body* other, const Contact& contact, Real radius, Real diagonal,
                         const ContactLoadOptions& options);
// The shortest duration and the smallest patch radius body_contact() can give: they bound forces from above.
Real shortest_duration(const ContactLoadOptions& options);
Real smallest_patch(Real diagonal, const ContactLoadOptions& options);
// Radius of curvature of the surface around a point, m: from the spread of the normals of the faces near it; never
// below half the local edge length nor above the bounding-box diagonal (a flat face).
Real curvature_radius(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& twins, const TriangleBvh& bvh,
                      const Vec3& point);

}  // namespace sherd
