// A field painted on the mesh.
#pragma once
#include "engine/material/field_spec.h"

namespace sherd {

// Throws InputError when the mesh has no channel of that name; the first component of one with several counts.
ScalarFieldPtr attribute_field(const AttributeSpec& spec, const SurfaceMesh& mesh);

}  // namespace sherd
