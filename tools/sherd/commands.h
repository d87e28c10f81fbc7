// The subcommands of `sherd`. Each returns the exit code; InputError means 2, any other exception 1.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/scene.h"
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

// One of them is positive, or none: no checkpoints but at the end of a run that is interrupted.
struct CheckpointEvery {
  std::size_t steps = 0;
  Real seconds = 0;  // simulated
  bool wanted() const { return steps > 0 || seconds > 0; }
};

struct RunOptions {
  std::filesystem::path scene;
  std::filesystem::path out;       // empty: out/NAME for scene NAME.toml
  std::optional<Quality> quality;  // nothing: the scene's
  std::optional<FieldKind> field;  // shown instead of the scene's
  std::filesystem::path trace;     // what ran when, Chrome's trace format; empty: none
  int threads = 0;                 // 0: all processors
  int frames = 0;                  // stop after so many; 0: the scene's duration
  bool render = true;
  bool wireframe = false;            // edges of the triangles over the bodies, in every picture
  std::vector<std::string> no_skip;  // keys of [skip] to turn off; "all": every one
  bool quiet = false;
  CheckpointEvery checkpoint_every;
  bool resume = false;  // go on from the last checkpoint in `out`
};
int run_command(const RunOptions& options);
// "20": steps, "0.1s": simulated time. InputError for anything else.
CheckpointEvery parse_checkpoint_every(const std::string& text);

struct StressOptions {
  std::filesystem::path mesh;
  std::filesystem::path tractions;  // CSV: face,tx,ty,tz (Pa); faces left out carry none
  std::filesystem::path points;     // CSV: x,y,z and optionally face (-1 inside) and id
  std::filesystem::path out;        // CSV: id,max_principal,sxx,syy,szz,sxy,syz,szx (Pa)
  std::filesystem::path json;       // statistics; empty: none
  Real young = 0, poisson = 0;      // Pa, 1
  std::string body_force;           // "bx,by,bz[,wx,wy,wz]", N/m^3; empty: none
  std::string formulation = "direct";
  int refine = 0;
  Real feature_angle = 35;  // degrees
  Real tolerance = 1e-4;
  int threads = 0;  // 0: all processors
};
// Stress at points of the solids that a mesh bounds (engine/stress/analysis.h). 1 when the solver fails; the statistics
// then say why, and the table is not written.
int stress_command(const StressOptions& options);

// SIGINT and SIGTERM only set a flag from here on; a second one ends the program at once. A limit on file sizes is an
// error of the write that meets it, no longer a signal.
void catch_interrupts();
bool interrupted();

}  // namespace sherd
