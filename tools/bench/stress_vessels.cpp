// The bodies artists break against their own fine solution.
#include <algorithm>

#include "kernels/core/error.h"
#include "tools/bench/stress.h"
#include "tools/exact/meshes.h"
#include "tools/exact/vessels.h"

namespace sherd::bench {
namespace {

constexpr Real kEdgeOverThickness = 1.75;

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

// Fine stress at the corner of a coarse mesh: on the fine face closest to a point just above the corner, so that the
// right side of a crease answers.
Sym3 reference_stress(const exact::Solved& fine, const Vec3& x, const Vec3& normal, Real lift) {
  const TriangleBvh::Closest c = fine.bvh->closest(x + normal * lift);
  return fine.field->on_face(c.face, c.point);
}

void compare(const exact::Vessel& vessel, const exact::Solved& coarse, const exact::Solved& fine, VesselRow& row) {
  Real sum = 0, scale = 0;
  const auto& corners = coarse.recovery->corners();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 x = coarse.mesh.vertices[corners[i].vertex];
    // Below the load the stress depends on how the patch meets the facets.
    if (distance(x, vessel.hit) < 1.5 * vessel.patch_radius) continue;
    Vec3 normal;
    for (const std::uint32_t f : corners[i].faces) normal += coarse.mesh.area_normal2(f);
    const Sym3 s = reference_stress(fine, x, normalized(normal), 0.25 * vessel.thickness);
    const Real wanted = eigen_symmetric(s).value[0];
    const Real e = eigen_symmetric(coarse.field->corner_stress()[i]).value[0] - wanted;
    sum += e * e, scale += wanted * wanted, row.max = std::max(row.max, std::abs(e)), ++row.points;
  }
  row.rms = std::sqrt(sum / scale);
  row.max /= std::sqrt(scale / static_cast<Real>(row.points));
}

}  // namespace

std::vector<VesselRow> measure_vessels(exact::Formulation formulation, const exact::SolveOptions& options, int factor) {
  std::vector<VesselRow> rows;
  const Elastic material{70e9 / (2 * 1.22), 0.22};
  for (const VesselShape& shape :
       {VesselShape{"dinner plate", exact::dinner_plate}, VesselShape{"goblet", exact::goblet}}) {
    const Real edge = kEdgeOverThickness * shape.make(0.02).thickness;
    const exact::Vessel fine = reference(shape, edge, factor, options.elastic.max_bytes);
    exact::SolveOptions own = options;
    // The reference is direct, and collocated where its elements are not longer than the wall: 1 to 2 % there at a
    // tenth of the cost (design notes, thin walls, section 2).
    own.formulation = exact::Formulation::kDirect;
    own.elastic.thin_ratio = std::max(own.elastic.thin_ratio, 1.0);
    const exact::Solved truth = exact::solve(fine.mesh, material, exact::vessel_load(fine), own);
    own = options, own.formulation = formulation;
    for (const Real step : {1.0, 0.7}) {
      const exact::Vessel v = shape.make(edge * step);
      const exact::Solved s = exact::solve(v.mesh, material, exact::vessel_load(v), own);
      VesselRow row;
      row.body = shape.name, row.formulation = formulation;
      row.triangles = v.mesh.triangle_count(), row.reference_triangles = fine.mesh.triangle_count();
      row.edge_over_thickness = exact::mean_edge(v.mesh) / v.thickness;
      row.reference_edge_over_thickness = exact::mean_edge(fine.mesh) / v.thickness;
      row.ok = s.ok && truth.ok, row.reason = s.ok ? truth.reason : s.reason;
      row.iterations = s.krylov.iterations, row.seconds = s.seconds.total(),
      row.reference_seconds = truth.seconds.total();
      if (row.ok) compare(v, s, truth, row);
      rows.push_back(row);
    }
  }
  return rows;
}

}  // namespace sherd::bench
