// What a run did, as JSON. Times stand under "seconds" keys alone; all else is the same in every run of a scene.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "engine/mesh/thickness_resolution.h"
#include "engine/rigid/step.h"
#include "engine/step/fracture_event.h"

namespace sherd {

struct StepRecord {
  std::size_t step = 0;
  Real time = 0;  // s, at the end of the step
  std::size_t bodies = 0, asleep = 0, triangles = 0;
  std::size_t pairs_near = 0, contacts = 0, fields_built = 0;
  int contact_iterations = 0;
  std::size_t solves = 0, solver_iterations = 0, cracks = 0, fragments = 0;  // fragments: new bodies
  std::map<std::string, std::size_t> skipped;  // reason -> bodies whose stress was not solved
  Real rigid_seconds = 0, fracture_seconds = 0;
};

// A mesh that stress was, or may be, solved on: of a breakable body at the start, of a fragment at its first solve.
struct MeshRecord {
  std::size_t step = 0;
  std::string body;
  std::uint32_t body_id = 0;
  std::size_t triangles = 0;
  const ResolutionRule* rule = nullptr;  // of the method the run uses
  ResolutionReport resolution;
  std::vector<std::string> warnings;
};

struct EventRecord {
  std::size_t step = 0;
  std::size_t mesh = 0;  // index into RunRecord::meshes
  Real time = 0;
  std::string body;
  std::uint32_t body_id = 0;
  std::vector<BodyContact> contacts;
  FractureResult result;  // shapes are emptied
  std::vector<std::uint32_t> new_bodies;
  Real mass_error = 0, momentum_error = 0, angular_error = 0;  // relative, fragments against the parent
};

struct RunRecord {
  std::string scene;
  std::vector<std::string> messages;
  std::vector<MeshRecord> meshes;
  std::vector<StepRecord> steps;
  std::vector<EventRecord> events;
  Real prepare_seconds = 0;
  int threads = 0;
};

std::string to_json(const RunRecord& record);

}  // namespace sherd
