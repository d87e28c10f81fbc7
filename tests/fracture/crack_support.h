// Bodies for the crack tests, and the laws of grown sheets.
#pragma once
#include <cmath>
#include <string>

#include "engine/fracture/check_growth.h"
#include "engine/fracture/synthetic_fields.h"
#include "engine/fracture/thicken.h"
#include "engine/mesh/shapes.h"
#include "kernels/core/random.h"

namespace sherd {

struct Specimen {
  explicit Specimen(SurfaceMesh m) : mesh(std::move(m)), bvh(mesh), h(mean_edge_length(mesh)) {
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      const Vec3 n = mesh.area_normal2(t);
      if (normals.empty()) normals.resize(mesh.vertex_count());
      for (const std::uint32_t v : mesh.triangles[t]) normals.add(v, n);
    }
  }
  CrackSeed seed_at(std::uint32_t v, const CrackField& field) const {
    Vec3Column p;
    p.push_back(mesh.vertices[v]);
    std::vector<PrincipalStress> s;
    field.principal_stress(p, s);
    return {mesh.vertices[v], normalized(normals[v]), s[0], v};
  }
  std::uint32_t nearest_vertex(const Vec3& p) const {
    std::uint32_t best = 0;
    for (std::uint32_t v = 1; v < mesh.vertex_count(); ++v)
      if (distance2(mesh.vertices[v], p) < distance2(mesh.vertices[best], p)) best = v;
    return best;
  }
  GrowthOptions options() const {
    GrowthOptions o;
    o.edge_length = h;
    o.propagation_strength = 0.5;
    o.thickness = 1e-3 * bounding_box(mesh).diagonal();
    return o;
  }
  SurfaceMesh mesh;
  TriangleBvh bvh;
  Real h;
  Vec3Column normals;
};

// Area of the whole sheet, m^2.
inline Real sheet_area(const CrackSheet& s) {
  Real sum = 0;
  for (const Triangle& n : s.triangles)
    sum += 0.5 * norm(cross(s.position[n[1]] - s.position[n[0]], s.position[n[2]] - s.position[n[0]]));
  return sum;
}

// Every law a grown sheet and its slab obey.
inline std::string check_grown(const GrowthResult& r, const Specimen& body, Real thickness) {
  if (r.outcome != GrowthOutcome::kComplete && r.outcome != GrowthOutcome::kArrested)
    return r.reason.empty() ? "failed without a reason" : "";
  if (std::string bad = check_growth(r, body.bvh, body.options()); !bad.empty()) return bad;
  std::string reason;
  const auto slab = thicken(r.sheet, thickness, 7, reason);
  if (!slab) return reason;
  const Real volume = signed_volume(*slab), full = thickness * sheet_area(r.sheet);
  // A complete slab has full thickness everywhere: its volume is t x area but for the bends (order t x curvature).
  if (r.outcome == GrowthOutcome::kComplete && std::abs(volume - full) > 0.02 * full) return "slab volume is off";
  if (!(volume > 0 && volume < 1.02 * full)) return "slab volume is out of range";
  return {};
}

}  // namespace sherd
