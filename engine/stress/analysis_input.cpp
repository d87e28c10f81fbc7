#include "engine/stress/analysis_input.h"

#include <algorithm>

#include "engine/body/mass.h"
#include "engine/mesh/attributes.h"
#include "engine/mesh/intersections.h"
#include "engine/mesh/validate.h"
#include "engine/mesh/validate_edges.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

constexpr Real kLargestPoisson = 0.4999;  // beyond, 1 / (1 - 2 nu) takes more digits than the quadratures give
constexpr int kDeepestRefine = 6;

std::string place(const std::vector<Vec3>& places) {
  return places.empty()
             ? std::string()
             : fmt::format(", the first near ({:.6g}, {:.6g}, {:.6g})", places[0].x, places[0].y, places[0].z);
}

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
  throw InputError(fmt::format("{}: {}", name, what));
}

void require_surface(const MeshReport& r, const std::string& name) {
  if (r.triangles == 0) refuse(name, "the mesh is empty; it needs a closed surface");
  if (r.bad_indices > 0) refuse(name, fmt::format("{} triangles use vertices that do not exist", r.bad_indices));
  if (r.bad_coordinates > 0)
    refuse(name, fmt::format("{} vertices have coordinates that are not finite", r.bad_coordinates));
  if (r.border_edges > 0)
    refuse(name, fmt::format("the surface is open: {} border edges{}; it bounds no solid, close it first",
                             r.border_edges, place(r.border_places)));
  if (r.nonmanifold_edges > 0)
    refuse(name, fmt::format("{} edges belong to more than two triangles{}; separate the surfaces that meet there",
                             r.nonmanifold_edges, place(r.nonmanifold_edge_places)));
  if (r.nonmanifold_vertices > 0)
    refuse(name, fmt::format("{} vertices join surfaces at a point{}; give each surface its own vertex",
                             r.nonmanifold_vertices, place(r.nonmanifold_vertex_places)));
  if (r.misoriented_edges > 0)
    refuse(name, fmt::format("neighbouring triangles are oriented against each other at {} edges{}; orient them alike",
                             r.misoriented_edges, place(r.misoriented_places)));
}

void require_areas(const SurfaceMesh& mesh, const MeshReport& r, const std::string& name) {
  if (r.degenerate_triangles == 0) return;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    if (triangle_shape(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)) < kDegenerateShape)
      refuse(name,
             fmt::format("{} triangles have no area, the first is face {}; remove them (collapse or flip an edge)",
                         r.degenerate_triangles, t));
}

// Which of the possible mistakes a shell turned against its depth of nesting is.
void require_sides(const SurfaceMesh& mesh, const std::string& name) {
  std::vector<std::uint32_t> label;
  const std::uint32_t components = label_components(mesh, label);
  const std::vector<int> side = shell_sides(mesh, label, components);
  const Vec3 o = bounding_box(mesh).centre();
  std::vector<Real> volume6(components, 0.0);
  std::vector<std::size_t> first(components, mesh.triangle_count());
  for (std::size_t t = mesh.triangle_count(); t-- > 0;) {
    volume6[label[t]] += dot(mesh.corner(t, 0) - o, cross(mesh.corner(t, 1) - o, mesh.corner(t, 2) - o));
    first[label[t]] = t;
  }
  for (std::uint32_t c = 0; c < components; ++c) {
    if (side[c] * volume6[c] > 0) continue;
    if (volume6[c] == 0) refuse(name, fmt::format("the closed surface of face {} encloses no volume", first[c]));
    if (side[c] < 0)
      refuse(name, fmt::format("the closed surface of face {} lies inside another solid but is oriented outwards; turn "
                               "its triangles if it is a cavity, remove it if not",
                               first[c]));
    refuse(name,
           fmt::format("the closed surface of face {} is oriented inwards: a solid turned inside out, or a cavity "
                       "that lies in no solid; turn its triangles",
                       first[c]));
  }
}

}  // namespace

void require_solids(const SurfaceMesh& mesh, const std::string& name) {
  const MeshReport r = report_mesh(mesh);
  require_surface(r, name);
  require_areas(mesh, r, name);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  const std::size_t crossings = count_self_intersections(mesh, 1000, &pairs);
  if (crossings > 0)
    refuse(name, fmt::format("the surface touches or crosses itself in {}{} pairs of triangles, the first are faces {} "
                             "and {}; solids that touch belong in files of their own",
                             crossings, crossings == 1000 ? " or more" : "", pairs[0].first, pairs[0].second));
  require_sides(mesh, name);
}

void require_material(const Elastic& m, const std::string& name) {
  if (!(m.nu > -1 && m.nu < kLargestPoisson))
    refuse(name, fmt::format("Poisson's ratio {} is not allowed: it must lie above -1 and below {} (0.5, an "
                             "incompressible material, needs another formulation)",
                             m.nu, kLargestPoisson));
  if (!(m.mu > 0) || !std::isfinite(m.mu))
    refuse(name, fmt::format("the elastic modulus must be positive and finite, its shear modulus is {} Pa", m.mu));
}

void require_options(const AnalysisOptions& o) {
  if (o.refine < 0 || o.refine > kDeepestRefine)
    refuse(o.name, fmt::format("refine {} is not allowed; 0 to {}", o.refine, kDeepestRefine));
  if (!(o.feature_angle >= 0 && o.feature_angle <= 180))
    refuse(o.name, fmt::format("a feature angle of {} degrees is not allowed; 0 to 180", o.feature_angle));
  if (!(o.tolerance >= 1e-10 && o.tolerance <= 0.1))
    refuse(o.name, fmt::format("a tolerance of {} is not allowed; 1e-10 to 0.1", o.tolerance));
}

SurfaceMesh split_triangles(const SurfaceMesh& mesh, int levels) {
  SurfaceMesh out = mesh;
  for (int level = 0; level < levels; ++level) {
    SurfaceMesh fine;
    fine.vertices = out.vertices;
    std::vector<std::uint32_t> middle(3 * out.triangle_count(), kNone);
    const std::vector<EdgeUse> uses = sorted_edge_uses(out);
    for (std::size_t i = 0, j; i < uses.size(); i = j) {
      j = edge_end(uses, i);
      for (std::size_t k = i; k < j; ++k) middle[uses[k].half_edge] = static_cast<std::uint32_t>(fine.vertex_count());
      fine.vertices.push_back(0.5 * (out.vertices[uses[i].low] + out.vertices[uses[i].high]));
    }
    fine.triangles.reserve(4 * out.triangle_count());
    match_channels(out, fine);
    for (std::uint32_t t = 0; t < out.triangle_count(); ++t) {
      const auto [a, b, c] = out.triangles[t];
      const std::uint32_t ab = middle[3 * t], bc = middle[3 * t + 1], ca = middle[3 * t + 2];
      for (const Triangle& child :
           {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}}) {
        fine.triangles.push_back(child);
        fine.faces.push_back_from(out.faces, t);
        interpolate_corners(out, t, {fine.vertices[child[0]], fine.vertices[child[1]], fine.vertices[child[2]]}, fine);
      }
    }
    out = std::move(fine);
  }
  return out;
}

BodyForce balanced_force(const SurfaceMesh& solid, const Vec3Column& traction, const BodyForce& force,
                         SolidReport& report) {
  const MassProperties mass = mass_properties(solid, 1);
  const Real volume = mass.volume;
  const Mat3 second = Mat3::identity() * (0.5 * trace(mass.inertia)) - mass.inertia;  // int r r^T dV, r from the centre
  BodyForce out{force.constant + force.linear * (mass.centre - force.origin), force.linear, mass.centre};
  Vec3 net = out.constant * volume, moment;
  const Mat3 turning = second * transpose(out.linear);  // int r_j b_k dV
  moment = {turning[1][2] - turning[2][1], turning[2][0] - turning[0][2], turning[0][1] - turning[1][0]};
  // Cauchy-Schwarz bounds the integral of |linear r|.
  Real scale = norm(out.constant) * volume +
               std::sqrt(volume * std::max(0.0, trace(out.linear * second * transpose(out.linear))));
  for (std::size_t t = 0; t < traction.size(); ++t) {
    const Vec3 f = traction[t] * (0.5 * norm(solid.area_normal2(t)));
    net += f, moment += cross(solid.centroid(t) - mass.centre, f), scale += norm(f);
  }
  const Real radius = 0.5 * bounding_box(solid).diagonal();
  report.volume = volume, report.area = surface_area(solid);
  report.net_force = net, report.net_moment = moment;
  report.force_residual = scale > 0 ? norm(net) / scale : 0;
  report.moment_residual = scale > 0 ? norm(moment) / (scale * radius) : 0;
  // Rounding of the sums: adding a field against it would only cost a particular solution.
  if (std::max(report.force_residual, report.moment_residual) < 1e-13) return force;
  out.constant -= net / volume;
  out.linear += cross_matrix(inverse(mass.inertia) * moment) * -1.0;
  return out;
}

}  // namespace sherd
