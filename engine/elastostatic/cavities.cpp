#include "engine/elastostatic/cavities.h"

#include <algorithm>

#include "engine/elastostatic/single_layer.h"
#include "engine/mesh/bvh.h"
#include "kernels/core/parallel.h"
#include "kernels/quadrature/gauss.h"

namespace sherd {
namespace {

// The widest free place in a cavity, searched along the normals of its faces.
struct FreePlace {
  Vec3 centre;
  Real clearance = 0, edge = 0;  // distance to the wall; longest edge of the nearest face
};

FreePlace widest_place(const Boundary& b, const std::vector<std::uint32_t>& label, std::uint32_t shell,
                       const TriangleBvh& bvh) {
  FreePlace best;
  std::vector<std::uint32_t> faces;
  for (std::uint32_t t = 0; t < label.size(); ++t)
    if (label[t] == shell) faces.push_back(t);
  const std::size_t stride = std::max<std::size_t>(1, faces.size() / 200);
  for (std::size_t i = 0; i < faces.size(); i += stride) {
    const PanelFrame& f = b.panels[faces[i]];
    for (Real step = 0.5 * std::sqrt(f.longest2); step < 1e6 * std::sqrt(f.longest2); step *= 1.4) {
      const Vec3 p = f.centroid() + f.normal * step;
      if (bvh.inside(p)) break;  // the normal points out of the solid: across the cavity and into its far wall
      const TriangleBvh::Closest c = bvh.closest(p);
      if (label[c.face] != shell) break;
      const Real distance = std::sqrt(c.distance2);
      if (distance > best.clearance) best = {p, distance, std::sqrt(b.panels[c.face].longest2)};
    }
  }
  return best;
}

Vec3 source_field(const Vec3& r) {
  const Real l = norm(r);
  return r / (l * l * l);
}
// grad(u*) n, half the traction over mu.
Vec3 source_traction(const Vec3& r, const Vec3& n) {
  const Real l2 = norm2(r), l3 = l2 * std::sqrt(l2);
  return (n - r * (3 * dot(r, n) / l2)) / l3;
}

// visit(s, t, weight) over a seven-point rule on the triangle, split while it is near the source.
template <class Visit>
void integrate(const PanelFrame& f, const Vec3& centre, const std::array<std::array<Real, 2>, 3>& corner, int depth,
               const Visit& visit) {
  const auto at = [&](Real s, Real t) { return f.vertex[0] * (1 - s - t) + f.vertex[1] * s + f.vertex[2] * t; };
  const auto middle = [&](std::size_t i, std::size_t j) {
    return std::array<Real, 2>{0.5 * (corner[i][0] + corner[j][0]), 0.5 * (corner[i][1] + corner[j][1])};
  };
  const Vec3 a = at(corner[0][0], corner[0][1]), b = at(corner[1][0], corner[1][1]), c = at(corner[2][0], corner[2][1]);
  const Real size2 = std::max({distance2(a, b), distance2(b, c), distance2(c, a)});
  if (depth > 0 && distance2((a + b + c) / 3.0, centre) < 6 * size2) {
    const auto m01 = middle(0, 1), m12 = middle(1, 2), m20 = middle(2, 0);
    integrate(f, centre, {corner[0], m01, m20}, depth - 1, visit);
    integrate(f, centre, {m01, corner[1], m12}, depth - 1, visit);
    integrate(f, centre, {m20, m12, corner[2]}, depth - 1, visit);
    integrate(f, centre, {m01, m12, m20}, depth - 1, visit);
    return;
  }
  const Real area = 0.5 * norm(cross(b - a, c - a));
  for (const TrianglePoint& g : kGauss7)
    visit(corner[0][0] * g.a + corner[1][0] * g.b + corner[2][0] * g.c,
          corner[0][1] * g.a + corner[1][1] * g.b + corner[2][1] * g.c, g.weight * area);
}

constexpr std::array<std::array<Real, 2>, 3> kWhole = {{{0, 0}, {1, 0}, {0, 1}}};
constexpr int kDepth = 4;

Real product(std::span<const Real> a, std::span<const Real> b) {
  return parallel_sum<Real>(a.size(), 8192, [&](std::size_t i) { return a[i] * b[i]; });
}

std::vector<Real> interleaved(const Vec3Column& v) {
  std::vector<Real> out;
  out.reserve(3 * v.size());
  for (std::size_t i = 0; i < v.size(); ++i) out.insert(out.end(), {v.x[i], v.y[i], v.z[i]});
  return out;
}

}  // namespace

CavityModes::CavityModes(const Boundary& b, const Reconstruction& r, const RigidModes& rigid) {
  std::vector<std::uint32_t> label;
  const std::uint32_t shells = label_components(b.mesh, label);
  if (shells < 2) return;
  std::vector<Real> volume(shells, 0);
  for (std::size_t t = 0; t < label.size(); ++t)
    volume[label[t]] += dot(b.mesh.corner(t, 0), cross(b.mesh.corner(t, 1), b.mesh.corner(t, 2))) / 6;
  const TriangleBvh bvh(b.mesh);
  for (std::uint32_t shell = 0; shell < shells; ++shell) {
    if (volume[shell] >= 0) continue;
    const FreePlace place = widest_place(b, label, shell, bvh);
    if (place.clearance < 0.3 * place.edge) continue;
    Vec3Column nodes(r.node_count()), field;
    for (std::size_t t = 0; t < b.panels.size(); ++t) {
      const PanelFrame& f = b.panels[t];
      integrate(f, place.centre, kWhole, kDepth, [&](Real s, Real u, Real weight) {
        const Vec3 x = f.vertex[0] * (1 - s - u) + f.vertex[1] * s + f.vertex[2] * u;
        const Vec3 traction = source_traction(x - place.centre, f.normal) * weight;
        for (std::size_t a = 0; a < cubic::kNodes; ++a)
          nodes.add(r.nodes(t)[a], traction * cubic::evaluate(cubic::kShape[a], s, u));
      });
    }
    for (std::size_t v = 0; v < b.mesh.vertex_count(); ++v)
      field.push_back(source_field(b.mesh.vertices[v] - place.centre));
    Mode mode{place.centre, interleaved(field), interleaved(r.apply_transpose(nodes))};
    // The source exerts no force and no moment: w stays blind to rigid motions whatever the quadrature.
    std::array<Real, 6> seen{};
    for (std::size_t i = 0; i < mode.w.size(); ++i)
      for (std::size_t m = 0; m < 6; ++m) seen[m] += mode.w[i] * rigid.row(i)[m];
    for (std::size_t i = 0; i < mode.w.size(); ++i)
      for (std::size_t m = 0; m < 6; ++m) mode.w[i] -= seen[m] * rigid.coefficients_of_unit(i)[m];
    const Real energy = product(mode.w, mode.d);
    if (!(energy > 0)) continue;
    for (Real& v : mode.d) v /= energy;
    modes_.push_back(std::move(mode));
  }
}

void CavityModes::add(std::span<const Real> x, std::span<Real> y) const {
  for (const Mode& m : modes_) {
    const Real c = product(m.w, x);
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += c * m.d[i];
  }
}

void CavityModes::add_load(const Boundary& b, const Load& load, const ParticularSolution& particular, Real mu,
                           std::span<Real> out) const {
  for (const Mode& m : modes_) {
    const Real work = parallel_sum<Real>(b.panels.size(), 64, [&](std::size_t t) {
      const auto q = traction_polynomial(b, load, particular, t);
      Real sum = 0;
      integrate(b.panels[t], m.centre, kWhole, kDepth, [&](Real s, Real u, Real weight) {
        const PanelFrame& f = b.panels[t];
        const Vec3 x = f.vertex[0] * (1 - s - u) + f.vertex[1] * s + f.vertex[2] * u;
        const auto monomial = cubic::monomials(s, u);
        Vec3 traction;
        for (std::size_t k = 0; k < q.size(); ++k) traction += q[k] * monomial[k];
        sum += weight * dot(traction, source_field(x - m.centre));
      });
      return sum;
    });
    Real panels = 0;
    for (std::size_t i = 0; i < load.panels.size(); ++i) {
      const auto& c = load.panels.corners[i];
      const PanelFrame f = make_panel(c[0], c[1], c[2]);
      for (const TrianglePoint& g : kGauss7)
        panels += g.weight * f.area *
                  dot(load.panels.traction[i], source_field(c[0] * g.a + c[1] * g.b + c[2] * g.c - m.centre));
    }
    const Real beta = (work + panels) / (2 * mu);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += beta * m.d[i];
  }
}

Real CavityModes::entry(std::size_t i, std::size_t j) const {
  Real sum = 0;
  for (const Mode& m : modes_) sum += m.d[i] * m.w[j];
  return sum;
}

}  // namespace sherd
