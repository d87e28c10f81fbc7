// The bodies artists break against their own fine solution.
#include <algorithm>

#include "kernels/core/error.h"
#include "tools/bench/stress.h"
#include "tools/exact/meshes.h"
#include "tools/exact/vessels.h"

namespace sherd::bench {
namespace {

constexpr Real kEdgeOverThickness = 1.75;  // nominal; the goblet's stem is finer
constexpr Real kRimWalls = 1.5;            // a square rim's boundary layer, walls

struct VesselShape {
  const char* name;
  exact::Vessel (*make)(Real edge);
};

// Shortest edge not below edge / factor whose dense operator fits the limit.
exact::Vessel reference(const VesselShape& shape, Real edge, int factor, std::size_t max_bytes) {
  for (Real fine = edge / factor;; fine *= 1.05) {
    exact::Vessel v = shape.make(fine);
    const std::size_t n = 3 * v.mesh.vertex_count();
    if (fine >= edge || n * n * sizeof(float) <= max_bytes) return v;
  }
}

class RelativeError {
 public:
  void add(const Sym3& got, const Sym3& wanted) {
    const Real w = eigen_symmetric(wanted).value[0], e = eigen_symmetric(got).value[0] - w;
    sum_ += e * e, scale_ += w * w, max_ = std::max(max_, std::abs(e)), ++count_;
  }
  // `scale`: rms of what was wanted.
  exact::StressError result(Real scale) const {
    return {std::sqrt(sum_ / static_cast<Real>(count_)) / scale, max_ / scale, count_};
  }
  Real scale() const { return std::sqrt(scale_ / static_cast<Real>(count_)); }

 private:
  Real sum_ = 0, scale_ = 0, max_ = 0;
  std::size_t count_ = 0;
};

}  // namespace

std::vector<VesselRow> measure_vessels(const std::vector<exact::Formulation>& formulations,
                                       const exact::SolveOptions& options, int factor) {
  std::vector<VesselRow> rows;
  const Elastic material{70e9 / (2 * 1.22), 0.22};
  for (const VesselShape& shape :
       {VesselShape{"dinner plate", exact::dinner_plate}, VesselShape{"goblet", exact::goblet}}) {
    const Real edge = kEdgeOverThickness * shape.make(0.02).thickness;
    const exact::Vessel fine = reference(shape, edge, factor, options.elastic.max_bytes);
    const std::vector<exact::VesselPoint> points = exact::vessel_points(fine, 1500);
    exact::SolveOptions own = options;
    // Six Gauss points everywhere: collocation is some percent too stiff on walls even at half an edge a wall.
    own.formulation = exact::Formulation::kDirect, own.elastic.testing = TestingRule::kGalerkin;
    const exact::Solved truth = exact::solve(fine.mesh, material, exact::vessel_load(fine), own);
    const std::vector<Sym3> wanted = truth.ok ? exact::vessel_stress(fine, truth, points) : std::vector<Sym3>{};
    for (const exact::Formulation formulation : formulations)
      for (const Real step : {1.0, 0.7}) {
        const exact::Vessel v = shape.make(edge * step);
        own = options, own.formulation = formulation;
        const exact::Solved s = exact::solve(v.mesh, material, exact::vessel_load(v), own);
        VesselRow row;
        row.body = shape.name, row.formulation = formulation;
        row.triangles = v.mesh.triangle_count(), row.reference_triangles = fine.mesh.triangle_count();
        row.edge_over_thickness = edge * step / v.thickness;
        row.reference_edge_over_thickness =
            row.edge_over_thickness * exact::mean_edge(fine.mesh) / exact::mean_edge(v.mesh);
        row.ok = s.ok && truth.ok, row.reason = s.ok ? truth.reason : s.reason;
        row.iterations = s.krylov.iterations, row.seconds = s.seconds.total();
        row.reference_seconds = truth.seconds.total();
        if (row.ok) {
          const std::vector<Sym3> got = exact::vessel_stress(v, s, points);
          RelativeError wall, all;
          for (std::size_t i = 0; i < points.size(); ++i) {
            all.add(got[i], wanted[i]);
            if (points[i].crease_distance > kRimWalls) wall.add(got[i], wanted[i]);
          }
          row.wall = wall.result(all.scale()), row.all = all.result(all.scale());
        }
        rows.push_back(row);
      }
  }
  return rows;
}

}  // namespace sherd::bench
