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

enum class Against : std::uint8_t { kAngles, kAll };  // kAll: of use for a volume that came out wrong, too

// One rung of the ladder.
struct Attempt {
  const char* name;
  Real reach;  // of the target length: how far from poor triangles vertices may change; 0: repair of slivers alone
  Real finer;  // target length over the one asked for
  Real tips;   // the same where the attempts before have left poor triangles
  Real merge;  // of RemeshOptions
  Against against;
  bool pinch = false;  // triangles below the least angle go also where that pinches a thin sheet
};

constexpr Real kCloseEnough = 5;      // of max_volume_change
constexpr Real kFewTriangles = 1000;  // a solve of so many is quick, however coarse the piece could be
// Where two lines pass each other closely (the neck of a rim, a thread of solid between two lumps) only edges in
// keeping with the gap have decent angles, and merging the lines may be impossible: it would tear the solid apart. A
// few dozen triangles do, when lengths grow quickly away from there.
constexpr Real kTipGrowth = 0.5;
constexpr Real kTipAngle = 2;            // of the least angle: what counts as left poor
constexpr Real kPinchAngle = 1.5;        // of the least angle: what may pinch a sheet; its neighbours get poorer
constexpr std::size_t kMostPoor = 1000;  // corners; more are no matter of a few places

// What every later solve pays for, finer edges all over, comes last.
constexpr Attempt kLadder[] = {{"local", 2, 1, 1, 0.02, Against::kAll},
                               {"local, merged 0.1", 2, 1, 1, 0.1, Against::kAngles},
                               {"local, merged 0.3", 2, 1, 1, 0.3, Against::kAngles},
                               {"wide", 6, 1, 1, 0.1, Against::kAll},
                               {"tips", 2, 1, 1.0 / 8, 0.02, Against::kAngles},
                               {"finer tips", 2, 1, 1.0 / 32, 0.02, Against::kAngles},
                               {"slivers", 0, 1, 1, 0.02, Against::kAngles},
                               {"slivers, merged 0.1", 0, 1, 1, 0.1, Against::kAngles},
                               {"slivers, merged 0.5", 0, 1, 1, 0.5, Against::kAngles},
                               {"local, pinched", 2, 1, 1, 0.3, Against::kAngles, true},
                               {"slivers, pinched", 0, 1, 1, 0.5, Against::kAngles, true},
                               {"fine", 4, 0.5, 0.5, 0.02, Against::kAll},
                               {"fine, merged 0.3", 4, 0.5, 0.5, 0.3, Against::kAngles},
                               {"fine, tips", 4, 0.5, 1.0 / 16, 0.02, Against::kAngles},
                               {"finer", 4, 0.25, 0.25, 0.02, Against::kAll},
                               {"finer, merged 0.4", 4, 0.25, 0.25, 0.4, Against::kAngles},
                               {"finer, tips", 4, 0.25, 1.0 / 32, 0.02, Against::kAngles},
                               {"fine, pinched", 4, 0.5, 0.5, 0.3, Against::kAngles, true},
                               {"slivers for the volume", 0, 1, 1, 0.02, Against::kAll}};

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
      if (attempt.against == Against::kAngles && angles_hold) continue;
      // Finer edges cost every later solve more than such a change is worth.
      if (attempt.finer < 1 && found && least_change_ <= kCloseEnough * options_.max_volume_change * volume_) return;
      const RemeshOptions o = options_of(attempt);
      if (attempt.tips < 1 && !pay_for(attempt, o)) continue;
      SurfaceMesh mesh;
      const RemeshReport r = remesh(piece_, o, mesh);
      if (++report_.attempts == 1)
        triangles_left_ = options_.most_refinement * std::max(kFewTriangles, static_cast<Real>(mesh.triangle_count()));
      angles_hold = r.status == RemeshStatus::kOk && r.min_angle >= options_.least_angle;
      if (r.status == RemeshStatus::kOk && !angles_hold) remember_poor_triangles(mesh);
      const std::string wrong = judge(r, mesh, attempt.finer);
      const Real change = std::abs(r.volume_change) * volume_;
      if (wrong.empty() && (!found || change < least_change_)) adopt(attempt, r, std::move(mesh)), found = true;
      if (found && least_change_ <= options_.max_volume_change * volume_) return;
      if (!wrong.empty()) note(attempt, wrong);
    }
    if (!found) refuse();
  }

  // Of the triangles that attempts with finer edges may make; false when they do not suffice.
  bool pay_for(const Attempt& attempt, const RemeshOptions& o) {
    const Real triangles = expected_triangles(piece_, o.size, o.locked);
    if (triangles <= triangles_left_) {
      triangles_left_ -= triangles;
      return true;
    }
    note(attempt, fmt::format("some {:.2g} triangles would be too many", triangles));
    return false;
  }

  void note(const Attempt& attempt, const std::string& wrong) {
    report_.reason += fmt::format("{}{}: {}", report_.reason.empty() ? "" : "; ", attempt.name, wrong);
  }

  void remember_poor_triangles(const SurfaceMesh& mesh) {
    for (std::size_t t = 0; t < mesh.triangle_count() && poor_.size() < kMostPoor; ++t)
      if (angle_of(mesh, t) < kTipAngle * options_.least_angle)
        for (int k = 0; k < 3; ++k) poor_.push_back(mesh.corner(t, k));
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
    if (attempt.pinch) o.pinch_below = kPinchAngle * options_.least_angle;
    if (attempt.reach > 0)
      o.locked = lock_good_regions(piece_, size_, attempt.reach * options_.edge_length);
    else
      o.iterations = 0;
    if (options_.edge_per_thickness > 0 || attempt.tips < 1) o.size = lengths_of(attempt);
    return o;
  }

  std::vector<Real> lengths_of(const Attempt& attempt) const {
    std::vector<Real> size = size_;
    for (std::size_t v = 0; v < size.size(); ++v) {
      size[v] *= attempt.finer;
      if (attempt.tips == attempt.finer) continue;
      for (const Vec3& p : poor_)
        size[v] = std::min(size[v], attempt.tips * size_[v] + kTipGrowth * distance(piece_.vertices[v], p));
    }
    return size;
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
      const Real angle = angle_of(piece_, t);
      least = std::min(least, angle), report_.below_1 += angle < 1, report_.below_15 += angle < 15;
    }
    report_.min_angle = piece_.triangles.empty() ? 0 : least;
  }

  static Real angle_of(const SurfaceMesh& mesh, std::size_t t) {  // degrees
    return smallest_angle({mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)}) * (180 / std::numbers::pi);
  }

  const SurfaceMesh& piece_;
  const RefitOptions& options_;
  SurfaceMesh& out_;
  Real volume_, largest_change_ = 0;  // m^3, of what is accepted at all
  Real least_change_ = 0;             // of what was adopted
  Real triangles_left_ = 0;           // of those that attempts with finer edges may make
  std::vector<Real> size_;            // as asked for, one a vertex of the piece
  std::vector<Vec3> poor_;            // corners of triangles that attempts left poor
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
