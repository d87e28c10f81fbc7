#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "kernels/core/error.h"
#include "tools/sherd/commands.h"

namespace sherd {
namespace {

constexpr const char* kExamples = R"(Examples:
  sherd run scenes/bunny.toml --out out/bunny
  sherd run scenes/plate_and_goblet.toml --threads 1 --frames 30
  sherd check bunny.obj
  sherd check --json --max-hole 0.02 scan.ply

Exit codes: 0 success, 2 bad input (scene, mesh, option), 1 failure, 130 ended by Ctrl-C with everything so far on disk.
Scene files are described in scenes/README.md.)";

struct Choice {
  RunOptions run;
  CheckOptions check;
  bool no_render = false;
};

void add_run(CLI::App& app, Choice& choice) {
  CLI::App* run = app.add_subcommand("run", "Simulate a scene and write frames, movie, pieces and statistics");
  run->add_option("SCENE", choice.run.scene, "Scene file (TOML)")->required();
  run->add_option("--out", choice.run.out, "Folder for the results (default: out/NAME for NAME.toml)");
  run->add_option("--threads", choice.run.threads, "Threads (default: all processors); results do not depend on it")
      ->check(CLI::Range(1, 1024));
  run->add_option("--frames", choice.run.frames, "Stop after so many frames")->check(CLI::Range(1, 1000000));
  run->add_flag("--no-render", choice.no_render, "No pictures and no movie");
  run->add_flag("--quiet", choice.run.quiet, "Only errors");
}

void add_check(CLI::App& app, Choice& choice) {
  CLI::App* check = app.add_subcommand("check", "Report on a mesh file: counts, defects, and whether it can be used");
  check->add_option("MESH", choice.check.mesh, "Mesh file (OBJ, PLY, STL, glTF, 3DS)")->required();
  check->add_flag("--json", choice.check.json, "Report as JSON");
  check
      ->add_option("--max-hole", choice.check.max_hole,
                   "Fill holes up to this diameter, in the file's units (default: 5 % of the size)")
      ->check(CLI::NonNegativeNumber);
}

int run(int argc, char** argv) {
  CLI::App app("sherd: brittle fracture of rigid bodies on their surface meshes", "sherd");
  app.set_version_flag("--version", "sherd " SHERD_VERSION);
  app.require_subcommand(1);
  app.footer(kExamples);
  Choice choice;
  add_run(app, choice);
  add_check(app, choice);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kSuccess : kBadInput;
  }
  choice.run.render = !choice.no_render;
  return app.got_subcommand("check") ? check_command(choice.check) : run_command(choice.run);
}

}  // namespace
}  // namespace sherd

int main(int argc, char** argv) {
  try {
    return sherd::run(argc, argv);
  } catch (const sherd::InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return sherd::kBadInput;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "sherd: failure: %s\n", error.what());
    return sherd::kFailure;
  }
}
