#include "engine/fracture/net_section.h"

#include <algorithm>

namespace sherd {
namespace {

// The field where it pulls hard enough; elsewhere (compression has no crack direction of its own) the crack goes
// straight on: the normal of the nearest node of the stopped sheet. Never arrests.
class ContinuedField final : public CrackField {
 public:
  ContinuedField(const CrackField& field, const CrackSheet& sheet, Real strength)
      : field_(field), sheet_(sheet), strength_(strength) {}

  void principal_stress(const Vec3Column& points, std::vector<PrincipalStress>& out) const override {
    field_.principal_stress(points, out);
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (out[i].value >= strength_) continue;
      out[i] = {strength_, sheet_.normal[nearest(points[i])]};
    }
  }

 private:
  std::size_t nearest(const Vec3& x) const {
    std::size_t best = 0;
    for (std::size_t k = 1; k < sheet_.position.size(); ++k)
      if (distance2(sheet_.position[k], x) < distance2(sheet_.position[best], x)) best = k;
    return best;
  }

  const CrackField& field_;
  const CrackSheet& sheet_;
  Real strength_;
};

}  // namespace

NetSection net_section(const TriangleBvh& body, const CrackField& field, const CrackSheet& arrested,
                       const GrowthOptions& options) {
  NetSection result;
  result.through = resume_crack(body, ContinuedField(field, arrested, options.propagation_strength), arrested, options);
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
