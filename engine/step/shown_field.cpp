#include "engine/step/shown_field.h"

#include <algorithm>
#include <cmath>

#include "engine/mesh/attributes.h"

namespace sherd {
namespace {

Real stress_value(FieldKind kind, const Sym3& stress, const Elastic& material) {
  return kind == FieldKind::kStrainEnergy ? strain_energy_density(stress, material) : eigen_symmetric(stress).value[0];
}

void own_values(FieldKind kind, Solid& solid, const StressState& state, const Elastic& material, SurfaceField& field) {
  const SurfaceMesh& mesh = solid.mesh();
  std::vector<Real> of_corner;  // of SurfaceRecovery::corners()
  if (kind != FieldKind::kDisplacement)
    for (const Sym3& stress : state.corner_stress()) of_corner.push_back(stress_value(kind, stress, material));
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh.triangles[t][static_cast<std::size_t>(k)];
      const Real v = kind == FieldKind::kDisplacement ? norm(state.displacement()[vertex])
                                                      : of_corner[solid.recovery().corner_of(t, k)];
      field.value.push_back(static_cast<float>(v));
    }
}

// Size of the displacement at the surface point nearest to x, m.
Real displacement_near(Solid& solid, const StressState& state, const Vec3& x) {
  const TriangleBvh::Closest near = solid.bvh().closest(x);
  const std::array<Real, 3> w = corner_weights(solid.mesh(), near.face, near.point);
  Vec3 u;
  for (std::size_t k = 0; k < 3; ++k) u += w[k] * state.displacement()[solid.mesh().triangles[near.face][k]];
  return norm(u);
}

void sampled_values(FieldKind kind, Solid& solid, const StressState& state, const Elastic& material,
                    const SurfaceMesh& mesh, SurfaceField& field) {
  std::vector<Real> of_vertex;
  if (kind == FieldKind::kDisplacement) {
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
      of_vertex.push_back(displacement_near(solid, state, mesh.vertices[v]));
  } else {
    std::vector<Sym3> stress;
    state.evaluate(mesh.vertices, stress);
    for (const Sym3& s : stress) of_vertex.push_back(stress_value(kind, s, material));
  }
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) field.value.push_back(static_cast<float>(of_vertex[v]));
}

}  // namespace

// epsilon = (sigma - nu / (1 + nu) tr(sigma) I) / (2 mu)
Real strain_energy_density(const Sym3& s, const Elastic& material) {
  const Real square = s.xx * s.xx + s.yy * s.yy + s.zz * s.zz + 2 * (s.yz * s.yz + s.xz * s.xz + s.xy * s.xy);
  const Real trace = s.xx + s.yy + s.zz;
  return (square - material.nu / (1 + material.nu) * trace * trace) / (4 * material.mu);
}

std::shared_ptr<const SurfaceField> shown_field(const SceneField& wanted, Solid& solid, const StressState& state,
                                                const Elastic& material, const SurfaceMesh& mesh) {
  auto field = std::make_shared<SurfaceField>();
  field->on_cracks = wanted.kind != FieldKind::kDisplacement;
  field->value.reserve(3 * mesh.triangle_count());
  if (&mesh != &solid.mesh()) {
    sampled_values(wanted.kind, solid, state, material, mesh, *field);
  } else {
    own_values(wanted.kind, solid, state, material, *field);
    if (wanted.deformation > 0)
      for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
        field->displacement.push_back(wanted.deformation * state.displacement()[v]);
  }
  if (!std::all_of(field->value.begin(), field->value.end(), [](float v) { return std::isfinite(v); })) return nullptr;
  return field;
}

FieldScale field_scale(const SceneField& wanted) {
  const auto i = static_cast<std::size_t>(wanted.kind);
  FieldScale scale{std::string(kFieldNames[i]), std::string(kFieldUnits[i]), 0, 0};
  if (wanted.range) scale.low = wanted.range->first, scale.high = wanted.range->second;
  return scale;
}

void widen(FieldScale& scale, const SceneField& wanted, const SurfaceField& field) {
  constexpr Real kShown = 0.98;  // of the corners
  if (wanted.range || field.value.empty()) return;
  std::vector<float> sorted = field.value;
  std::sort(sorted.begin(), sorted.end());
  const auto last = static_cast<Real>(sorted.size() - 1);
  scale.high = std::max(scale.high, static_cast<Real>(sorted[static_cast<std::size_t>(kShown * last)]));
  scale.low = std::min(scale.low, static_cast<Real>(sorted.front()));
}

}  // namespace sherd
