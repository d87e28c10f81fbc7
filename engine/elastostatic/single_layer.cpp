#include "engine/elastostatic/single_layer.h"

#include "kernels/core/parallel.h"
#include "kernels/fundamental/kelvin.h"
#include "kernels/quadrature/gauss.h"

namespace sherd {
namespace {

Vec3 closed_form(const PanelFrame& f, const Vec3& x, const Vec3& t, const Elastic& m) {
  PanelValues v;
  integrate_panel(f, x, Side::kAway, v);
  return (t * ((3 - 4 * m.nu) * v.inverse) + v.dyad * t) * m.kelvin();
}

template <std::size_t N, class Density>
Vec3 gauss(const PanelFrame& f, const Vec3& x, const std::array<TrianglePoint, N>& rule, const Density& density,
           const Elastic& m) {
  Vec3 u;
  for (const TrianglePoint& g : rule) {
    const Vec3 y = f.vertex[0] * g.a + f.vertex[1] * g.b + f.vertex[2] * g.c;
    u += kelvin::displacement(x - y, density(y) * (g.weight * f.area), m);
  }
  return u;
}

// One load panel with its reach.
struct LoadPanel {
  PanelFrame frame;
  Vec3 traction, centroid;
};

std::array<PanelFrame, 4> split(const PanelFrame& f) {
  const Vec3 m0 = 0.5 * (f.vertex[0] + f.vertex[1]), m1 = 0.5 * (f.vertex[1] + f.vertex[2]),
             m2 = 0.5 * (f.vertex[2] + f.vertex[0]);
  return {make_panel(f.vertex[0], m0, m2), make_panel(m0, f.vertex[1], m1), make_panel(m2, m1, f.vertex[2]),
          make_panel(m0, m1, m2)};
}

}  // namespace

Vec3Column load_potential(const Boundary& b, const Load& load, const ParticularSolution& particular, const Elastic& m,
                          const QuadratureOptions& options) {
  std::vector<LoadPanel> panels(load.panels.size());
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const auto& c = load.panels.corners[i];
    panels[i].frame = make_panel(c[0], c[1], c[2]);
    panels[i].traction = load.panels.traction[i], panels[i].centroid = panels[i].frame.centroid();
  }
  const Real near2 = options.closed_form * options.closed_form, middle2 = options.gauss7 * options.gauss7;
  Vec3Column potential(b.mesh.vertex_count());
  parallel_for(b.mesh.vertex_count(), 16, [&](std::size_t p) {
    const Vec3 x = b.mesh.vertices[p];
    Vec3 u;
    for (const LoadPanel& panel : panels) {
      const Real d2 = distance2(x, panel.centroid) / panel.frame.longest2;
      const auto density = [&](const Vec3&) { return panel.traction; };
      u += d2 > middle2 ? gauss(panel.frame, x, kGauss3, density, m)
                        : (d2 > near2 ? gauss(panel.frame, x, kGauss7, density, m)
                                      : closed_form(panel.frame, x, panel.traction, m));
    }
    if (!particular.zero() || !load.face_traction.empty())
      for (std::size_t t = 0; t < b.panels.size(); ++t) {
        const PanelFrame& f = b.panels[t];
        const Vec3 constant = load.face_traction.empty() ? Vec3{} : load.face_traction[t];
        const auto density = [&](const Vec3& y) { return constant - particular.stress(y) * f.normal; };
        const Real d2 = distance2(x, b.centroid[t]);
        if (d2 > b.middle2[t])
          u += gauss(f, x, kGauss3, density, m);
        else if (d2 > b.near2[t])
          u += gauss(f, x, kGauss7, density, m);
        else if (particular.zero())
          u += closed_form(f, x, constant, m);
        else
          for (const PanelFrame& s : split(f)) u += closed_form(s, x, density(s.centroid()), m);
      }
    potential.set(p, u);
  });
  return potential;
}

}  // namespace sherd
