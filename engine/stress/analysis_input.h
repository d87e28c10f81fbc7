// What an analysis does before it solves: checks, refinement, loads in balance.
#pragma once
#include <string>
#include <vector>

#include "engine/stress/analysis.h"

namespace sherd {

// InputError with `name` first unless the mesh bounds solids (see Analysis).
void require_solids(const SurfaceMesh& mesh, const std::string& name);
void require_material(const Elastic& material, const std::string& name);
void require_options(const AnalysisOptions& options);

// Every triangle in four, `levels` times: the same polyhedron. Triangle t becomes 4^levels t ... 4^levels (t + 1) - 1.
SurfaceMesh split_triangles(const SurfaceMesh& mesh, int levels);

// Net force and moment of tractions (per triangle) and body force go to `report`; the body force returned is the one
// given plus the rigid-motion field that balances them.
BodyForce balanced_force(const SurfaceMesh& solid, const Vec3Column& traction, const BodyForce& force,
                         SolidReport& report);

}  // namespace sherd
