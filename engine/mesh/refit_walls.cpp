#include "engine/mesh/refit_walls.h"

#include <algorithm>
#include <cmath>

#include "engine/mesh/sizing.h"
#include "engine/mesh/thickness_resolution.h"

namespace sherd {
namespace {

// Where a cut meets the surface or another cut at a small angle, a wedge as thin as one likes remains. Elements several
// times as long as it is thick bend wrongly and can spoil the whole piece: on two pieces of the campaign's cube, with
// edges up to 15 times the thickness on 1 % of the surface, the peak stress came out 3 to 17 times too high.
constexpr Real kWorst = 2;      // of the rule's limit: edges this long are shortened however few they are
constexpr Real kAllOver = 0.2;  // share of the area: a body as coarse as that is so because its scene says so
constexpr int kPasses = 3;      // thickness is measured again on the finer mesh: a wedge reads thinner towards its tip
constexpr Real kGrowth = 0.5;   // SizingOptions: 0.3 takes a quarter more triangles for the same warnings
constexpr Real kSlack[] = {1, 1.3};  // on the edges, tried in turn until the triangles suffice

class WallGrading {
 public:
  WallGrading(SurfaceMesh& mesh, const RefitOptions& options, Real volume, RefitReport& report)
      : mesh_(mesh),
        options_(options),
        report_(report),
        volume_(volume),
        most_(options.most_refinement * static_cast<Real>(mesh.triangle_count())) {}

  void run() {
    WallThickness thickness = wall_thickness(mesh_);
    ResolutionReport walls = resolution_report(mesh_, thickness);
    report_.thin_walls = walls.share_above_5_percent;
    const auto warned = [&] { return !resolution_warnings(walls).empty(); };
    const bool asked =
        walls.share_above_5_percent <= kAllOver && (warned() || walls.worst > kWorst * kCubicTestedRule.at_5_percent);
    for (int pass = 0; pass < kPasses && (pass == 0 ? asked : warned()); ++pass) {
      if (!grade(thickness)) return;
      ++report_.wall_passes;
      thickness = wall_thickness(mesh_), walls = resolution_report(mesh_, thickness);
      report_.thin_walls = walls.share_above_5_percent;
    }
  }

 private:
  // False when the triangles do not suffice or the remeshed piece breaks a promise.
  bool grade(const WallThickness& thickness) {
    RemeshOptions o;
    o.edge_length = options_.edge_length, o.keep_volume = true;
    bool enough = false;
    for (const Real slack : kSlack) {
      Real per_thickness = slack * options_.edge_per_thin_wall;
      if (options_.edge_per_thickness > 0) per_thickness = std::min(per_thickness, options_.edge_per_thickness);
      o.size = sizing_field(mesh_, thickness.vertex,
                            {.edge_length = o.edge_length, .edge_per_thickness = per_thickness, .growth = kGrowth});
      enough = expected_triangles(mesh_, o.size) <= most_;
      if (enough) break;
    }
    if (!enough) return false;
    o.locked = lock_good_regions(mesh_, o.size, 0);
    SurfaceMesh graded;
    const RemeshReport r = remesh(mesh_, o, graded);
    const Real change = (signed_volume(graded) - volume_) / volume_;
    const Real before = std::abs(report_.volume_change);
    if (r.status != RemeshStatus::kOk || !(r.min_angle >= options_.least_angle) ||
        !(std::abs(change) <= before + options_.max_volume_change))
      return false;
    mesh_ = std::move(graded);
    report_.min_angle = r.min_angle, report_.volume_change = change;
    report_.below_1 = r.below_1, report_.below_15 = r.below_15;
    return true;
  }

  SurfaceMesh& mesh_;
  const RefitOptions& options_;
  RefitReport& report_;
  Real volume_;  // m^3
  Real most_;    // triangles
};

}  // namespace

void refit_walls(SurfaceMesh& mesh, const RefitOptions& options, Real volume, RefitReport& report) {
  WallGrading(mesh, options, volume, report).run();
}

}  // namespace sherd
