// The subcommands of `sherd`. Each returns the exit code; InputError means 2, any other exception 1.
#pragma once
#include <filesystem>

#include "kernels/core/vec3.h"

namespace sherd {

constexpr int kSuccess = 0, kFailure = 1, kBadInput = 2, kInterrupted = 130;  // 130: as shells report SIGINT

struct CheckOptions {
  std::filesystem::path mesh;
  bool json = false;
  Real max_hole = 0;  // units of the file; 0 = 5 % of the bounding box's diagonal
};
// Prints what the mesh is, what repair did, and what it became. 2 when it cannot be repaired.
int check_command(const CheckOptions& options);

struct RunOptions {
  std::filesystem::path scene;
  std::filesystem::path out;  // empty: out/NAME for scene NAME.toml
  int threads = 0;            // 0: all processors
  int frames = 0;             // stop after so many; 0: the scene's duration
  bool render = true;
  bool quiet = false;
};
int run_command(const RunOptions& options);

// SIGINT and SIGTERM only set a flag from here on; a second one ends the program at once.
void catch_interrupts();
bool interrupted();

}  // namespace sherd
