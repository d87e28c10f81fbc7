#include "engine/stress/stress.h"

#include <algorithm>
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
  far_ = std::make_unique<FarField>(b, elements_, body.material(), body.options().quadrature);
  patch_load_.patches = load.patches;
  for (const auto& c : load.panels.corners) load_panels_.push_back(make_panel(c[0], c[1], c[2]));
  // Recovered is what the particular solution leaves: of the corners of a faceted body neither the tangent plane nor
  // the traction is known exactly, and the mean stress is not to suffer from it.
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

void StressState::displacement_gradients(std::span<const Vec3> x, std::span<const std::uint32_t> face,
                                         std::span<Mat3> out) const {
  far_->gradients(x, face, out);
  for (std::size_t k = 0; k < x.size(); ++k)
    for (std::size_t i = 0; i < load_panels_.size(); ++i)
      out[k] +=
          layer_gradient(load_panels_[i], x[k], load_traction_[i], body_.material(), body_.options().quadrature).kelvin;
}

Mat3 StressState::displacement_gradient(const Vec3& x, std::uint32_t face) const {
  Mat3 g;
  displacement_gradients({&x, 1}, {&face, 1}, {&g, 1});
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
  parallel_for((points.size() + kLanes - 1) / kLanes, 1, [&](std::size_t group) {
    const std::size_t first = group * kLanes, count = std::min(kLanes, points.size() - first);
    std::array<Vec3, kLanes> x;
    std::array<std::uint32_t, kLanes> face;
    std::array<Mat3, kLanes> gradient;
    for (std::size_t k = 0; k < count; ++k) x[k] = points[first + k], face[k] = kNone;
    displacement_gradients({x.data(), count}, {face.data(), count}, {gradient.data(), count});
    for (std::size_t k = 0; k < count; ++k)
      out[first + k] = blend_near_surface(*this, bvh_, body_.boundary(), x[k], [&](const Vec3& y) {
        return y == x[k] ? kelvin::hooke(gradient[k], body_.material()) + particular_.stress(y) : interior(y);
      });
  });
}

}  // namespace sherd
