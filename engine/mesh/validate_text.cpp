#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "engine/mesh/validate.h"

namespace sherd {
namespace {

std::string place_list(const DefectPlaces& places) {
  std::string text;
  for (const Vec3& p : places)
    text += fmt::format("{}({:.6g}, {:.6g}, {:.6g})", text.empty() ? "" : ", ", p.x, p.y, p.z);
  return text;
}

void defect(std::string& text, std::size_t count, const char* what, const DefectPlaces& places) {
  if (count == 0) return;
  text += fmt::format("  {} {}{}{}\n", count, what, places.empty() ? "" : ", first near ", place_list(places));
}

nlohmann::json to_array(const Vec3& p) {
  return nlohmann::json::array({p.x, p.y, p.z});
}

nlohmann::json to_array(const DefectPlaces& places) {
  nlohmann::json list = nlohmann::json::array();
  for (const Vec3& p : places) list.push_back(to_array(p));
  return list;
}

}  // namespace

std::string to_text(const MeshReport& r) {
  std::string text = fmt::format("{} vertices, {} triangles, {} component{}\n", r.vertices, r.triangles, r.components,
                                 r.components == 1 ? "" : "s");
  text +=
      fmt::format("volume {:.6g} m^3, area {:.6g} m^2, box ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})\n",
                  r.volume, r.area, r.box.low.x, r.box.low.y, r.box.low.z, r.box.high.x, r.box.high.y, r.box.high.z);
  text += fmt::format("edges {:.4g} / {:.4g} / {:.4g} m (shortest / mean / longest), smallest angle {:.3g} degrees\n",
                      r.min_edge, r.mean_edge, r.max_edge, r.min_angle);
  if (r.genus >= 0) text += fmt::format("genus {}\n", r.genus);
  text += is_valid(r) ? "valid: bounds a solid\n" : "not valid:\n";
  defect(text, r.bad_indices, "triangles with a vertex index out of range", {});
  defect(text, r.bad_coordinates, "vertices with a coordinate that is not a finite number", {});
  defect(text, r.border_edges, "border edges (holes)", r.border_places);
  defect(text, r.border_loops, "border loops", {});
  defect(text, r.nonmanifold_edges, "edges with more than two triangles", r.nonmanifold_edge_places);
  defect(text, r.nonmanifold_vertices, "vertices with more than one fan of triangles", r.nonmanifold_vertex_places);
  defect(text, r.misoriented_edges, "edges between triangles of opposite orientation", r.misoriented_places);
  defect(text, r.shells_inside_out, "shells inside out", r.inside_out_places);
  defect(text, r.degenerate_triangles, "triangles without area", r.degenerate_places);
  defect(text, r.needle_triangles, "needle triangles", r.needle_places);
  defect(text, r.unused_vertices, "vertices in no triangle", {});
  if (r.self_intersections > 0)
    defect(text, static_cast<std::size_t>(r.self_intersections), "pairs of triangles intersect",
           r.self_intersection_places);
  if (r.triangles == 0) text += "  no triangles\n";
  return text;
}

std::string to_json(const MeshReport& r) {
  nlohmann::ordered_json j;
  j["valid"] = is_valid(r);
  j["vertices"] = r.vertices, j["triangles"] = r.triangles, j["unused_vertices"] = r.unused_vertices;
  j["components"] = r.components, j["genus"] = r.genus;
  j["border_edges"] = r.border_edges, j["border_loops"] = r.border_loops;
  j["nonmanifold_edges"] = r.nonmanifold_edges, j["nonmanifold_vertices"] = r.nonmanifold_vertices;
  j["misoriented_edges"] = r.misoriented_edges, j["shells_inside_out"] = r.shells_inside_out;
  j["degenerate_triangles"] = r.degenerate_triangles, j["needle_triangles"] = r.needle_triangles;
  j["self_intersections"] = r.self_intersections;
  j["bad_indices"] = r.bad_indices, j["bad_coordinates"] = r.bad_coordinates;
  j["volume"] = r.volume, j["area"] = r.area;
  const bool boxed = r.box.low.x <= r.box.high.x;
  j["box"] = boxed ? nlohmann::json::array({to_array(r.box.low), to_array(r.box.high)}) : nlohmann::json();
  j["min_edge"] = r.min_edge, j["mean_edge"] = r.mean_edge, j["max_edge"] = r.max_edge, j["min_angle"] = r.min_angle;
  j["places"] = {{"border_edges", to_array(r.border_places)},
                 {"nonmanifold_edges", to_array(r.nonmanifold_edge_places)},
                 {"nonmanifold_vertices", to_array(r.nonmanifold_vertex_places)},
                 {"misoriented_edges", to_array(r.misoriented_places)},
                 {"shells_inside_out", to_array(r.inside_out_places)},
                 {"self_intersections", to_array(r.self_intersection_places)},
                 {"degenerate_triangles", to_array(r.degenerate_places)},
                 {"needle_triangles", to_array(r.needle_places)}};
  return j.dump(2);
}

}  // namespace sherd
