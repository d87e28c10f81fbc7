#include "engine/load/surface_load.h"

#include "engine/load/inertia_relief.h"
#include "engine/load/patch.h"

namespace sherd {

std::vector<ContactPatch> contact_patches(const SurfaceMesh& mesh, std::span<const BodyContact> contacts,
                                          const std::vector<std::uint32_t>& twins, const TriangleBvh& bvh) {
  std::vector<ContactPatch> patches;
  for (const BodyContact& c : contacts)
    patches.push_back(make_patch(mesh, twins, bvh, c.point, c.patch_radius, c.force));
  return patches;
}

SurfaceLoad owned_part(const SurfaceMesh& piece, const SurfaceLoad& whole) {
  constexpr Real kLeastShare = 1e-6;
  SurfaceLoad part{{}, whole.applied, whole.omega};
  for (const ContactPatch& p : whole.patches)
    if (ContactPatch own = patch_part(piece, p); own.normalisation > kLeastShare * p.normalisation)
      part.patches.push_back(std::move(own));
  return part;
}

Load make_load(const SurfaceMesh& mesh, const MassProperties& mass, const SurfaceLoad& pull) {
  Load load;
  load.patches = pull.patches;
  for (const ContactPatch& p : pull.patches) append_panels(mesh, p, load.panels);
  Real area = 0;
  for (const AppliedTraction& t : pull.applied) area += add_traction(mesh, t, load);
  if (area == 0) load.quadratic_traction.clear();
  relieve(mesh, mass, pull.omega, load);
  return load;
}

Load make_load(const SurfaceMesh& mesh, const MassProperties& mass, std::span<const BodyContact> contacts,
               const std::vector<std::uint32_t>& twins, const TriangleBvh& bvh, const Vec3& omega) {
  return make_load(mesh, mass, {contact_patches(mesh, contacts, twins, bvh), {}, omega});
}

Real total_force(const SurfaceMesh& mesh, const Load& load) {
  Real sum = 0;
  for (const ContactPatch& p : load.patches) sum += norm(p.force);
  if (load.quadratic_traction.empty()) return sum;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)  // midpoints: exact for linear tractions of one direction
    for (std::size_t k = 3; k < 6; ++k)
      sum += norm(load.quadratic_traction[6 * t + k]) * norm(mesh.area_normal2(t)) / 6;
  return sum;
}

}  // namespace sherd
