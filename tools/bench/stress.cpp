#include "tools/bench/stress.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "kernels/core/error.h"
#include "tools/bench/plot.h"

namespace sherd::bench {
namespace {

using nlohmann::json;

bool wanted(const StressOptions& o, Study study) {
  return o.studies.empty() || std::find(o.studies.begin(), o.studies.end(), study) != o.studies.end();
}

std::vector<exact::Formulation> formulations(const StressOptions& o) {
  std::vector<exact::Formulation> f;
  if (o.direct) f.push_back(exact::Formulation::kDirect);
  if (o.indirect) f.push_back(exact::Formulation::kIndirect);
  return f;
}

std::string name(exact::Formulation f) {
  return std::string(exact::to_string(f));
}

void print(const Row& r) {
  const std::string thin = r.edge_over_thickness > 0 ? fmt::format("{:.2f}", r.edge_over_thickness) : "-";
  const std::string order = r.order != 0 ? fmt::format("{:.1f}", r.order) : "-";
  std::string line =
      fmt::format("{:<23}{:<9}{:>6}{:>7}{:>6} ", r.family, name(r.formulation), r.triangles, r.unknowns, thin);
  if (r.ok)
    line += fmt::format("{:>8.3f}{:>8.2f} |{:>8.3f}{:>8.2f} |{:>7.3f}{:>6}{:>5}{:>5}", 100 * r.error.all.rms,
                        100 * r.error.all.max, 100 * r.error.free.rms, 100 * r.error.free.max, 100 * r.floor.all.rms,
                        order, r.krylov.iterations, r.krylov.products);
  else
    line += fmt::format("{:<58}", r.reason);
  line += fmt::format("{:>8.2f}{:>7.2f}{:>7.2f}{:>7.2f}{:>7.0f}\n", r.seconds.prepare, r.seconds.assemble,
                      r.seconds.solve, r.seconds.stress, r.peak_megabytes);
  std::fputs(line.c_str(), stdout), std::fflush(stdout);
}

json to_json(const exact::StressError& e) {
  return {{"rms", e.rms}, {"max", e.max}, {"count", e.count}};
}

json to_json(const Row& r) {
  return {{"case", r.family},
          {"formulation", name(r.formulation)},
          {"load", r.load},
          {"triangles", r.triangles},
          {"unknowns", r.unknowns},
          {"edge", r.edge},
          {"edge_over_thickness", r.edge_over_thickness},
          {"ok", r.ok},
          {"reason", r.reason},
          {"error", to_json(r.error.all)},
          {"error_free_corners", to_json(r.error.free)},
          {"floor", to_json(r.floor.all)},
          {"order", r.order},
          {"iterations", r.krylov.iterations},
          {"products", r.krylov.products},
          {"residual", r.krylov.residual},
          {"peak_megabytes", r.peak_megabytes},
          {"seconds",
           {{"prepare", r.seconds.prepare},
            {"assemble", r.seconds.assemble},
            {"solve", r.seconds.solve},
            {"stress", r.seconds.stress}}}};
}

void plot(const std::vector<Row>& rows, const std::string& folder) {
  LogLogPlot p{rows.front().family + ": run time against error",
               "run time [s]",
               "rms error of the largest principal stress [%]",
               {}};
  for (const Row& r : rows) {
    if (p.series.empty() || p.series.back().name != name(r.formulation))
      p.series.push_back({name(r.formulation), {}, {}});
    if (!r.ok) continue;
    p.series.back().x.push_back(r.seconds.total()), p.series.back().y.push_back(100 * r.error.all.rms);
    p.series.back().label.push_back(std::to_string(r.triangles));
  }
  write_svg(p, folder + "/" + rows.front().family + ".svg");
}

void run_table(const StressOptions& o, json& out) {
  std::puts(
      "Largest principal stress at surface corners, error in % of the peak. free: without loaded corners of sharp "
      "edges; "
      "floor: rms of the recovery fed with exact displacements.");
  std::puts(
      "case                   formul.    tris  unkn.   h/T      rms     max |    free     max |  floor order  its prod "
      "   "
      "prep  "
      "assem  solve stress     MB");
  std::vector<const exact::CaseFamily*> families;
  if (o.cases.empty())
    for (const exact::CaseFamily& f : exact::case_families()) families.push_back(&f);
  for (const std::string& n : o.cases) families.push_back(&exact::find_family(n));
  for (const exact::CaseFamily* family : families) {
    std::vector<Row> all;
    for (const exact::Formulation f : formulations(o))
      for (const Row& row : measure_family(*family, f, o.solve))
        print(row), out.push_back(to_json(row)), all.push_back(row);
    if (!o.plots.empty()) plot(all, o.plots);
  }
}

void run_interior(const StressOptions& o, json& out) {
  std::puts("\nInside, rms error in % of the peak at a depth below the surface:");
  for (const exact::Formulation f : formulations(o))
    for (const InteriorRow& r : measure_interior(f, o.solve)) {
      std::string line = fmt::format("{:<23}{:<9}{:>6} ", r.family, name(f), r.triangles);
      json errors = json::array();
      for (std::size_t i = 0; i < r.depth.size(); ++i) {
        line += fmt::format("  {:g}h {:.3f}", r.depth[i], 100 * r.error[i].rms);
        errors.push_back({{"depth", r.depth[i]}, {"error", to_json(r.error[i])}});
      }
      std::puts(line.c_str());
      out.push_back({{"case", r.family}, {"formulation", name(f)}, {"triangles", r.triangles}, {"depths", errors}});
    }
}

void run_iterations(const StressOptions& o, json& out) {
  std::puts("\nIterations to 1e-6 (assembly includes the preconditioner):");
  for (const exact::Formulation f : formulations(o))
    for (const IterationRow& r : measure_iterations(f, o.solve)) {
      std::puts(fmt::format(
                    "{:<23}{:<9}{:>6} nu {:.2f}  {:>4} iterations {:>4} products  assembly {:.2f} s  solve {:.2f} s{}",
                    r.body, name(f), r.triangles, r.nu, r.iterations, r.products, r.assemble, r.solve,
                    r.ok ? "" : "  NOT CONVERGED")
                    .c_str());
      out.push_back({{"body", r.body},
                     {"formulation", name(f)},
                     {"triangles", r.triangles},
                     {"nu", r.nu},
                     {"ok", r.ok},
                     {"iterations", r.iterations},
                     {"products", r.products},
                     {"seconds", {{"assemble", r.assemble}, {"solve", r.solve}}}});
    }
}

void run_vessels(const StressOptions& o, json& out) {
  std::puts(
      "\nBodies artists break against their own fine solution, in % of the reference's rms. wall: beyond one and a "
      "half "
      "walls from the creases:");
  for (const VesselRow& r : measure_vessels(formulations(o), o.solve, o.vessel_factor)) {
    std::puts(
        fmt::format("{:<23}{:<9}{:>6} h/T {:.2f}  against {:>6} h/T {:.2f}: {}", r.body, name(r.formulation),
                    r.triangles, r.edge_over_thickness, r.reference_triangles, r.reference_edge_over_thickness,
                    r.ok ? fmt::format("wall rms {:.2f} max {:.1f}, all rms {:.2f} max {:.1f}, {} iterations, {:.1f} s "
                                       "(reference {:.1f} s)",
                                       100 * r.wall.rms, 100 * r.wall.max, 100 * r.all.rms, 100 * r.all.max,
                                       r.iterations, r.seconds, r.reference_seconds)
                         : r.reason)
            .c_str());
    std::fflush(stdout);
    out.push_back({{"body", r.body},
                   {"formulation", name(r.formulation)},
                   {"triangles", r.triangles},
                   {"reference_triangles", r.reference_triangles},
                   {"edge_over_thickness", r.edge_over_thickness},
                   {"reference_edge_over_thickness", r.reference_edge_over_thickness},
                   {"ok", r.ok},
                   {"reason", r.reason},
                   {"wall", to_json(r.wall)},
                   {"all", to_json(r.all)},
                   {"iterations", r.iterations},
                   {"seconds", r.seconds},
                   {"reference_seconds", r.reference_seconds}});
  }
}

}  // namespace

int run_stress(const StressOptions& o) {
  json out = {
      {"table", json::array()}, {"interior", json::array()}, {"iterations", json::array()}, {"vessels", json::array()}};
  if (wanted(o, Study::kTable)) run_table(o, out["table"]);
  if (wanted(o, Study::kInterior)) run_interior(o, out["interior"]);
  if (wanted(o, Study::kIterations)) run_iterations(o, out["iterations"]);
  if (wanted(o, Study::kVessels)) run_vessels(o, out["vessels"]);
  if (o.json.empty()) return 0;
  std::ofstream file(o.json);
  file << out.dump(1) << '\n';
  file.close();
  if (!file)
    throw InputError(fmt::format("{}: cannot be written; choose a folder that exists and is writable", o.json));
  return 0;
}

}  // namespace sherd::bench
