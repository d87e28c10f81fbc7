#include "engine/mesh/certificate.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>

#include "engine/mesh/attributes.h"
#include "engine/mesh/remesh.h"
#include "engine/mesh/validate.h"

namespace sherd {
namespace {

std::string defect(std::size_t count, const char* what, const DefectPlaces& places) {
  if (places.empty()) return fmt::format("{} {}", count, what);
  return fmt::format("{} {}, first near ({:.6g}, {:.6g}, {:.6g})", count, what, places[0].x, places[0].y, places[0].z);
}

std::string first_defect(const MeshReport& r) {
  if (r.triangles == 0) return "no triangles";
  if (r.bad_indices > 0) return defect(r.bad_indices, "triangles with a vertex out of range", {});
  if (r.bad_coordinates > 0) return defect(r.bad_coordinates, "coordinates not finite", r.bad_coordinate_places);
  if (r.border_edges > 0) return defect(r.border_edges, "border edges", r.border_places);
  if (r.nonmanifold_edges > 0) return defect(r.nonmanifold_edges, "non-manifold edges", r.nonmanifold_edge_places);
  if (r.nonmanifold_vertices > 0)
    return defect(r.nonmanifold_vertices, "non-manifold vertices", r.nonmanifold_vertex_places);
  if (r.misoriented_edges > 0) return defect(r.misoriented_edges, "edges of opposite sides", r.misoriented_places);
  if (r.degenerate_triangles > 0) return defect(r.degenerate_triangles, "triangles without area", r.degenerate_places);
  if (r.self_intersections > 0)
    return defect(static_cast<std::size_t>(r.self_intersections), "pairs of triangles intersect",
                  r.self_intersection_places);
  if (r.shells_inside_out > 0) return defect(r.shells_inside_out, "shells inside out", r.inside_out_places);
  if (!(r.volume > 0)) return fmt::format("a volume of {:.6g} m^3", r.volume);
  return {};
}

std::size_t count_cavities(const SurfaceMesh& mesh) {
  std::vector<std::uint32_t> label;
  const std::uint32_t shells = label_components(mesh, label);
  const std::vector<int> side = shell_sides(mesh, label, shells);
  return static_cast<std::size_t>(std::count(side.begin(), side.end(), -1));
}

void count_angles(const SurfaceMesh& mesh, MeshCertificate& c) {
  constexpr Real kDegree = std::numbers::pi / 180;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Real angle = smallest_angle({mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)});
    c.below_1_degree += angle < kDegree, c.below_15_degrees += angle < 15 * kDegree;
  }
}

}  // namespace

MeshCertificate certify(const SurfaceMesh& mesh) {
  ReportOptions options;
  options.count_self_intersections = true;
  const MeshReport r = report_mesh(mesh, options);
  MeshCertificate c;
  const bool readable = r.triangles > 0 && r.bad_indices == 0 && r.bad_coordinates == 0;
  c.closed = readable && r.border_edges == 0;
  c.manifold = readable && r.nonmanifold_edges == 0 && r.nonmanifold_vertices == 0;
  c.oriented = c.closed && c.manifold && r.misoriented_edges == 0 && r.shells_inside_out == 0;
  c.embedded = readable && r.self_intersections == 0 && r.degenerate_triangles == 0;
  const std::string wrong_length = check_attributes(mesh);
  c.attributed = wrong_length.empty();
  c.vertices = r.vertices, c.triangles = r.triangles, c.shells = r.components, c.genus = r.genus;
  c.volume = r.volume, c.area = r.area, c.min_angle = r.min_angle;
  if (readable) count_angles(mesh, c);
  if (c.closed && c.manifold) c.cavities = count_cavities(mesh);
  c.first_defect = first_defect(r);
  if (c.first_defect.empty()) c.first_defect = wrong_length;
  return c;
}

std::string to_json(const MeshCertificate& c) {
  nlohmann::ordered_json j;
  j["ok"] = c.ok();
  j["closed"] = c.closed, j["manifold"] = c.manifold, j["oriented"] = c.oriented, j["embedded"] = c.embedded,
  j["attributed"] = c.attributed;
  j["vertices"] = c.vertices, j["triangles"] = c.triangles, j["shells"] = c.shells, j["cavities"] = c.cavities;
  j["below_1_degree"] = c.below_1_degree, j["below_15_degrees"] = c.below_15_degrees;
  j["genus"] = c.genus, j["volume"] = c.volume, j["area"] = c.area, j["min_angle"] = c.min_angle;
  j["first_defect"] = c.first_defect;
  return j.dump();
}

}  // namespace sherd
