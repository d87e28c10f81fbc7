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

// A panel as point forces at the nodes of a rule: position and density times weight times area.
struct PointForces {
  Vec3Column position, force;

  template <std::size_t N, class Density>
  void add(const PanelFrame& f, const std::array<TrianglePoint, N>& rule, const Density& density) {
    for (const TrianglePoint& g : rule) {
      const Vec3 y = f.vertex[0] * g.a + f.vertex[1] * g.b + f.vertex[2] * g.c;
      position.push_back(y), force.push_back(density(y) * (g.weight * f.area));
    }
  }
  Vec3 displacement(std::size_t begin, std::size_t end, const Vec3& x, const Elastic& m) const {
    Vec3 u;
    for (std::size_t i = begin; i < end; ++i) u += kelvin::displacement(x - position[i], force[i], m);
    return u;
  }
};

std::array<PanelFrame, 4> split(const PanelFrame& f) {
  const Vec3 m0 = 0.5 * (f.vertex[0] + f.vertex[1]), m1 = 0.5 * (f.vertex[1] + f.vertex[2]),
             m2 = 0.5 * (f.vertex[2] + f.vertex[0]);
  return {make_panel(f.vertex[0], m0, m2), make_panel(m0, f.vertex[1], m1), make_panel(m2, m1, f.vertex[2]),
          make_panel(m0, m1, m2)};
}

// The layer with everything that does not depend on the target computed once: a panel is constant sub-panels near the
// target, seven points farther away, three points far away.
struct Layer {
  std::vector<PanelFrame> near;  // near[first_near[i] ... first_near[i + 1])
  Vec3Column near_density;
  std::vector<std::size_t> first_near{0};
  PointForces middle, far;  // seven and three a panel
  Vec3Column centroid;
  std::vector<Real> near2, middle2;  // squared reach of each description, m^2

  template <class Density>
  void add(const PanelFrame& f, bool constant, const Density& density, const QuadratureOptions& o) {
    if (constant)
      near.push_back(f), near_density.push_back(density(f.centroid()));
    else
      for (const PanelFrame& s : split(f)) near.push_back(s), near_density.push_back(density(s.centroid()));
    first_near.push_back(near.size());
    middle.add(f, kGauss7, density), far.add(f, kGauss3, density);
    centroid.push_back(f.centroid());
    // Displacements, unlike their gradients, are within 1.4e-5 from two edges on (design notes, section 2).
    const Real reach = std::max(o.closed_form - 1, 0.0);
    near2.push_back(reach * reach * f.longest2), middle2.push_back(o.gauss7 * o.gauss7 * f.longest2);
  }
  Vec3 displacement(const Vec3& x, const Elastic& m) const {
    Vec3 u;
    for (std::size_t i = 0; i < near2.size(); ++i) {
      const Real d2 = distance2(x, centroid[i]);
      if (d2 > middle2[i])
        u += far.displacement(3 * i, 3 * i + 3, x, m);
      else if (d2 > near2[i])
        u += middle.displacement(7 * i, 7 * i + 7, x, m);
      else
        for (std::size_t s = first_near[i]; s < first_near[i + 1]; ++s)
          u += closed_form(near[s], x, near_density[s], m);
    }
    return u;
  }
};

}  // namespace

Vec3Column load_potential(const Boundary& b, const Load& load, const ParticularSolution& particular, const Elastic& m,
                          const QuadratureOptions& options) {
  Layer layer;
  for (std::size_t i = 0; i < load.panels.size(); ++i) {
    const auto& c = load.panels.corners[i];
    layer.add(
        make_panel(c[0], c[1], c[2]), true, [&](const Vec3&) { return load.panels.traction[i]; }, options);
  }
  if (!particular.zero() || !load.face_traction.empty())
    for (std::size_t t = 0; t < b.panels.size(); ++t) {
      const Vec3 constant = load.face_traction.empty() ? Vec3{} : load.face_traction[t];
      const Vec3& n = b.panels[t].normal;
      const auto density = [&](const Vec3& y) { return constant - particular.stress(y) * n; };
      layer.add(b.panels[t], particular.zero(), density, options);
    }
  Vec3Column potential(b.mesh.vertex_count());
  parallel_for(b.mesh.vertex_count(), 16,
               [&](std::size_t p) { potential.set(p, layer.displacement(b.mesh.vertices[p], m)); });
  return potential;
}

}  // namespace sherd
