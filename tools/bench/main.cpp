// sherd-bench: speed and accuracy, never correctness (the tests have that). Subcommands so that each study keeps its
// own options.
#include <benchmark/benchmark.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "engine/scene/skip.h"
#include "kernels/core/error.h"
#include "kernels/core/parallel.h"
#include "tools/bench/cracks.h"
#include "tools/bench/fmm.h"
#include "tools/bench/fuzz.h"
#include "tools/bench/pairs.h"
#include "tools/bench/scenes.h"
#include "tools/bench/solve.h"
#include "tools/bench/stress.h"

namespace {

struct StressCommand {
  sherd::bench::StressOptions options;
  std::string formulation = "both", testing = "auto";
  int threads = 0, degree = 0;
  double gigabytes = 6;
};

CLI::App* add_stress(CLI::App& app, StressCommand& c) {
  using sherd::bench::Study;
  CLI::App* stress = app.add_subcommand("stress", "error of the stress against exact solutions, and its cost");
  static const std::map<std::string, Study> studies{{"table", Study::kTable},
                                                    {"interior", Study::kInterior},
                                                    {"iterations", Study::kIterations},
                                                    {"vessels", Study::kVessels}};
  stress->add_option(
      "--case", c.options.cases, "exact cases (default all): " + [] {
        std::string names;
        for (const auto& f : sherd::exact::case_families())
          names += std::string(names.empty() ? "" : ", ") + std::string(f.name);
        return names;
      }());
  stress
      ->add_option("--study", c.options.studies,
                   "table, interior, iterations, vessels (default all; table with --case)")
      ->transform(CLI::CheckedTransformer(studies));
  stress->add_option("--formulation", c.formulation)
      ->check(CLI::IsMember({"direct", "indirect", "both"}))
      ->capture_default_str();
  stress->add_option("--testing", c.testing, "rows of the direct formulation")
      ->check(CLI::IsMember({"collocation", "auto", "galerkin"}))
      ->capture_default_str();
  stress->add_option("--thin-ratio", c.options.solve.elastic.thin_ratio, "edge / wall beyond which auto means galerkin")
      ->capture_default_str();
  stress->add_option("--tolerance", c.options.solve.elastic.krylov.tolerance, "of the linear solver")
      ->capture_default_str();
  stress->add_option("--degree", c.degree, "of the stress recovery, 1 to 4; 0: the library's choice")
      ->check(CLI::Range(0, 4));
  stress
      ->add_option("--vessel-factor", c.options.vessel_factor,
                   "edges of the vessels' reference are this many times shorter")
      ->check(CLI::Range(2, 8))
      ->capture_default_str();
  stress->add_option("--gigabytes", c.gigabytes, "largest dense operator")->capture_default_str();
  stress->add_option("--json", c.options.json, "file for the numbers");
  stress->add_option("--plots", c.options.plots, "folder for one SVG a case: run time against error");
  stress->add_option("--threads", c.threads, "0: all")->check(CLI::NonNegativeNumber);
  stress->footer("Examples:\n  sherd-bench stress\n  sherd-bench stress --case cavity --json out.json --plots .");
  return stress;
}

int run_stress(StressCommand& c) {
  sherd::bench::StressOptions& o = c.options;
  const sherd::ThreadLimit limit(c.threads);
  o.direct = c.formulation != "indirect", o.indirect = c.formulation != "direct";
  o.solve.elastic.max_bytes = static_cast<std::size_t>(c.gigabytes * (1 << 30));
  o.solve.elastic.testing = c.testing == "auto"       ? sherd::TestingRule::kAuto
                            : c.testing == "galerkin" ? sherd::TestingRule::kGalerkin
                                                      : sherd::TestingRule::kCollocation;
  if (c.degree > 0) o.solve.recovery.fit = {c.degree, c.degree};
  if (!o.cases.empty() && o.studies.empty()) o.studies = {sherd::bench::Study::kTable};
  try {
    return sherd::bench::run_stress(o);
  } catch (const sherd::InputError& e) {
    std::fprintf(stderr, "sherd-bench: %s\n", e.what());
    return 2;
  }
}

CLI::App* add_pairs(CLI::App& app, sherd::bench::PairsOptions& o) {
  CLI::App* pairs = app.add_subcommand("pairs", "pairs a second of the sums over pairs of points");
  pairs->add_option("--targets", o.targets, "of a block")->check(CLI::PositiveNumber)->capture_default_str();
  pairs->add_option("--sources", o.sources, "of a block")->check(CLI::PositiveNumber)->capture_default_str();
  pairs->add_option("--seconds", o.seconds, "CPU time a measurement")
      ->check(CLI::Range(1e-4, 10.0))
      ->capture_default_str();
  pairs->add_option("--json", o.json, "file for the numbers");
  pairs->footer("Examples:\n  sherd-bench pairs\n  sherd-bench pairs --targets 64 --sources 1000 --json out.json");
  return pairs;
}

CLI::App* add_fmm(CLI::App& app, sherd::bench::FmmOptions& o) {
  CLI::App* fmm = app.add_subcommand("fmm", "time and error of the fast multipole method; without options a report");
  fmm->add_option("--points", o.points, "CSV file with columns x, y, z");
  fmm->add_option("--mesh", o.mesh, "mesh file: its vertices");
  fmm->add_option("--surface", o.surfaces, "sphere:N or cube:N (points throughout the cube), at random");
  fmm->add_option("--kernel", o.kernels)->check(CLI::IsMember(sherd::bench::fmm_kernels()));
  fmm->add_option("--tolerance", o.tolerances, "relative L2 error, 1e-9 .. 1e-2")->check(CLI::PositiveNumber);
  fmm->add_option("--precision", o.precisions, "mixed: expansions in float, near field in double")
      ->check(CLI::IsMember({"float", "mixed", "double"}));
  fmm->add_option("--threads", o.threads)->check(CLI::Range(1, 4096));
  fmm->add_option("--scheme", o.schemes, "rbf-sphere is the paper's")
      ->check(CLI::IsMember({"default", "rbf-sphere", "direct"}));
  fmm->add_option("--leaf", o.leaf, "most points of a leaf; 0: by the cost model")->capture_default_str();
  fmm->add_option("--applies", o.applies, "at least; the median counts")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  fmm->add_option("--gigabytes", o.gigabytes, "largest plan")->check(CLI::PositiveNumber)->capture_default_str();
  fmm->add_flag("--large", o.large, "report: 3.6 million points too");
  fmm->add_option("--json", o.json, "file for the numbers");
  fmm->add_option("--trace", o.trace, "file for the tasks of one application, for Perfetto");
  fmm->footer(
      "Several values of an option make several rows.\nExamples:\n  sherd-bench fmm\n  sherd-bench fmm --surface "
      "sphere:1000000 --precision float double --threads 1 2 --trace trace.json");
  return fmm;
}

struct SolveCommand {
  sherd::bench::SolveBenchOptions options;
  int threads = 0;
};

CLI::App* add_solve(CLI::App& app, SolveCommand& c) {
  CLI::App* solve = app.add_subcommand("solve", "whole elastostatic solves against an exact solution, by size");
  solve->add_option("--triangles", c.options.triangles, "about so many")->check(CLI::Range(100, 4000000));
  solve->add_option("--operator", c.options.operators)->check(CLI::IsMember({"auto", "dense", "fast"}));
  solve->add_option("--tolerance", c.options.tolerance, "of the linear solver")->capture_default_str();
  solve->add_option("--gigabytes", c.options.gigabytes, "largest operator")->capture_default_str();
  solve->add_option("--threads", c.threads, "0: all")->check(CLI::NonNegativeNumber);
  solve->add_option("--json", c.options.json, "file for the numbers");
  solve->footer(
      "Several values of an option make several rows. A million triangles take 11 GB and some minutes.\nExamples:\n  "
      "sherd-bench solve --triangles 5000 --operator dense fast\n  sherd-bench solve --triangles 20000 100000 1000000");
  return solve;
}

struct CracksCommand {
  sherd::bench::CracksOptions options;
  int threads = 0;
};

CLI::App* add_cracks(CLI::App& app, CracksCommand& c) {
  using namespace sherd::campaign;
  static const std::map<std::string, FieldKind> fields = [] {
    std::map<std::string, FieldKind> names;
    for (const FieldKind kind : all_fields()) names[to_string(kind)] = kind;
    return names;
  }();
  CLI::App* cracks = app.add_subcommand("cracks", "many random cracks, grown, cut and checked; fixed seeds");
  CampaignOptions& o = c.options.campaign;
  cracks->add_option("--shapes", c.options.shapes, "default: all")->check(CLI::IsMember(specimen_names()));
  cracks->add_option("--fields", o.fields, "constant, rotating, noise (default: all)")
      ->transform(CLI::CheckedTransformer(fields));
  cracks->add_option("--count", o.count, "cracks a shape and field")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  cracks->add_option("--first", o.first, "number of the first")->capture_default_str();
  cracks->add_option("--seed", o.seed)->capture_default_str();
  cracks->add_option("--noise", o.noise, "amplitude")->check(CLI::NonNegativeNumber)->capture_default_str();
  cracks->add_option("--rotation", o.rotation, "rad per diagonal")->capture_default_str();
  cracks->add_option("--thickness", o.thickness, "of the diagonal")->check(CLI::PositiveNumber)->capture_default_str();
  cracks->add_option("--meshes", c.options.meshes, "folder of the statues; absent ones are skipped")
      ->capture_default_str();
  cracks->add_flag("--log", c.options.log, "a line for each crack that left the true field");
  cracks->add_flag("--timing", c.options.timing, "times of single cracks against the sizes of bodies");
  cracks->add_flag("--generations", c.options.generations,
                   "three generations on all pieces, remeshed in between, to 64 pieces and more, then each solved");
  cracks->add_option("--edge-per-thickness", c.options.edge_per_thickness, "with --generations: of the remeshing")
      ->check(CLI::NonNegativeNumber);
  cracks->add_option("--pieces", c.options.pieces, "with --generations: folder for the pieces")
      ->check(CLI::ExistingDirectory);
  cracks->add_option("--threads", c.threads, "0: all; 1 for times")->check(CLI::NonNegativeNumber);
  cracks->add_option("--json", c.options.json, "file for the numbers");
  cracks->footer(
      "Examples:\n  sherd-bench cracks --json out.json\n  sherd-bench cracks --shapes hollow --fields noise --first 17 "
      "--count 1 --log");
  return cracks;
}

CLI::App* add_scenes(CLI::App& app, sherd::bench::ScenesOptions& o) {
  using sherd::bench::SceneStudy;
  static const std::map<std::string, SceneStudy> studies{
      {"table", SceneStudy::kTable}, {"skips", SceneStudy::kSkips}, {"error", SceneStudy::kError}};
  CLI::App* scenes = app.add_subcommand("scenes", "whole scenes: the paper's Table 3, skipping, accuracy settings");
  scenes->add_option("--scene", o.scenes, "names in the folder, or files (default: the paper's five)");
  scenes
      ->add_option("--study", o.studies,
                   "table, skips (each switch off in turn), error (each quality against the finest); default: table")
      ->transform(CLI::CheckedTransformer(studies));
  const auto quality = CLI::IsMember({"preview", "default", "fine"});
  scenes->add_option("--quality", o.quality, "of table and skips")->check(quality)->capture_default_str();
  scenes->add_option("--finest", o.finest, "reference of the error study")->check(quality)->capture_default_str();
  scenes->add_option("--frames", o.frames, "of each run; in the error study as counted at `default` (default: all)")
      ->check(CLI::PositiveNumber);
  scenes->add_option("--threads", o.threads, "a run of the table each; the other studies take the last")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  scenes
      ->add_option("--off", o.off,
                   "switches the skips study turns off, each alone; all: together (default: everything)")
      ->check(CLI::IsMember([] {
        std::vector<std::string> keys{"all"};
        for (const sherd::SkipSwitch& s : sherd::kSkipSwitches) keys.emplace_back(s.key);
        return keys;
      }()));
  scenes->add_option("--folder", o.folder, "of the scenes")->capture_default_str();
  scenes->add_option("--program", o.program, "the command sherd (default: beside this program)");
  scenes->add_option("--plots", o.plots, "folder for the error study's plots")->check(CLI::ExistingDirectory);
  scenes->add_option("--json", o.json, "file for the numbers");
  scenes->footer(
      "Examples:\n  sherd-bench scenes --json out.json\n  sherd-bench scenes --scene glass_goblet --threads 2\n  "
      "sherd-bench scenes --scene dinner_table --study skips "
      "--quality "
      "preview --frames 3\n  sherd-bench scenes --study error --finest default --plots .");
  return scenes;
}

CLI::App* add_fuzz(CLI::App& app, sherd::bench::FuzzOptions& o) {
  CLI::App* fuzz = app.add_subcommand("fuzz", "random scenes, each in its own process: crashes, hangs, broken laws");
  fuzz->add_option("--count", o.count)->check(CLI::Range(1, 1000000))->capture_default_str();
  fuzz->add_option("--seed", o.seed, "of the first scene; the others follow")->capture_default_str();
  fuzz->add_option("--duration", o.duration, "simulated seconds of a scene")->capture_default_str();
  fuzz->add_option("--seconds", o.seconds, "a scene runs at most")->check(CLI::PositiveNumber)->capture_default_str();
  fuzz->add_option("--threads", o.threads)->check(CLI::Range(1, 1024))->capture_default_str();
  fuzz->add_option("--program", o.program, "the command sherd (default: beside this program)");
  fuzz->add_option("--keep", o.keep, "folder for the scenes that failed")->check(CLI::ExistingDirectory);
  fuzz->add_option("--json", o.json, "file for the numbers");
  fuzz->footer("Examples:\n  sherd-bench fuzz --count 1000\n  sherd-bench fuzz --seed 17 --count 1 --keep .");
  return fuzz;
}

// A study that InputError may end.
template <class Run>
int guarded(const Run& run) {
  try {
    return run();
  } catch (const sherd::InputError& e) {
    std::fprintf(stderr, "sherd-bench: %s\n", e.what());
    return 2;
  }
}

int run_micro(const std::string& program, std::vector<std::string> rest) {
  std::string name = program;
  std::vector<char*> arguments{name.data()};
  for (std::string& a : rest) arguments.push_back(a.data());
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"sherd-bench: benchmarks of sherd"};
  app.require_subcommand(1);
  CLI::App* micro = app.add_subcommand("micro", "times of single stages; takes Google Benchmark's options");
  micro->allow_extras();
  micro->footer(
      "Examples:\n  sherd-bench micro\n  sherd-bench micro --benchmark_filter=Operator --benchmark_format=json");
  StressCommand command;
  CLI::App* stress = add_stress(app, command);
  sherd::bench::PairsOptions pairs_options;
  CLI::App* pairs = add_pairs(app, pairs_options);
  sherd::bench::FmmOptions fmm_options;
  CLI::App* fmm = add_fmm(app, fmm_options);
  SolveCommand solve_command;
  CLI::App* solve = add_solve(app, solve_command);
  CracksCommand cracks_command;
  CLI::App* cracks = add_cracks(app, cracks_command);
  sherd::bench::ScenesOptions scenes_options;
  CLI::App* scenes = add_scenes(app, scenes_options);
  sherd::bench::FuzzOptions fuzz_options;
  CLI::App* fuzz = add_fuzz(app, fuzz_options);
  CLI11_PARSE(app, argc, argv);
  if (*cracks) {
    const sherd::ThreadLimit limit(cracks_command.threads);
    return sherd::bench::run_cracks(cracks_command.options);
  }
  if (*solve) {
    const sherd::ThreadLimit limit(solve_command.threads);
    return sherd::bench::run_solve(solve_command.options);
  }
  if (*scenes) return guarded([&] { return sherd::bench::run_scenes(scenes_options); });
  if (*fuzz) return guarded([&] { return sherd::bench::run_fuzz(fuzz_options); });
  if (*fmm) return sherd::bench::run_fmm(fmm_options);
  if (*pairs) return sherd::bench::run_pairs(pairs_options);
  return *stress ? run_stress(command) : run_micro(argv[0], micro->remaining());
}
