// All that pulls at one body in one event: contact patches, applied tractions, its spin. Pieces of the body take their
// parts of it.
#pragma once
#include <span>

#include "engine/load/applied_load.h"
#include "engine/load/contact_load.h"

namespace sherd {

struct SurfaceLoad {
  std::vector<ContactPatch> patches;     // on the mesh it belongs to
  std::vector<AppliedTraction> applied;  // not tied to a mesh
  Vec3 omega;                            // angular velocity in material axes, rad/s
};

std::vector<ContactPatch> contact_patches(const SurfaceMesh& mesh, std::span<const BodyContact> contacts,
                                          const std::vector<std::uint32_t>& twins, const TriangleBvh& bvh);

// The part of `whole` that acts on a piece of the body: of each contact the share of its pressure that the piece's
// original faces carry, and every applied traction. Shares of all pieces add up to the whole but for what the cracks
// removed under the patches.
SurfaceLoad owned_part(const SurfaceMesh& piece, const SurfaceLoad& whole);

// Tractions with the body force that balances them (inertia_relief.h). `mass` exactly of `mesh`. An applied traction
// whose region the mesh does not own adds nothing.
Load make_load(const SurfaceMesh& mesh, const MassProperties& mass, const SurfaceLoad& pull);
// The same of contacts alone. Weight and its reaction enter through the contact forces; free fall is stress free.
Load make_load(const SurfaceMesh& mesh, const MassProperties& mass, std::span<const BodyContact> contacts,
               const std::vector<std::uint32_t>& twins, const TriangleBvh& bvh, const Vec3& omega);

// Sum of the sizes of all forces: of the patches and of the applied tractions (twists included), N.
Real total_force(const SurfaceMesh& mesh, const Load& load);

}  // namespace sherd
