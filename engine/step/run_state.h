// What a run is between two steps. Everything else a World holds follows from the scene; everything a Solid or a
// ContactCache builds follows from the meshes here. A checkpoint is these members, by the walk of
// kernels/core/archive.h: a member added to RunState, or to a record in it, is kept from then on.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "engine/load/earlier_loads.h"
#include "engine/load/surface_load.h"
#include "engine/rigid/step.h"
#include "engine/step/solid.h"
#include "engine/step/stats.h"
#include "kernels/core/archive.h"

namespace sherd {

// A load of the scene on a body, spread over the surface it had at the start.
struct HeldLoad {
  AppliedLoad load;
  AppliedTraction traction;
};

// Beside each body, in the same order.
struct Companion {
  static constexpr std::size_t kUnrecorded = static_cast<std::size_t>(-1);

  std::shared_ptr<Solid> solid;
  std::size_t scene_body = 0;
  std::vector<HeldLoad> loads = {};                // none once it has broken
  std::vector<bool> solved_loads = {};             // which of them acted in the last solve of this mesh
  std::size_t mesh = kUnrecorded;                  // index into RunRecord::meshes
  std::size_t last_solve = 0;                      // step, for dropping operators
  int failed_solves = 0;                           // on this mesh
  std::vector<SolvedLoad> solved = {};             // the latest contacts solved for on this mesh, without held loads
  Real last_tension = 0;                           // of the last solve of this mesh, Pa
  std::shared_ptr<const SurfaceField> field = {};  // of the body's mesh, from its last solve
};

struct RunState {
  std::vector<Body> bodies;
  std::vector<Companion> companions;
  std::vector<std::vector<bool>> guided;  // a scene body's guided cracks: which have run
  RigidState rigid_state;
  std::vector<Contact> contacts;   // of the last step
  ContactHistory contact_history;  // as of the last checkpoint
  RunRecord record;
  std::size_t steps = 0;
  std::uint32_t next_id = 0;
  std::int32_t next_crack = 0;
  std::vector<std::string> pending, pending_warnings;  // messages nobody has taken yet
  std::uint64_t prepared = 0;                          // digest of the bodies' meshes at the start
};

// Of its mesh, its cracks and what solves taught; all else is built from these when asked for.
void describe(Archive& a, std::shared_ptr<Solid>& solid);
// One of the rules of engine/mesh/thickness_resolution.h.
void describe(Archive& a, const ResolutionRule*& rule);

// Digest of a mesh: coordinates, triangles, attributes, channels.
std::uint64_t digest(const SurfaceMesh& mesh, std::uint64_t start = kDigestStart);

}  // namespace sherd
