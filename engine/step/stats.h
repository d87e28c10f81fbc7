// What a run did, as JSON. Times stand under "seconds" keys alone; all else is the same in every run of a scene.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "engine/mesh/certificate.h"
#include "engine/mesh/thickness_resolution.h"
#include "engine/rigid/energy.h"
#include "engine/rigid/step.h"
#include "engine/step/fracture_event.h"
#include "engine/step/skip_counts.h"

namespace sherd {

struct StepRecord {
  std::size_t step = 0;
  Real time = 0;  // s, at the end of the step
  std::size_t bodies = 0, asleep = 0, triangles = 0;
  std::size_t pairs_near = 0, contacts = 0, fields_built = 0;
  int contact_iterations = 0, parts = 0;  // the most of a contact problem; the step was cut into
  std::size_t unconverged = 0;            // contact problems that kept a residual above their tolerance
  Real contact_residual = 0;              // the largest, over the tolerance
  Real recovery_work = 0;                 // J, by pushing bodies out of penetration
  Energy energy;                          // after the motion, before bodies break
  Real energy_growth = 0;                 // J, that the motion added beyond recovery; negative where it was lost
  bool energy_holds = true;               // within the tolerance of energy_balance()
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
  std::size_t applied_loads = 0;  // of the scene that acted
  FractureResult result;          // shapes are emptied
  std::vector<std::uint32_t> new_bodies;
  Real mass_error = 0, momentum_error = 0, angular_error = 0;  // relative, fragments against the parent
};

// Of one mesh that was shown; made once.
struct CertificateRecord {
  std::uint32_t body_id = 0, mesh_version = 0;
  std::string body;
  MeshCertificate certificate;
};

// Of all meshes of a frame, and where the volume of the start is: before - removed - dust + remeshing = volume +
// notches but for volume_error, relative. All summed over the run, m^3.
struct FrameRecord {
  std::size_t index = 0;
  Real time = 0;
  std::vector<std::size_t> certificates;  // indices into RunRecord::certificates, one a body
  std::size_t valid = 0;                  // bodies whose certificate is ok
  Real volume = 0, removed = 0, dust = 0, remeshing = 0, notches = 0, volume_error = 0;
};

struct RunRecord {
  std::string scene, quality;      // file name; name of Scene::quality
  std::uint64_t scene_digest = 0;  // Scene::digest
  std::vector<std::string> messages;
  std::vector<MeshRecord> meshes;
  std::vector<StepRecord> steps;
  SceneSkip skip;  // which switches were on
  SkipCounts skips;
  std::vector<EventRecord> events;
  std::vector<CertificateRecord> certificates;
  std::vector<FrameRecord> frames;
  Real start_volume = 0;            // of all bodies, m^3
  std::optional<FieldScale> field;  // what the colours of the pictures mean; low = high: nothing was found yet
  Real prepare_seconds = 0, certify_seconds = 0;
  int threads = 0;

  // Index of the mesh's certificate, made when it is asked for first.
  std::size_t certificate_of(std::uint32_t body_id, std::uint32_t mesh_version, const std::string& body,
                             const SurfaceMesh& mesh);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> certified;  // body and mesh version -> that index
};

// `complete`: the run has reached the scene's duration.
std::string to_json(const RunRecord& record, bool complete);
std::string digest_text(std::uint64_t digest);  // 16 hexadecimal digits, as in stats.json

}  // namespace sherd
