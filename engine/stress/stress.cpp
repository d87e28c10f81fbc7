#include "engine/stress/stress.h"

#include <algorithm>

#include "engine/stress/near_surface.h"
#include "kernels/core/parallel.h"
#include "kernels/core/trace.h"
#include "kernels/fundamental/kelvin.h"
#include "kernels/quadrature/gauss.h"

namespace sherd {
namespace {

constexpr Real kPull = 0.1;  // towards the centroid, of the barycentric coordinates

// Of x, or of the point of the panel that it is clamped to.
std::array<Real, 3> barycentric(const PanelFrame& f, const Vec3& x) {
  std::array<Real, 3> l{};
  l[1] = std::clamp(dot(f.shape_gradient(1), x - f.vertex[0]), 0.0, 1.0);
  l[2] = std::clamp(dot(f.shape_gradient(2), x - f.vertex[0]), 0.0, 1.0 - l[1]);
  l[0] = 1 - l[1] - l[2];
  return l;
}

std::array<Real, 3> pulled(const std::array<Real, 3>& l) {
  std::array<Real, 3> in{};
  for (std::size_t k = 0; k < 3; ++k) in[k] = (l[k] + kPull) / (1 + 3 * kPull);
  return in;
}

}  // namespace

StressState::StressState(const ElasticBody& body, const SurfaceRecovery& recovery, const TriangleBvh& bvh,
                         const Load& load, const ParticularSolution& particular, const ElasticSolution& solution)
    : body_(body),
      recovery_(recovery),
      bvh_(bvh),
      particular_(particular),
      displacement_(solution.displacement),
      load_gradients_(load.panels, body.material(), body.options().quadrature) {
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
  somigliana_ = std::make_unique<Somigliana>(b, elements_, body.material(), body.options().quadrature);
  patch_load_.patches = load.patches;
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

void StressState::displacement_gradients(const Vec3Column& x, std::span<const std::uint32_t> face,
                                         std::span<Mat3> out) const {
  somigliana_->gradients(x, face, out);
  load_gradients_.add(x, out);
}

Sym3 StressState::interior(const Vec3& x) const {
  Vec3Column one;
  one.push_back(x);
  const std::uint32_t face = kNone;
  Mat3 g;
  displacement_gradients(one, {&face, 1}, {&g, 1});
  return kelvin::hooke(g, body_.material()) + particular_.stress(x);
}

// The limit of Somigliana's gradient sees the kinks of the polyhedron, which the fits smooth over; at the edges it is
// logarithmically infinite, so that it is taken a little inside and moved with the element's own gradient.
Vec3 StressState::asked_on_face(std::uint32_t face, const Vec3& x) const {
  const PanelFrame& f = body_.boundary().panels[face];
  const std::array<Real, 3> l = pulled(barycentric(f, x));
  return f.vertex[0] * l[0] + f.vertex[1] * l[1] + f.vertex[2] * l[2];
}

Sym3 StressState::stress_on_face(std::uint32_t face, const Vec3& x, const Mat3& gradient) const {
  const Boundary& b = body_.boundary();
  const PanelFrame& f = b.panels[face];
  const std::array<Real, 3> l = barycentric(f, x), in = pulled(l);
  const ElementField& e = elements_[face];
  const Mat3 g = gradient - outer(gradient * f.normal, f.normal) + e.surface_gradient(f, l[1], l[2]) -
                 e.surface_gradient(f, in[1], in[2]);
  const Vec3 traction = e.traction_at(l[1], l[2]) + traction_at(patch_load_, b.mesh, x, face);
  return surface_stress(g, f.normal, traction, body_.material()) + particular_.stress(x);
}

void StressState::on_faces(const Vec3Column& points, std::span<const std::uint32_t> face, std::span<Sym3> out) const {
  Vec3Column asked(points.size());
  std::vector<Mat3> gradient(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) asked.set(i, asked_on_face(face[i], points[i]));
  displacement_gradients(asked, face, gradient);
  for (std::size_t i = 0; i < points.size(); ++i) out[i] = stress_on_face(face[i], points[i], gradient[i]);
}

void StressState::evaluate(const Vec3Column& points, std::vector<Sym3>& out) const {
  const TraceScope scope("stress at points");
  out.resize(points.size());
  std::vector<SurfaceBlend> blend(points.size());
  parallel_for(points.size(), 8,
               [&](std::size_t i) { blend[i] = blend_near_surface(bvh_, body_.boundary(), points[i]); });
  // All gradients at once: first the one below, then the one on the face, of those that need it.
  Vec3Column asked;
  std::vector<std::uint32_t> face;
  for (const SurfaceBlend& b : blend) {
    if (b.inside > 0) asked.push_back(b.below), face.push_back(kNone);
    if (b.inside < 1) asked.push_back(asked_on_face(b.face, b.on)), face.push_back(b.face);
  }
  std::vector<Mat3> gradient(asked.size());
  displacement_gradients(asked, face, gradient);
  std::size_t next = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SurfaceBlend& b = blend[i];
    out[i] = {};
    if (b.inside > 0)
      out[i] += (kelvin::hooke(gradient[next++], body_.material()) + particular_.stress(b.below)) * b.inside;
    if (b.inside < 1) out[i] += stress_on_face(b.face, b.on, gradient[next++]) * (1 - b.inside);
  }
}

}  // namespace sherd
