#include "engine/stress/indirect_state.h"

#include "engine/stress/layer_gradient.h"
#include "engine/stress/near_surface.h"
#include "kernels/core/error.h"
#include "kernels/core/parallel.h"
#include "kernels/fundamental/kelvin.h"

namespace sherd {

IndirectState::IndirectState(const IndirectBody& body, const SurfaceRecovery& recovery, const TriangleBvh& bvh,
                             const Load& load, const ParticularSolution& particular, const IndirectSolution& solution)
    : body_(body),
      recovery_(recovery),
      bvh_(bvh),
      field_(body.body_force_field(load, particular)),
      density_(solution.density) {
  const Boundary& b = body.boundary();
  SHERD_CHECK(density_.size() == b.panels.size(), "a density for {} of {} triangles", density_.size(), b.panels.size());
  face_stress_.resize(b.panels.size());
  parallel_for(b.panels.size(), 4,
               [&](std::size_t t) { face_stress_[t] = total(b.centroid[t], static_cast<std::uint32_t>(t)); });
  corner_stress_.resize(recovery.corners().size());
  for (std::size_t c = 0; c < corner_stress_.size(); ++c) {
    Real area = 0;
    for (const std::uint32_t f : recovery.corners()[c].faces)
      corner_stress_[c] += face_stress_[f] * b.panels[f].area, area += b.panels[f].area;
    corner_stress_[c] *= 1 / area;
  }
}

Sym3 IndirectState::total(const Vec3& x, std::uint32_t own) const {
  const Boundary& b = body_.boundary();
  const Elastic& m = body_.material();
  Mat3 g;
  for (std::size_t t = 0; t < b.panels.size(); ++t)
    g += layer_gradient(b.panels[t], x, density_[t], m, body_.options().quadrature,
                        t == own ? Side::kInterior : Side::kAway)
             .kelvin;
  return kelvin::hooke(g, m) + field_.stress(x);
}

void IndirectState::on_faces(const Vec3Column& points, std::span<const std::uint32_t> face, std::span<Sym3> out) const {
  for (std::size_t i = 0; i < points.size(); ++i)
    out[i] = interpolate_corners(body_.boundary().panels[face[i]], recovery_, corner_stress_, face[i], points[i]);
}

void IndirectState::evaluate(const Vec3Column& points, std::vector<Sym3>& out) const {
  out.resize(points.size());
  parallel_for(points.size(), 1, [&](std::size_t i) {
    const SurfaceBlend b = blend_near_surface(bvh_, body_.boundary(), points[i]);
    out[i] = {};
    if (b.inside > 0) out[i] += interior(b.below) * b.inside;
    if (b.inside < 1) out[i] += on_face(b.face, b.on) * (1 - b.inside);
  });
}

}  // namespace sherd
