#include <algorithm>

#include "engine/mesh/repair.h"
#include "engine/mesh/validate.h"
#include "engine/scene/scene.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

Real fit_scale(const MeshSpec& spec, const SurfaceMesh& mesh) {
  if (spec.fit == MeshFit::kScale) return spec.amount;
  const Box box = bounding_box(mesh);
  const Vec3 extent = box.high - box.low;
  const bool height = spec.fit == MeshFit::kHeight;
  const Real length = height ? extent.y : std::max({extent.x, extent.y, extent.z});
  if (!(length > 0))
    throw InputError(fmt::format("{}: has no {} to fit to {} m; use scale, or another up axis", spec.file.string(),
                                 height ? "height" : "size", spec.amount));
  return spec.amount / length;
}

// Metres per unit of the body's file.
Real file_scale(const MeshSpec& spec) {
  if (spec.fit == MeshFit::kScale) return spec.amount;
  LoadLog log;
  return fit_scale(spec, load_mesh(spec.file.string(), {.scale = 1, .up = spec.up}, log));
}

SurfaceMesh file_mesh(const MeshSpec& spec, std::vector<std::string>& messages) {
  LoadLog log;
  SurfaceMesh mesh = load_mesh(spec.file.string(), {.scale = 1, .up = spec.up}, log);
  messages.insert(messages.end(), log.messages.begin(), log.messages.end());
  const Real scale = fit_scale(spec, mesh);
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) mesh.vertices.set(i, mesh.vertices[i] * scale);
  repair_mesh(mesh, {.name = spec.file.string(), .max_hole_diameter = spec.max_hole}, messages);
  return mesh;
}

}  // namespace

SurfaceMesh scene_mesh(const SceneBody& body, std::vector<std::string>& messages) {
  if (const auto* file = std::get_if<MeshSpec>(&body.source)) return file_mesh(*file, messages);
  const ShapeSpec& shape = std::get<ShapeSpec>(body.source);
  return make_shape(shape, scene_edge_length(body, shape_diagonal(shape)));
}

GuideSpec scene_guide(const SceneBody& body, const SceneCrack& crack, std::vector<std::string>& messages) {
  if (const auto* plane = std::get_if<GuidePlane>(&crack.guide)) return *plane;
  if (const auto* line = std::get_if<GuidePolyline>(&crack.guide)) return *line;
  const std::string file = std::get<std::filesystem::path>(crack.guide).string();
  const auto* spec = std::get_if<MeshSpec>(&body.source);
  LoadLog log;
  SurfaceMesh guide = load_mesh(file, {.scale = spec ? file_scale(*spec) : 1, .up = spec ? spec->up : UpAxis::kY}, log);
  messages.insert(messages.end(), log.messages.begin(), log.messages.end());
  const MeshReport report = report_mesh(guide);
  if (report.nonmanifold_edges + report.misoriented_edges + report.degenerate_triangles > 0)
    throw InputError(
        fmt::format("{}: cannot guide a crack: {} edges with more than two triangles, {} with neighbours that face "
                    "opposite ways, {} "
                    "triangles without area; make it one consistently oriented surface without them",
                    file, report.nonmanifold_edges, report.misoriented_edges, report.degenerate_triangles));
  return guide;
}

Real scene_edge_length(const SceneBody& body, Real diagonal) {
  return body.edge_factor * (body.edge_length > 0 ? body.edge_length : kDefaultEdge * diagonal);
}

}  // namespace sherd
