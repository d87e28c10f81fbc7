#include "engine/elastostatic/boundary.h"

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

}  // namespace sherd
