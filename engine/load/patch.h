// Spreading a contact force over the surface around the contact.
#pragma once
#include "engine/load/load.h"
#include "engine/mesh/bvh.h"

namespace sherd {

// Marks the faces reached from the face closest to `centre` over the surface without leaving the ball of the given
// radius and without turning more than 90 degrees away from it (so the far side of a thin wall stays free), and
// computes the normalisation. A radius too small to enclose any quadrature point still loads the closest face: the
// force is never lost.
ContactPatch make_patch(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& twins, const TriangleBvh& bvh,
                        const Vec3& centre, Real radius, const Vec3& force);
// The part of a patch that a piece of its body owns: the same disc on the piece's original faces, with the share of the
// force that their share of the pressure is; no faces and no force when it owns none.
ContactPatch patch_part(const SurfaceMesh& piece, const ContactPatch& whole);
// Appends the patch's panels: each marked face split until a panel is smaller than a third of the radius. The panel
// forces add up to patch.force exactly (to rounding).
void append_panels(const SurfaceMesh& mesh, const ContactPatch& patch, TractionPanels& panels);

}  // namespace sherd
