// Accuracy over the resolutions of each exact case, and below the surface.
#include "tools/bench/stress.h"
#include "tools/exact/meshes.h"

namespace sherd::bench {

std::vector<Row> measure_family(const exact::CaseFamily& family, exact::Formulation formulation,
                                const exact::SolveOptions& options) {
  std::vector<Row> rows;
  exact::SolveOptions own = options;
  own.formulation = formulation;
  for (const int resolution : family.resolutions) {
    const exact::ExactCase c = family.make(resolution);
    const exact::Solved solved = exact::solve(c, own);
    Row row;
    row.family = family.name, row.formulation = formulation, row.load = c.load;
    row.triangles = c.mesh.triangle_count(), row.unknowns = solved.unknowns;
    row.edge = exact::mean_edge(c.mesh);
    row.edge_over_thickness = c.thickness > 0 ? row.edge / c.thickness : 0;
    row.ok = solved.ok, row.reason = solved.reason;
    row.krylov = solved.krylov, row.seconds = solved.seconds, row.peak_megabytes = solved.peak_megabytes;
    if (row.ok) row.error = exact::surface_error(c, solved);
    row.floor = exact::recovery_floor(c, solved);
    // Errors at the level of the solver's tolerance have no order.
    if (!rows.empty() && row.ok && rows.back().ok && row.error.all.rms > 1e-3 * options.elastic.krylov.tolerance)
      row.order = std::log(rows.back().error.all.rms / row.error.all.rms) / std::log(rows.back().edge / row.edge);
    rows.push_back(row);
  }
  return rows;
}

std::vector<InteriorRow> measure_interior(exact::Formulation formulation, const exact::SolveOptions& options) {
  std::vector<InteriorRow> rows;
  exact::SolveOptions own = options;
  own.formulation = formulation;
  for (const char* name : {"cavity", "square-torsion"}) {
    const exact::CaseFamily& family = exact::find_family(name);
    for (const int resolution : family.resolutions) {
      const exact::ExactCase c = family.make(resolution);
      const exact::Solved solved = exact::solve(c, own);
      if (!solved.ok) continue;
      InteriorRow row{name, formulation, c.mesh.triangle_count(), {0.02, 0.05, 0.1, 0.25, 1}, {}};
      // The outer sphere of the cavity is a place for loads only.
      const Real within = row.family == "cavity" ? 1.5 : 1e300;
      for (const Real depth : row.depth) row.error.push_back(exact::interior_error(c, solved, depth, 300, within));
      rows.push_back(row);
    }
  }
  return rows;
}

}  // namespace sherd::bench
