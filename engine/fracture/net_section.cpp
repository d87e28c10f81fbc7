#include "engine/fracture/net_section.h"

#include <limits>

namespace sherd {

NetSection net_section(const TriangleBvh& body, const CrackField& field, const CrackSheet& arrested,
                       const GrowthOptions& options) {
  NetSection result;
  GrowthOptions forced = options;
  forced.propagation_strength = std::numeric_limits<Real>::lowest();
  result.through = resume_crack(body, field, arrested, forced);
  if (result.through.outcome != GrowthOutcome::kComplete) return result;
  const CrackSheet& sheet = result.through.sheet;
  Vec3Column centres;
  std::vector<Real> areas;
  for (const Triangle& t : sheet.triangles) {
    const Vec3 a = sheet.position[t[0]], b = sheet.position[t[1]], c = sheet.position[t[2]], centre = (a + b + c) / 3.0;
    if (!body.inside(centre)) continue;
    centres.push_back(centre);
    areas.push_back(0.5 * norm(cross(b - a, c - a)));
  }
  std::vector<PrincipalStress> stress;
  field.principal_stress(centres, stress);
  Real tension = 0;  // the sheet follows the eigenvector: its normal stress is the principal stress
  for (std::size_t i = 0; i < stress.size(); ++i) tension += stress[i].value * areas[i];
  const Real ligament = area_inside(sheet, body) - area_inside(arrested, body);
  const Real least = 1e-6 * options.edge_length * options.edge_length;  // a crack that had only its border to close
  result.stress = tension / std::max(ligament, least);
  result.complete = std::isfinite(result.stress);
  return result;
}

}  // namespace sherd
