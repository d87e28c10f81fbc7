#include "engine/elastostatic/boundary.h"

#include "kernels/quadrature/gauss.h"

namespace sherd {

Boundary::Boundary(const SurfaceMesh& surface, const QuadratureOptions& options) : mesh(surface) {
  const std::size_t n = mesh.triangle_count();
  panels.resize(n), centroid.resize(n), near2.resize(n), middle2.resize(n);
  vertex_area.assign(mesh.vertex_count(), 0);
  for (std::size_t t = 0; t < n; ++t) {
    panels[t] = make_panel(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
    centroid.set(t, panels[t].centroid());
    near2[t] = options.closed_form * options.closed_form * panels[t].longest2;
    middle2[t] = options.gauss7 * options.gauss7 * panels[t].longest2;
    for (const std::uint32_t v : mesh.triangles[t]) vertex_area[v] += panels[t].area / 3;
    area += panels[t].area;
  }
}

Vec3Column far_points(const std::vector<PanelFrame>& panels) {
  Vec3Column out(3 * panels.size());
  for (std::size_t t = 0; t < panels.size(); ++t)
    for (std::size_t q = 0; q < 3; ++q) {
      const auto& v = panels[t].vertex;
      out.set(3 * t + q, v[0] * kGauss3[q].a + v[1] * kGauss3[q].b + v[2] * kGauss3[q].c);
    }
  return out;
}

}  // namespace sherd
