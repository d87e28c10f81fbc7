// Checkpoints of a run on disk: FOLDER/checkpoint/step_00000120.sherd. The last two are kept, each complete on the disk
// under its name before an older one goes, so that a run killed at any moment has one to go on from.
//
// A file is: 8 bytes "sherdrun", the byte order (u32 0x01020304), the format (u32), the identity,
// the step, the time, the states of simulation and writer (kernels/core/archive.h), and a digest of all
// bytes before it (u64).
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kernels/core/archive.h"

namespace sherd {

// What must be the same when a run goes on: its results are bit for bit those of a run that was never stopped.
struct RunIdentity {
  std::string program;      // version, build and instructions
  std::uint64_t scene = 0;  // Scene::digest
  std::string options;      // of the command line, those that change results
};

struct Checkpoint {
  RunIdentity identity;
  std::size_t step = 0;
  Real time = 0;                   // s, simulated
  std::string simulation, writer;  // Simulation::state(), RunWriter::state()
};

struct FoundCheckpoint {
  std::optional<Checkpoint> checkpoint;  // the latest that is whole
  std::vector<std::string> damaged;      // a line for each later one: file and reason
};

// Puts it on the disk, then removes all but the last two. Throws InputError naming the file that cannot be written; the
// earlier ones are then as they were.
void write_checkpoint(const std::filesystem::path& folder, const Checkpoint& checkpoint);
// Nothing when there is none. Throws InputError when there are some, but all damaged, and for one of another format or
// byte order.
FoundCheckpoint find_checkpoint(const std::filesystem::path& folder);
// Throws InputError naming what differs and the remedy.
void require_same_run(const std::filesystem::path& folder, const RunIdentity& written, const RunIdentity& now);
// With what a killed program left half-written of them.
void remove_checkpoints(const std::filesystem::path& folder);

}  // namespace sherd
