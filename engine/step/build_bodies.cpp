#include "engine/step/build_bodies.h"

#include <fmt/format.h>

#include "engine/fracture/guide.h"
#include "engine/fragment/cut.h"
#include "engine/mesh/refit.h"
#include "engine/mesh/sizing.h"
#include "engine/mesh/validate.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

void remesh_to(SurfaceMesh& mesh, const SizingOptions& sizing, const std::string& name,
               std::vector<std::string>& messages) {
  const Real edge_length = sizing.edge_length;
  SurfaceMesh out;
  const RemeshReport report = remesh_graded(mesh, sizing, out);
  if (report.status != RemeshStatus::kOk) {
    messages.push_back(
        fmt::format("remeshing to {:.4g} m was refused ({}): the mesh is used as it is", edge_length, report.reason));
    return;
  }
  const MeshReport check = report_mesh(out);
  if (!is_valid(check))
    throw InputError(fmt::format("{}: remeshing gave an invalid surface:\n{}", name, to_text(check)));
  messages.push_back(fmt::format(
      "remeshed to {:.4g} m{}: {} triangles, least angle {:.1f} degrees (was {:.2g}), {} below 15 (were "
      "{}), volume changed by {:+.3f} %",
      edge_length,
      sizing.edge_per_thickness > 0 ? fmt::format(" and {:.3g} wall thicknesses", sizing.edge_per_thickness) : "",
      out.triangle_count(), report.min_angle, report.input_min_angle, report.below_15, report.input_below_15,
      100 * report.volume_change));
  mesh = std::move(out);
}

// Cuts the scene's notches, exactly, and makes the mesh fit for a solve again. They are surface like any other.
void cut_notches(SurfaceMesh& mesh, const SceneBody& s, Real edge_length, std::vector<std::string>& messages) {
  constexpr Real kMaxVolumeChange = 1e-3;
  for (std::size_t k = 0; k < s.notches.size(); ++k) {
    const SceneNotch& notch = s.notches[k];
    const auto refuse = [&](const std::string& reason) {
      throw InputError(fmt::format("body \"{}\", notch {}: {}", s.name, k + 1, reason));
    };
    const CutBody body(mesh);
    const auto wedge = notch_wedge(notch.guide, body.bvh(), notch.width, edge_length);
    if (!wedge) refuse("its plane does not enter the body's surface; move its point onto the surface or turn it");
    const Real before = body.volume();
    CutOptions o;
    o.edge_length = edge_length;
    CutResult c = cut(body, *wedge, o);
    if (!c.ok) refuse(c.reason);
    if (c.fragments.size() != 1 || c.dust_volume > 0) refuse("it cuts the body in two; make it shallower");
    if (!(c.removed_volume > 0)) refuse("it misses the body");
    const RefitReport report = refit(
        c.fragments[0],
        {.edge_length = edge_length, .edge_per_thickness = s.edge_per_thickness, .max_volume_change = kMaxVolumeChange},
        mesh);
    if (!report.ok) mesh = std::move(c.fragments[0]);
    mesh.faces.kind.assign(mesh.triangle_count(), FaceKind::kOriginal);
    mesh.faces.crack.assign(mesh.triangle_count(), -1);
    messages.push_back(fmt::format("notch {} takes {:.3g} % of the volume{}", k + 1, 100 * c.removed_volume / before,
                                   report.ok ? "" : "; remeshing was refused: " + report.reason));
  }
}

}  // namespace

BuiltBody build_body(const SceneBody& s, BodyId id) {
  BuiltBody built;
  SurfaceMesh mesh = scene_mesh(s, built.messages);
  built.edge_length = scene_edge_length(s, bounding_box(mesh).diagonal());
  const SizingOptions sizing{
      .edge_length = built.edge_length, .edge_per_thickness = s.edge_per_thickness, .merge = s.merge_features};
  if (std::holds_alternative<MeshSpec>(s.source)) {
    remesh_to(mesh, sizing, s.name, built.messages);
  } else if (const Real finest = finest_target(mesh, sizing); finest < built.edge_length) {
    // From a shape fine enough for the finest target, so that its curves are not those of coarse facets.
    mesh = make_shape(std::get<ShapeSpec>(s.source), finest);
    remesh_to(mesh, sizing, s.name, built.messages);
  }
  cut_notches(mesh, s, built.edge_length, built.messages);
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
    for (std::size_t i = 0; i < b.mesh->vertex_count(); ++i)
      box.grow(rotate(b.pose.orientation, b.mesh->vertices[i] - b.mass.centre));
    b.pose.position = s.position - Vec3{box.centre().x, box.low.y, box.centre().z};
  }
  b.velocity = s.velocity, b.angular_velocity = s.angular_velocity;
  b.fixed = s.fixed, b.breakable = s.breakable && !s.fixed;
  return built;
}

}  // namespace sherd
