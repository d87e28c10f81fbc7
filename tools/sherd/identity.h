// What must be the same for a run to go on from a checkpoint, beside the scene.
#pragma once
#include <string>

#include "tools/sherd/commands.h"

namespace sherd {

// Version, build (a digest of this program's file) and the instructions it computes with here: what decides the last
// bits of results.
std::string program_identity();
// Of the command line, what changes results: not threads, folder or how far to run.
std::string options_identity(const RunOptions& options);

}  // namespace sherd
