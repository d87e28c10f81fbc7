#include "engine/stress/stress.h"

#include <numbers>

#include "engine/stress/layer_gradient.h"
#include "engine/stress/near_surface.h"
#include "kernels/core/parallel.h"
#include "kernels/fundamental/kelvin.h"
#include "kernels/quadrature/gauss.h"

namespace sherd {
StressState::StressState(const ElasticBody& body, const SurfaceRecovery& recovery, const TriangleBvh& bvh,
                         const Load& load, const ParticularSolution& particular, const ElasticSolution& solution)
    : body_(body),
      recovery_(recovery),
      bvh_(bvh),
      particular_(particular),
      displacement_(solution.displacement),
      load_traction_(load.panels.traction) {
  const Boundary& b = body.boundary();
  const std::size_t triangles = b.panels.size();
  Vec3Column nodes;
  body.reconstruction().apply(solution.displacement, nodes);
  elements_.resize(triangles);
  parallel_for(triangles, 256, [&](std::size_t t) {
    std::array<Vec3, cubic::kNodes> u;
    for (std::size_t a = 0; a < u.size(); ++a) u[a] = nodes[body.reconstruction().nodes(t)[a]];
    elements_[t] = ElementField(b.panels[t], u, traction_polynomial(b, load, particular_, t), body.material());
  });
  patch_load_.patches = load.patches;
  for (const auto& c : load.panels.corners) load_panels_.push_back(make_panel(c[0], c[1], c[2]));
  for (std::size_t v = 0; v < displacement_.size(); ++v)
    displacement_.add(v, particular_.displacement(b.mesh.vertices[v]));
  Vec3Column traction(recovery.corners().size());
  for (std::size_t c = 0; c < traction.size(); ++c) {
    const SurfaceCorner& corner = recovery.corners()[c];
    Vec3 force, area;  // of a uniformly stressed polyhedron this is exact
    for (const std::uint32_t f : corner.faces) {
      const Vec3 normal2 = b.mesh.area_normal2(f);
      force += traction_at(load, b.mesh, b.mesh.vertices[corner.vertex], f) * norm(normal2), area += normal2;
    }
    traction.set(c, force / norm(area));
  }
  corner_stress_ = recovery.stress(displacement_, traction, body.material());
  worst_corner_.assign(b.mesh.vertex_count(), kNone);
  std::vector<Real> worst(b.mesh.vertex_count(), 0);
  for (std::uint32_t c = 0; c < corner_stress_.size(); ++c) {
    const std::uint32_t v = recovery.corners()[c].vertex;
    const Real s = eigen_symmetric(corner_stress_[c]).value[0];
    if (worst_corner_[v] == kNone || s > worst[v]) worst_corner_[v] = c, worst[v] = s;
  }
}

Sym3 StressState::interior(const Vec3& x) const {
  const Boundary& b = body_.boundary();
  const Elastic& m = body_.material();
  const QuadratureOptions& o = body_.options().quadrature;
  Mat3 g;
  for (std::size_t t = 0; t < b.panels.size(); ++t)
    g += elements_[t].gradient_at(b.panels[t], x, m, std::sqrt(b.near2[t]), std::sqrt(b.middle2[t]));
  for (std::size_t i = 0; i < load_panels_.size(); ++i)
    g += layer_gradient(load_panels_[i], x, load_traction_[i], m, o).kelvin;
  return kelvin::hooke(g, m) + particular_.stress(x);
}

Sym3 StressState::on_face(std::uint32_t face, const Vec3& x) const {
  const Boundary& b = body_.boundary();
  const PanelFrame& f = b.panels[face];
  const Real s = std::clamp(dot(f.shape_gradient(1), x - f.vertex[0]), 0.0, 1.0),
             t = std::clamp(dot(f.shape_gradient(2), x - f.vertex[0]), 0.0, 1.0 - s);
  const Vec3 traction = elements_[face].traction_at(s, t) + traction_at(patch_load_, b.mesh, x, face);
  return surface_stress(elements_[face].surface_gradient(f, s, t), f.normal, traction, body_.material()) +
         particular_.stress(x);
}

void StressState::evaluate(const Vec3Column& points, std::vector<Sym3>& out) const {
  out.resize(points.size());
  parallel_for(points.size(), 1, [&](std::size_t i) {
    out[i] = blend_near_surface(*this, bvh_, body_.boundary(), points[i], [&](const Vec3& x) { return interior(x); });
  });
}

}  // namespace sherd
