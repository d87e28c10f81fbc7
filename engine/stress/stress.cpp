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
  density_.resize(triangles), guenter_.resize(triangles), gradient_.resize(triangles);
  parallel_for(triangles, 256, [&](std::size_t t) {
    const PanelFrame& f = b.panels[t];
    Mat3 g;  // g[i][k] = d u_i / d x_k
    for (int a = 0; a < 3; ++a)
      g += outer(solution.displacement[b.mesh.triangles[t][static_cast<std::size_t>(a)]], f.shape_gradient(a));
    const Vec3 mu = transpose(g) * f.normal - f.normal * trace(g);  // (M u)_i = n_j d_i u_j - n_i d_j u_j
    Vec3 traction = load.face_traction.empty() ? Vec3{} : load.face_traction[t];
    if (!particular_.zero())
      for (const TrianglePoint& p : kGauss3)
        traction -= particular_.stress(f.vertex[0] * p.a + f.vertex[1] * p.b + f.vertex[2] * p.c) * f.normal * p.weight;
    gradient_[t] = g;
    guenter_.set(t, mu);
    density_.set(t, traction - mu * (2 * body.material().mu));
  });
  for (const auto& c : load.panels.corners) load_panels_.push_back(make_panel(c[0], c[1], c[2]));
  for (std::size_t v = 0; v < displacement_.size(); ++v)
    displacement_.add(v, particular_.displacement(b.mesh.vertices[v]));
  Vec3Column traction(recovery.corners().size());
  for (std::size_t c = 0; c < traction.size(); ++c) {
    const SurfaceCorner& corner = recovery.corners()[c];
    Vec3 sum;
    for (const std::uint32_t f : corner.faces) sum += traction_at(load, b.mesh, b.mesh.vertices[corner.vertex], f);
    traction.set(c, sum / static_cast<Real>(corner.faces.size()));
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
  for (std::size_t t = 0; t < b.panels.size(); ++t) {
    const PanelFrame& f = b.panels[t];
    const LayerGradient l = layer_gradient(f, x, density_[t], m, o);
    const Mat3& s = gradient_[t];
    g += l.kelvin + (outer(guenter_[t], l.inverse) + s * dot(l.inverse, f.normal) - outer(s * l.inverse, f.normal)) *
                        (1 / (4 * std::numbers::pi));
  }
  for (std::size_t i = 0; i < load_panels_.size(); ++i)
    g += layer_gradient(load_panels_[i], x, load_traction_[i], m, o).kelvin;
  return kelvin::hooke(g, m) + particular_.stress(x);
}

Sym3 StressState::on_face(std::uint32_t face, const Vec3& x) const {
  return interpolate_corners(body_.boundary().panels[face], recovery_, corner_stress_, face, x);
}

void StressState::evaluate(const Vec3Column& points, std::vector<Sym3>& out) const {
  out.resize(points.size());
  parallel_for(points.size(), 1, [&](std::size_t i) {
    out[i] = blend_near_surface(*this, bvh_, body_.boundary(), points[i], [&](const Vec3& x) { return interior(x); });
  });
}

}  // namespace sherd
