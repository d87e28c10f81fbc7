// What a solve found, as colours of a surface.
#pragma once
#include <memory>

#include "engine/frame/frame.h"
#include "engine/scene/scene.h"
#include "engine/step/solid.h"

namespace sherd {

// The field of `mesh`, which is the solid's own or any other part of its material: pieces, notched surfaces. On its own
// mesh values may jump at creases and the surface is displaced as the scene asks; elsewhere there is one value a vertex
// and no displacement, and crack faces, of which the surface's displacement says nothing, show that of stresses alone.
// Null when a value is not finite: a picture is no reason to end a run.
std::shared_ptr<const SurfaceField> shown_field(const SceneField& wanted, Solid& solid, const StressState& state,
                                                const Elastic& material, const SurfaceMesh& mesh);

// Energy of a linear elastic solid, (sigma : epsilon) / 2, J/m^3.
Real strain_energy_density(const Sym3& stress, const Elastic& material);

// Name, unit and a range: the scene's, or from 0 (stress: the smallest value) to what 98 % of the corners do not
// exceed, so that the points of contacts do not hide the rest. Takes in `field` if the range is not the scene's.
FieldScale field_scale(const SceneField& wanted);
void widen(FieldScale& scale, const SceneField& wanted, const SurfaceField& field);

}  // namespace sherd
