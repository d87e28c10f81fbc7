#include "engine/fracture/net_section.h"

#include <algorithm>
#include <numeric>

namespace sherd {
namespace {

Real strength_at(const GrowthOptions& o, const Vec3& x) {
  return o.propagation_field ? o.propagation_field->at(x) : o.propagation_strength;
}

// The field where it pulls hard enough; elsewhere (compression has no crack direction of its own) the crack goes
// straight on: the normal of the nearest node of the stopped sheet. Never arrests.
class ContinuedField final : public CrackField {
 public:
  ContinuedField(const CrackField& field, const CrackSheet& sheet, const GrowthOptions& options)
      : field_(field), sheet_(sheet), options_(options) {}

  void principal_stress(const Vec3Column& points, std::vector<PrincipalStress>& out) const override {
    field_.principal_stress(points, out);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const Real strength = strength_at(options_, points[i]);
      if (!(out[i].value >= strength)) out[i] = {strength, sheet_.normal[nearest(points[i])]};
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
  const GrowthOptions& options_;
};

// The triangles of a sheet whose centres lie inside the body.
struct Patches {
  Vec3Column centres;
  std::vector<Real> areas;

  Patches(const CrackSheet& sheet, const TriangleBvh& body) {
    for (const Triangle& t : sheet.triangles) {
      const Vec3 a = sheet.position[t[0]], b = sheet.position[t[1]], c = sheet.position[t[2]];
      if (!body.inside((a + b + c) / 3.0)) continue;
      centres.push_back((a + b + c) / 3.0);
      areas.push_back(0.5 * norm(cross(b - a, c - a)));
    }
  }
  Real strength(const GrowthOptions& o) const {
    Real sum = 0;
    for (std::size_t i = 0; i < areas.size(); ++i) sum += areas[i] * strength_at(o, centres[i]);
    return sum;
  }
  Real area() const { return std::accumulate(areas.begin(), areas.end(), Real{0}); }
};

// Mean over what `through` adds to `arrested`, weighted by area.
Real ligament_strength(const Patches& through, const Patches& arrested, const GrowthOptions& o, Real least_area) {
  if (!o.propagation_field) return o.propagation_strength;
  const Real area = through.area() - arrested.area();
  const Real mean = area > least_area ? (through.strength(o) - arrested.strength(o)) / area
                                      : through.strength(o) / std::max(through.area(), least_area);
  return std::clamp(mean, o.propagation_field->lower(), o.propagation_field->upper());
}

}  // namespace

NetSection net_section(const TriangleBvh& body, const CrackField& field, const CrackSheet& arrested,
                       const GrowthOptions& options) {
  NetSection result;
  result.through = resume_crack(body, ContinuedField(field, arrested, options), arrested, options);
  if (result.through.outcome != GrowthOutcome::kComplete) return result;
  const CrackSheet& sheet = result.through.sheet;
  const Patches through(sheet, body);
  std::vector<PrincipalStress> stress;
  field.principal_stress(through.centres, stress);
  Real tension = 0;  // the sheet follows the eigenvector: its normal stress is the principal stress
  for (std::size_t i = 0; i < stress.size(); ++i) tension += stress[i].value * through.areas[i];
  const Real ligament = area_inside(sheet, body) - area_inside(arrested, body);
  const Real least = 1e-6 * options.edge_length * options.edge_length;  // a crack that had only its border to close
  result.stress = tension / std::max(ligament, least);
  result.strength = ligament_strength(through, Patches(arrested, body), options, least);
  result.complete = std::isfinite(result.stress);
  return result;
}

}  // namespace sherd
