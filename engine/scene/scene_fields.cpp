#include "engine/scene/scene.h"
#include "kernels/core/error.h"

namespace sherd {

MaterialFields scene_fields(const SceneBody& body, const SurfaceMesh& mesh) {
  MaterialFields fields = constant_fields(body.material, bounding_box(mesh).diagonal());
  try {
    if (body.strength) fields.strength = make_field(*body.strength, mesh, {});
    if (body.propagation_strength)
      fields.propagation_strength = make_field(*body.propagation_strength, mesh, fields.strength);
    if (body.crack_thickness) fields.crack_thickness = make_field(*body.crack_thickness, mesh, {});
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", body.name, error.what()));
  }
  fields.propagation_strength = lesser_field(fields.propagation_strength, fields.strength);
  return fields;
}

}  // namespace sherd
