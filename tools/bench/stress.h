// sherd-bench stress: accuracy of the stress against exact solutions, with its cost.
#pragma once
#include <string>
#include <vector>

#include "tools/exact/solve.h"

namespace sherd::bench {

enum class Study { kTable, kInterior, kIterations, kVessels };

struct StressOptions {
  std::vector<std::string> cases;  // names of families; empty: all
  std::vector<Study> studies;      // empty: all
  bool direct = true, indirect = true;
  exact::SolveOptions solve;
  int vessel_factor = 2;    // the vessels' reference has edges this many times shorter, memory permitting
  std::string json, plots;  // file and folder; empty: none
};
// Prints the tables; returns the exit code.
int run_stress(const StressOptions& options);

// One line of the table.
struct Row {
  std::string family;
  exact::Formulation formulation = exact::Formulation::kDirect;
  std::string load;
  std::size_t triangles = 0, unknowns = 0;
  Real edge = 0, edge_over_thickness = 0;  // m; 0 for bulky bodies
  bool ok = false;
  std::string reason;
  exact::SurfaceError error;
  exact::SurfaceError floor;  // of the recovery with exact displacements
  Real order = 0;             // observed, of the rms in the edge length against the row before; 0: none
  KrylovResult krylov;
  exact::StageSeconds seconds;
  double peak_megabytes = 0;
};
std::vector<Row> measure_family(const exact::CaseFamily& family, exact::Formulation formulation,
                                const exact::SolveOptions& options);

struct InteriorRow {
  std::string family;
  exact::Formulation formulation = exact::Formulation::kDirect;
  std::size_t triangles = 0;
  std::vector<Real> depth;  // edges
  std::vector<exact::StressError> error;
};
std::vector<InteriorRow> measure_interior(exact::Formulation formulation, const exact::SolveOptions& options);

struct IterationRow {
  std::string body;
  exact::Formulation formulation = exact::Formulation::kDirect;
  std::size_t triangles = 0;
  Real nu = 0;
  bool ok = false;
  int iterations = 0, products = 0;
  double assemble = 0, solve = 0;  // s; assemble holds the preconditioner's set-up
};
std::vector<IterationRow> measure_iterations(exact::Formulation formulation, const exact::SolveOptions& options);

struct VesselRow {
  std::string body;
  exact::Formulation formulation = exact::Formulation::kDirect;
  std::size_t triangles = 0, reference_triangles = 0;
  Real edge_over_thickness = 0, reference_edge_over_thickness = 0;
  bool ok = false;
  std::string reason;
  // Of the largest principal stress at points of the true surface, relative to the reference's rms. The square rims
  // have a boundary layer of one wall in which twisting turns into shear across the rim; elements longer than the wall
  // do not resolve it, so that the wall (more than one and a half walls from every crease) is also counted alone.
  exact::StressError wall, all;
  int iterations = 0;
  double seconds = 0, reference_seconds = 0;
};
std::vector<VesselRow> measure_vessels(const std::vector<exact::Formulation>& formulations,
                                       const exact::SolveOptions& options, int factor);

}  // namespace sherd::bench
