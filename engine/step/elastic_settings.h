// What a scene's solver keys ask of the elastostatic stage.
#pragma once
#include "engine/elastostatic/solver.h"
#include "engine/mesh/thickness_resolution.h"
#include "engine/scene/scene.h"

namespace sherd {

ElasticOptions elastic_options(const SceneSolver& solver);
// The rule a mesh is measured by under these options.
const ResolutionRule& resolution_rule(const SceneSolver& solver);

}  // namespace sherd
