#include "engine/step/build_bodies.h"

#include <fmt/format.h>

#include "engine/mesh/load.h"
#include "engine/mesh/remesh.h"
#include "engine/mesh/repair.h"
#include "engine/mesh/validate.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

SurfaceMesh load_scaled(const MeshSpec& spec, std::vector<std::string>& messages) {
  LoadLog log;
  SurfaceMesh mesh = load_mesh(spec.file.string(), {}, log);
  messages.insert(messages.end(), log.messages.begin(), log.messages.end());
  const Box box = bounding_box(mesh);
  const Vec3 extent = box.high - box.low;
  const Real reference = spec.fit == MeshFit::kScale    ? 1
                         : spec.fit == MeshFit::kHeight ? extent.y
                                                        : std::max({extent.x, extent.y, extent.z});
  if (!(reference > 0)) throw InputError(fmt::format("{}: the mesh has no extent along y: use scale or size instead of height", spec.file.string()));
  const Real factor = spec.amount / reference;
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) mesh.vertices.set(i, mesh.vertices[i] * factor);
  RepairOptions options;
  options.name = spec.file.string();
  options.max_hole_diameter = spec.max_hole;
  repair_mesh(mesh, options, messages);
  return mesh;
}

void remesh_to(SurfaceMesh& mesh, Real edge_length, const std::string& name, std::vector<std::string>& messages) {
  RemeshOptions options;
  options.edge_length = edge_length;
  SurfaceMesh out;
  const RemeshReport report = remesh(mesh, options, out);
  if (report.status != RemeshStatus::kOk) {
    messages.push_back(fmt::format("remeshing to {:.4g} m was refused ({}): the mesh is used as it is", edge_length, report.reason));
    return;
  }
  const MeshReport check = report_mesh(out);
  if (!is_valid(check)) throw InputError(fmt::format("{}: remeshing gave an invalid surface:\n{}", name, to_text(check)));
  messages.push_back(fmt::format("remeshed to {:.4g} m: {} triangles, least angle {:.1f} degrees, volume changed by {:+.3f} %", edge_length,
                                 out.triangle_count(), report.min_angle, 100 * report.volume_change));
  mesh = std::move(out);
}

}  // namespace

BuiltBody build_body(const SceneBody& s, BodyId id) {
  BuiltBody built;
  SurfaceMesh mesh;
  if (const auto* spec = std::get_if<MeshSpec>(&s.source)) {
    mesh = load_scaled(*spec, built.messages);
    built.edge_length = s.edge_length > 0 ? s.edge_length : bounding_box(mesh).diagonal() / 40;
    remesh_to(mesh, built.edge_length, s.name, built.messages);
  } else {
    const ShapeSpec& shape = std::get<ShapeSpec>(s.source);
    built.edge_length = s.edge_length > 0 ? s.edge_length : shape_diagonal(shape) / 40;
    mesh = make_shape(shape, built.edge_length);
  }
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) mesh.faces.source[t] = static_cast<std::int32_t>(t);
  Body& b = built.body;
  b.id = b.parent = id;
  b.name = s.name;
  b.mesh = std::make_shared<SurfaceMesh>(std::move(mesh));
  b.material = s.material;
  b.density = s.material.density;
  b.mass = mass_properties(*b.mesh, b.density);
  b.pose.orientation = normalized(from_rotation_vector(s.rotation));
  b.pose.position = s.position;
  if (s.anchor == Anchor::kBase) {
    Box box;
    for (std::size_t i = 0; i < b.mesh->vertex_count(); ++i) box.grow(rotate(b.pose.orientation, b.mesh->vertices[i] - b.mass.centre));
    b.pose.position = s.position - Vec3{box.centre().x, box.low.y, box.centre().z};
  }
  b.velocity = s.velocity, b.angular_velocity = s.angular_velocity;
  b.fixed = s.fixed, b.breakable = s.breakable && !s.fixed;
  return built;
}

}  // namespace sherd
