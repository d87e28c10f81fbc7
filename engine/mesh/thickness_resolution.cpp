#include "engine/mesh/thickness_resolution.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

namespace sherd {
namespace {

constexpr Real kInfinity = std::numeric_limits<Real>::infinity();
constexpr Real kNegligible = 0.01;  // share of the area that neither warns nor decides

std::string point(const Vec3& p) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", p.x, p.y, p.z);
}

// Largest thickness that less than a hundredth of the area is below.
Real governing_thickness(const SurfaceMesh& mesh, const std::vector<Real>& thickness, Real area) {
  std::vector<std::pair<Real, Real>> walls;  // thickness, area
  for (std::size_t f = 0; f < thickness.size(); ++f)
    if (thickness[f] < kInfinity) walls.emplace_back(thickness[f], 0.5 * norm(mesh.area_normal2(f)));
  std::sort(walls.begin(), walls.end());
  Real sum = 0;
  for (const auto& [t, a] : walls)
    if ((sum += a) > kNegligible * area) return t;
  return 0;
}

// Triangles of edge h(f) = min(now, limit * T) over the surface: its integral of dA / (sqrt(3) / 4 h^2).
Real graded_triangles(const SurfaceMesh& mesh, const std::vector<Real>& edge, const WallThickness& thickness,
                      Real governing, Real limit) {
  Real sum = 0;
  for (std::size_t f = 0; f < edge.size(); ++f) {
    const Real h = std::min(edge[f], limit * std::max(thickness.face[f], governing));
    if (h > 0) sum += 0.5 * norm(mesh.area_normal2(f)) / (0.25 * std::sqrt(3.0) * h * h);
  }
  return sum;
}

void collect_shares(const SurfaceMesh& mesh, const std::vector<Real>& edge, const std::vector<Real>& thickness,
                    const ResolutionRule& rule, ResolutionReport& r) {
  r.share_above.fill(0);
  r.thinnest = kInfinity;
  for (std::size_t f = 0; f < edge.size(); ++f) {
    const Real a = 0.5 * norm(mesh.area_normal2(f)), ratio = edge[f] / thickness[f];
    r.area += a;
    if (!(thickness[f] < kInfinity)) continue;
    r.wall_share += a;
    for (std::size_t k = 0; k < kResolutionLimits.size(); ++k)
      if (ratio > kResolutionLimits[k]) r.share_above[k] += a;
    if (ratio > rule.at_5_percent) r.share_above_5_percent += a;
    if (rule.at_1_percent > 0 && ratio > rule.at_1_percent) r.share_above_1_percent += a;
    if (ratio > r.worst)
      r.worst = ratio, r.worst_place = mesh.centroid(f), r.worst_edge = edge[f], r.worst_thickness = thickness[f];
    if (thickness[f] < r.thinnest) r.thinnest = thickness[f], r.thinnest_place = mesh.centroid(f);
  }
  if (!(r.thinnest < kInfinity)) r.thinnest = 0;
  if (!(r.area > 0)) return;
  for (Real* share : {&r.wall_share, &r.share_above_5_percent, &r.share_above_1_percent}) *share /= r.area;
  for (Real& share : r.share_above) share /= r.area;
}

nlohmann::ordered_json vector_json(const Vec3& v) {
  return {v.x, v.y, v.z};
}

// A number, or null for "none".
nlohmann::ordered_json positive(Real v) {
  return v > 0 ? nlohmann::ordered_json(v) : nlohmann::ordered_json(nullptr);
}

// "edge_length = 0.003 for 5 % (9,000 triangles), 0.0013 for 1 % (...)"
std::string remedy(const ResolutionReport& r) {
  std::string text = fmt::format("edge_length = {:.3g} for 5 % (about {:.0f} triangles, {:.0f} when graded)",
                                 r.edge_for_5_percent, r.triangles_for_5_percent, r.graded_for_5_percent);
  if (r.edge_for_1_percent > 0)
    text += fmt::format(", {:.3g} for 1 % (about {:.0f}, {:.0f} when graded)", r.edge_for_1_percent,
                        r.triangles_for_1_percent, r.graded_for_1_percent);
  return text;
}

}  // namespace

ResolutionReport resolution_report(const SurfaceMesh& mesh, const WallThickness& thickness,
                                   const ResolutionRule& rule) {
  ResolutionReport r;
  const std::vector<Real> edge = local_edge_length(mesh);
  collect_shares(mesh, edge, thickness.face, rule, r);
  r.governing = governing_thickness(mesh, thickness.face, r.area);
  if (!(r.governing > 0)) return r;
  const auto uniform = [&](Real h) { return r.area / (0.25 * std::sqrt(3.0) * h * h); };
  r.edge_for_5_percent = rule.at_5_percent * r.governing;
  r.triangles_for_5_percent = uniform(r.edge_for_5_percent);
  r.graded_for_5_percent = graded_triangles(mesh, edge, thickness, r.governing, rule.at_5_percent);
  if (!(rule.at_1_percent > 0)) return r;
  r.edge_for_1_percent = rule.at_1_percent * r.governing;
  r.triangles_for_1_percent = uniform(r.edge_for_1_percent);
  r.graded_for_1_percent = graded_triangles(mesh, edge, thickness, r.governing, rule.at_1_percent);
  return r;
}

ResolutionReport resolution_report(const SurfaceMesh& mesh, const ResolutionRule& rule) {
  return resolution_report(mesh, wall_thickness(mesh), rule);
}

std::vector<std::string> resolution_warnings(const ResolutionReport& r, const ResolutionRule& rule) {
  if (!(r.share_above_5_percent > kNegligible) || !(r.edge_for_5_percent > 0)) return {};
  return {
      fmt::format("walls too thin for the mesh: on {:.3g} % of the surface the edges are longer than {:.2g} wall "
                  "thicknesses, where "
                  "bending stress errs by more than 5 % ({}); worst {:.3g} times at {}, where the wall is {:.3g} thick "
                  "and the edges "
                  "are {:.3g}. Use {}",
                  100 * r.share_above_5_percent, rule.at_5_percent, rule.method, r.worst, point(r.worst_place),
                  r.worst_thickness, r.worst_edge, remedy(r))};
}

std::string to_text(const ResolutionReport& r, const ResolutionRule& rule) {
  if (!(r.wall_share > 0)) return "  walls               none: no part has a far side that faces back\n";
  std::string text = fmt::format("  walls               {:.3g} % of the area; thinnest {:.4g} at {}\n",
                                 100 * r.wall_share, r.thinnest, point(r.thinnest_place));
  text += "  edge / thickness    ";
  for (std::size_t k = 0; k < kResolutionLimits.size(); ++k)
    text += fmt::format("{}above {:g}: {:.3g} %", k ? ", " : "", kResolutionLimits[k], 100 * r.share_above[k]);
  text += " of the area\n";
  text += fmt::format("  worst               {:.3g} at {}: edge {:.4g}, wall {:.4g}\n", r.worst, point(r.worst_place),
                      r.worst_edge, r.worst_thickness);
  if (r.edge_for_5_percent > 0)
    text += fmt::format("  stress within 5 %   edge_length = {:.4g}  ({})\n", r.edge_for_5_percent, rule.method);
  if (r.edge_for_1_percent > 0)
    text += fmt::format("  stress within 1 %   edge_length = {:.4g}\n", r.edge_for_1_percent);
  return text;
}

std::string to_json(const ResolutionReport& r, const ResolutionRule& rule) {
  nlohmann::ordered_json out, above;
  for (std::size_t k = 0; k < kResolutionLimits.size(); ++k)
    above[fmt::format("{:g}", kResolutionLimits[k])] = r.share_above[k];
  out["method"] = rule.method;
  out["limit_5_percent"] = rule.at_5_percent;
  out["limit_1_percent"] = positive(rule.at_1_percent);
  out["area"] = r.area;
  out["wall_share"] = r.wall_share;
  out["share_above"] = above;
  out["share_above_5_percent"] = r.share_above_5_percent;
  out["share_above_1_percent"] = rule.at_1_percent > 0 ? nlohmann::ordered_json(r.share_above_1_percent) : nullptr;
  out["worst"] = positive(r.worst);
  out["worst_place"] = vector_json(r.worst_place);
  out["worst_edge"] = positive(r.worst_edge);
  out["worst_thickness"] = positive(r.worst_thickness);
  out["thinnest"] = positive(r.thinnest);
  out["thinnest_place"] = vector_json(r.thinnest_place);
  out["governing"] = positive(r.governing);
  out["edge_for_5_percent"] = positive(r.edge_for_5_percent);
  out["edge_for_1_percent"] = positive(r.edge_for_1_percent);
  out["triangles_for_5_percent"] = positive(std::round(r.triangles_for_5_percent));
  out["triangles_for_1_percent"] = positive(std::round(r.triangles_for_1_percent));
  out["graded_for_5_percent"] = positive(std::round(r.graded_for_5_percent));
  out["graded_for_1_percent"] = positive(std::round(r.graded_for_1_percent));
  return out.dump();
}

}  // namespace sherd
