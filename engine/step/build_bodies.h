// Scene bodies to bodies: load or generate, scale, repair, remesh, place. The paper pre-processes all meshes this way.
#pragma once
#include <string>
#include <vector>

#include "engine/body/body.h"
#include "engine/scene/scene.h"
#include "engine/step/solid.h"

namespace sherd {

struct BuiltBody {
  Body body;
  Real edge_length = 0;               // h used, m
  std::vector<std::string> messages;  // what was done to the mesh
};

// Throws InputError naming the scene body and the file when a mesh cannot be used.
BuiltBody build_body(const SceneBody& scene_body, BodyId id);

}  // namespace sherd
