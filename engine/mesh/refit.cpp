#include "engine/mesh/refit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/mesh/refit_walls.h"
#include "engine/mesh/sizing.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

// One rung of the ladder.
struct Attempt {
  const char* name;
  Real reach;       // of the target length: how far from poor triangles vertices may change
  Real finer;       // target length over the one asked for
  Real merge;       // of RemeshOptions
  bool slivers;     // repair only, no remeshing
  bool for_angles;  // of use only against angles, not for a volume that came out wrong
};

constexpr Real kCloseEnough = 5;  // of max_volume_change

constexpr Attempt kLadder[] = {
    {"local", 2, 1, 0.02, false, false},           {"local, merged 0.1", 2, 1, 0.1, false, true},
    {"local, merged 0.3", 2, 1, 0.3, false, true}, {"wide", 6, 1, 0.1, false, false},
    {"fine", 4, 0.5, 0.02, false, false},          {"fine, merged 0.3", 4, 0.5, 0.3, false, true},
    {"finer", 4, 0.25, 0.02, false, false},        {"finer, merged 0.4", 4, 0.25, 0.4, false, true},
    {"slivers", 0, 1, 0.02, true, false},          {"slivers, merged 0.1", 0, 1, 0.1, true, true},
    {"slivers, merged 0.5", 0, 1, 0.5, true, true}};

class Refit {
 public:
  Refit(const SurfaceMesh& piece, const RefitOptions& options, SurfaceMesh& out)
      : piece_(piece), options_(options), out_(out), volume_(signed_volume(piece)) {
    const Real h = options.edge_length;
    largest_change_ = options.max_volume_change * std::max(volume_, 10 * h * h * h);
    size_.assign(piece.vertex_count(), h);
    if (options.edge_per_thickness > 0)
      size_ = sizing_field(piece, wall_thickness(piece).vertex,
                           {.edge_length = h, .edge_per_thickness = options.edge_per_thickness});
  }

  RefitReport run() {
    climb();
    if (report_.ok && options_.edge_per_thin_wall > 0) refit_walls(out_, options_, volume_, report_);
    return report_;
  }

 private:
  void climb() {
    bool found = false;
    bool angles_hold = false;  // an attempt failed by its volume alone: merging features more would not help
    for (const Attempt& attempt : kLadder) {
      if (attempt.for_angles && angles_hold) continue;
      // Finer edges cost every later solve more than such a change is worth.
      if (attempt.finer < 1 && found && least_change_ <= kCloseEnough * options_.max_volume_change * volume_) return;
      SurfaceMesh mesh;
      const RemeshReport r = remesh(piece_, options_of(attempt), mesh);
      ++report_.attempts;
      angles_hold = r.status == RemeshStatus::kOk && r.min_angle >= options_.least_angle;
      const std::string wrong = judge(r, mesh, attempt.finer);
      const Real change = std::abs(r.volume_change) * volume_;
      if (wrong.empty() && (!found || change < least_change_)) adopt(attempt, r, std::move(mesh)), found = true;
      if (found && least_change_ <= options_.max_volume_change * volume_) return;
      if (wrong.empty()) continue;
      report_.reason += fmt::format("{}{}: {}", report_.reason.empty() ? "" : "; ", attempt.name, wrong);
    }
    if (!found) refuse();
  }

  void adopt(const Attempt& attempt, const RemeshReport& r, SurfaceMesh&& mesh) {
    report_.ok = true, report_.strategy = attempt.name;
    report_.min_angle = r.min_angle, report_.volume_change = r.volume_change;
    report_.below_1 = r.below_1, report_.below_15 = r.below_15;
    least_change_ = std::abs(r.volume_change) * volume_;
    out_ = std::move(mesh);
  }

  RemeshOptions options_of(const Attempt& attempt) const {
    RemeshOptions o;
    o.edge_length = attempt.finer * options_.edge_length;
    o.merge = attempt.merge, o.keep_volume = true;
    if (attempt.slivers) o.iterations = 0;
    if (options_.edge_per_thickness > 0 || attempt.finer < 1) {
      o.size = size_;
      for (Real& s : o.size) s *= attempt.finer;
    }
    if (attempt.reach > 0) o.locked = lock_good_regions(piece_, size_, attempt.reach * options_.edge_length);
    return o;
  }

  std::string judge(const RemeshReport& r, const SurfaceMesh& mesh, Real finer) const {
    if (r.status != RemeshStatus::kOk) return r.reason;
    if (!(r.min_angle >= options_.least_angle))
      return fmt::format("an angle of {:.2g} degrees ({} triangles below 1)", r.min_angle, r.below_1);
    const Real close_enough = kCloseEnough * options_.max_volume_change * volume_;
    const Real limit = finer == 1 ? std::max(largest_change_, close_enough) : largest_change_;
    if (!(std::abs(r.volume_change) * volume_ <= limit))
      return fmt::format("the volume changes by {:.2g} of itself", r.volume_change);
    if (!(signed_volume(mesh) > 0)) return "the result has no volume";
    return {};
  }

  void refuse() {
    out_ = piece_;
    Real least = 180;
    for (std::size_t t = 0; t < piece_.triangle_count(); ++t) {
      const Real angle = smallest_angle({piece_.corner(t, 0), piece_.corner(t, 1), piece_.corner(t, 2)}) / kDegree;
      least = std::min(least, angle), report_.below_1 += angle < 1, report_.below_15 += angle < 15;
    }
    report_.min_angle = piece_.triangles.empty() ? 0 : least;
  }

  static constexpr Real kDegree = std::numbers::pi / 180;
  const SurfaceMesh& piece_;
  const RefitOptions& options_;
  SurfaceMesh& out_;
  Real volume_, largest_change_ = 0;  // m^3, of what is accepted at all
  Real least_change_ = 0;             // of what was adopted
  std::vector<Real> size_;
  RefitReport report_;
};

void check(const RefitOptions& o) {
  if (!(o.edge_length > 0) || !std::isfinite(o.edge_length))
    throw InputError(fmt::format("refit: edge_length is {}; give a positive length in metres", o.edge_length));
  if (!(o.edge_per_thickness >= 0) || !std::isfinite(o.edge_per_thickness))
    throw InputError(fmt::format("refit: edge_per_thickness is {}; give 0 (off) or more", o.edge_per_thickness));
  if (!(o.least_angle >= 0 && o.least_angle < 60))
    throw InputError(fmt::format("refit: least_angle is {}; give degrees from 0 to 60", o.least_angle));
  if (!(o.max_volume_change > 0))
    throw InputError(fmt::format("refit: max_volume_change is {}; give a positive part", o.max_volume_change));
  if (!(o.edge_per_thin_wall >= 0) || !std::isfinite(o.edge_per_thin_wall))
    throw InputError(fmt::format("refit: edge_per_thin_wall is {}; give 0 (off) or more", o.edge_per_thin_wall));
  if (!(o.most_refinement >= 1))
    throw InputError(fmt::format("refit: most_refinement is {}; give 1 or more", o.most_refinement));
}

}  // namespace

RefitReport refit(const SurfaceMesh& piece, const RefitOptions& options, SurfaceMesh& out) {
  check(options);
  return Refit(piece, options, out).run();
}

}  // namespace sherd
