#include "engine/stress/stress.h"

#include <numbers>

#include "engine/stress/layer_gradient.h"
#include "engine/stress/near_surface.h"
#include "kernels/core/parallel.h"
#include "kernels/fundamental/kelvin.h"
#include "kernels/quadrature/gauss.h"

namespace sherd {
namespace {

constexpr Real kPull = 0.1;  // towards the centroid, of the barycentric coordinates

}  // namespace

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
  // Recovered is what the particular solution leaves: of the corners of a faceted body neither the tangent plane nor the
  // traction is known exactly, and the mean stress is not to suffer from it.
  Vec3Column traction(recovery.corners().size());
  for (std::size_t c = 0; c < traction.size(); ++c) {
    const SurfaceCorner& corner = recovery.corners()[c];
    const Vec3 x = b.mesh.vertices[corner.vertex];
    Vec3 force, area;
    for (const std::uint32_t f : corner.faces) {
      const Vec3 normal2 = b.mesh.area_normal2(f);
      force += traction_at(load, b.mesh, x, f) * norm(normal2), area += normal2;
    }
    traction.set(c, (force - particular_.stress(x) * area) / norm(area));
  }
  corner_stress_ = recovery.stress(solution.displacement, traction, body.material());
  for (std::size_t c = 0; c < traction.size(); ++c)
    corner_stress_[c] += particular_.stress(b.mesh.vertices[recovery.corners()[c].vertex]);
  for (std::size_t v = 0; v < displacement_.size(); ++v)
    displacement_.add(v, particular_.displacement(b.mesh.vertices[v]));
  worst_corner_.assign(b.mesh.vertex_count(), kNone);
  std::vector<Real> worst(b.mesh.vertex_count(), 0);
  for (std::uint32_t c = 0; c < corner_stress_.size(); ++c) {
    const std::uint32_t v = recovery.corners()[c].vertex;
    const Real s = eigen_symmetric(corner_stress_[c]).value[0];
    if (worst_corner_[v] == kNone || s > worst[v]) worst_corner_[v] = c, worst[v] = s;
  }
}

Mat3 StressState::displacement_gradient(const Vec3& x, std::uint32_t face) const {
  const Boundary& b = body_.boundary();
  const Elastic& m = body_.material();
  Mat3 g;
  for (std::size_t t = 0; t < b.panels.size(); ++t)
    g += elements_[t].gradient_at(b.panels[t], x, m, std::sqrt(b.near2[t]), std::sqrt(b.middle2[t]),
                                  t == face ? Side::kInterior : Side::kAway);
  for (std::size_t i = 0; i < load_panels_.size(); ++i)
    g += layer_gradient(load_panels_[i], x, load_traction_[i], m, body_.options().quadrature).kelvin;
  return g;
}

Sym3 StressState::interior(const Vec3& x) const {
  return kelvin::hooke(displacement_gradient(x, kNone), body_.material()) + particular_.stress(x);
}

Sym3 StressState::on_face(std::uint32_t face, const Vec3& x) const {
  const Boundary& b = body_.boundary();
  const PanelFrame& f = b.panels[face];
  const Elastic& m = body_.material();
  std::array<Real, 3> l{};
  l[1] = std::clamp(dot(f.shape_gradient(1), x - f.vertex[0]), 0.0, 1.0);
  l[2] = std::clamp(dot(f.shape_gradient(2), x - f.vertex[0]), 0.0, 1.0 - l[1]);
  l[0] = 1 - l[1] - l[2];
  // The limit of Somigliana's gradient sees the kinks of the polyhedron, which the fits smooth over; at the edges it is
  // logarithmically infinite, so that it is taken a little inside and moved with the element's own gradient.
  std::array<Real, 3> in{};
  for (std::size_t k = 0; k < 3; ++k) in[k] = (l[k] + kPull) / (1 + 3 * kPull);
  const Vec3 y = f.vertex[0] * in[0] + f.vertex[1] * in[1] + f.vertex[2] * in[2];
  const ElementField& e = elements_[face];
  Mat3 g = displacement_gradient(y, face);
  g = g - outer(g * f.normal, f.normal) + e.surface_gradient(f, l[1], l[2]) - e.surface_gradient(f, in[1], in[2]);
  const Vec3 traction = e.traction_at(l[1], l[2]) + traction_at(patch_load_, b.mesh, x, face);
  return surface_stress(g, f.normal, traction, m) + particular_.stress(x);
}

void StressState::evaluate(const Vec3Column& points, std::vector<Sym3>& out) const {
  out.resize(points.size());
  parallel_for(points.size(), 1, [&](std::size_t i) {
    out[i] = blend_near_surface(*this, bvh_, body_.boundary(), points[i], [&](const Vec3& x) { return interior(x); });
  });
}

}  // namespace sherd
