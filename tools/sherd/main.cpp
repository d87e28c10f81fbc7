#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <map>

#include "engine/scene/skip.h"
#include "kernels/core/error.h"
#include "tools/sherd/commands.h"

namespace sherd {
namespace {

constexpr const char* kExamples = R"(Examples:
  sherd run scenes/bunny.toml --out out/bunny
  sherd run scenes/plate_and_goblet.toml --threads 1 --frames 30
  sherd run scenes/bunny.toml --checkpoint-every 50   (again, after a stop, with --resume)
  sherd run scenes/dinner_table.toml --quality preview
  sherd check bunny.obj
  sherd check --json --max-hole 0.02 scan.ply
  sherd stress bar.ply --traction t.csv --young 7e10 --poisson 0.2 --points p.csv --out stress.csv --json stats.json

Exit codes: 0 success, 2 bad input (scene, mesh, option) or output that cannot be written, 1 failure, 130 ended by
Ctrl-C with everything so far on disk.
Scene files are described in scenes/README.md.)";

struct Choice {
  RunOptions run;
  CheckOptions check;
  StressOptions stress;
  bool no_render = false;
  std::string checkpoint_every;
};

// Words of a list in the order of an enumeration.
template <class E, std::size_t N>
std::map<std::string, E> by_name(const std::array<std::string_view, N>& names) {
  std::map<std::string, E> map;
  for (std::size_t i = 0; i < N; ++i) map[std::string(names[i])] = static_cast<E>(i);
  return map;
}

void add_run(CLI::App& app, Choice& choice) {
  CLI::App* run = app.add_subcommand("run", "Simulate a scene and write frames, movie, pieces and statistics");
  run->add_option("SCENE", choice.run.scene, "Scene file (TOML)")->required();
  run->add_option("--out", choice.run.out, "Folder for the results (default: out/NAME for NAME.toml)");
  run->add_option("--quality", choice.run.quality, "preview, default or fine (default: what the scene says)")
      ->transform(CLI::CheckedTransformer(by_name<Quality>(kQualityNames)));
  run->add_option("--field", choice.run.field, "Colour bodies by displacement, strain_energy or max_principal")
      ->transform(CLI::CheckedTransformer(by_name<FieldKind>(kFieldNames)));
  run->add_option("--threads", choice.run.threads, "Threads (default: all processors); results do not depend on it")
      ->check(CLI::Range(1, 1024));
  run->add_option("--frames", choice.run.frames, "Stop after so many frames")->check(CLI::Range(1, 1000000));
  run->add_flag("--no-render", choice.no_render, "No pictures and no movie");
  run->add_flag("--wireframe", choice.run.wireframe, "Draw the edges of the triangles over the bodies");
  run->add_option("--trace", choice.run.trace, "File for what ran when on which thread (for ui.perfetto.dev)");
  std::vector<std::string> skips{"all"};
  for (const SkipSwitch& s : kSkipSwitches) skips.emplace_back(s.key);
  run->add_option("--no-skip", choice.run.no_skip,
                  "Do work that the scene does not need: keys of [skip], or all; to see what skipping saves")
      ->delimiter(',')
      ->check(CLI::IsMember(skips));
  run->add_option("--checkpoint-every", choice.checkpoint_every,
                  "Keep what --resume needs: every so many steps (20), or so much simulated time (0.1s)");
  run->add_flag("--resume", choice.run.resume,
                "Go on from the last checkpoint in --out; from the start when there is none yet");
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

void add_stress(CLI::App& app, StressOptions& o) {
  CLI::App* stress = app.add_subcommand("stress", "Stress in the solids a mesh bounds, under tractions and body force");
  stress->add_option("MESH", o.mesh, "Closed mesh (PLY, OBJ, OFF, STL); faces count from 0 in file order")->required();
  stress->add_option("--traction", o.tractions, "CSV face,tx,ty,tz: traction on each face, Pa; faces left out are free")
      ->required();
  stress->add_option("--young", o.young, "Young's modulus, Pa")->required();
  stress->add_option("--poisson", o.poisson, "Poisson's ratio, above -1 and below 0.5")->required();
  stress->add_option("--body-force", o.body_force, "bx,by,bz[,wx,wy,wz]: body force b + w cross x, N/m^3");
  stress->add_option("--points", o.points, "CSV x,y,z[,face][,id]: where; face is the one a point lies on, -1 inside")
      ->required();
  stress->add_option("--out", o.out, "CSV id,max_principal,sxx,syy,szz,sxy,syz,szx, Pa, tension positive")->required();
  stress->add_option("--formulation", o.formulation, "direct, or indirect (the paper's, for comparison)")
      ->check(CLI::IsMember({"direct", "indirect"}))
      ->capture_default_str();
  stress->add_option("--refine", o.refine, "Split every triangle into 4^L of the same plane")->capture_default_str();
  stress->add_option("--feature-angle", o.feature_angle, "Edges that turn more, in degrees, are creases; 0: all are")
      ->capture_default_str();
  stress->add_option("--tolerance", o.tolerance, "Relative, of the stress; the solver works to a hundredth of it")
      ->capture_default_str();
  stress->add_option("--threads", o.threads, "Threads (default: all processors); results do not depend on it")
      ->check(CLI::Range(1, 1024));
  stress->add_option("--json", o.json, "Statistics as JSON: unknowns, iterations, residuals, times, warnings");
}

int run(int argc, char** argv) {
  CLI::App app("sherd: brittle fracture of rigid bodies on their surface meshes", "sherd");
  app.set_version_flag("--version", "sherd " SHERD_VERSION);
  app.require_subcommand(1);
  app.footer(kExamples);
  Choice choice;
  add_run(app, choice);
  add_check(app, choice);
  add_stress(app, choice.stress);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kSuccess : kBadInput;
  }
  choice.run.render = !choice.no_render;
  if (!choice.checkpoint_every.empty()) choice.run.checkpoint_every = parse_checkpoint_every(choice.checkpoint_every);
  if (app.got_subcommand("stress")) return stress_command(choice.stress);
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
