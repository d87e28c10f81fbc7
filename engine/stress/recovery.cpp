#include "engine/stress/recovery.h"

#include <algorithm>
#include <numbers>

#include "kernels/core/error.h"
#include "kernels/core/parallel.h"

namespace sherd {

SurfaceRecovery::SurfaceRecovery(const SurfaceMesh& mesh, const RecoveryOptions& options) {
  SHERD_CHECK(options.fit.degree >= 1 && options.fit.degree <= 4, "degree {}", options.fit.degree);
  const SurfaceCorners corners = make_surface_corners(mesh, options.feature_angle);
  corner_of_ = corners.of;
  corners_.resize(corners.corner.size());
  parallel_for(corners_.size(), 32, [&](std::size_t i) {
    const SurfaceFit fit(mesh, corners, i, options.fit);
    StressCorner& c = corners_[i];
    static_cast<SurfaceCorner&>(c) = corners.corner[i];
    c.tangent_x = fit.a() + fit.normal() * fit.slope_x(), c.tangent_y = fit.b() + fit.normal() * fit.slope_y();
    c.normal = normalized(cross(c.tangent_x, c.tangent_y));
    c.patch = fit.patch(), c.row_x = fit.row_x(), c.row_y = fit.row_y();
  });
  if (options.rims) rims_ = convex_rims(mesh, corners);
}

Sym3 surface_stress(const Mat3& g, const Vec3& n, const Vec3& t, const Elastic& m) {
  const Vec3 e1 = any_perpendicular(n), e2 = cross(n, e1);
  const Real e11 = dot(e1, g * e1), e22 = dot(e2, g * e2), e12 = 0.5 * (dot(e1, g * e2) + dot(e2, g * e1));
  const Real young = 2 * m.mu * (1 + m.nu), plane = young / (1 - m.nu * m.nu), tn = dot(t, n),
             pressure = m.nu / (1 - m.nu) * tn;
  const Real s11 = plane * (e11 + m.nu * e22) + pressure, s22 = plane * (e22 + m.nu * e11) + pressure,
             s12 = 2 * m.mu * e12;
  return symmetric_part(outer(e1, e1) * s11 + outer(e2, e2) * s22 + (outer(e1, e2) + outer(e2, e1)) * s12 +
                        outer(n, n) * tn + (outer(e1, n) + outer(n, e1)) * dot(t, e1) +
                        (outer(e2, n) + outer(n, e2)) * dot(t, e2));
}

std::vector<Sym3> SurfaceRecovery::stress(const Vec3Column& displacement, const Vec3Column& traction,
                                          const Elastic& m) const {
  std::vector<Sym3> out(corners_.size());
  std::vector<Mat3> gradient(corners_.size());
  parallel_for(corners_.size(), 256, [&](std::size_t i) {
    const StressCorner& c = corners_[i];
    Vec3 dx, dy;
    for (std::size_t k = 0; k < c.patch.size(); ++k) {
      const Vec3 u = displacement[c.patch[k]];
      dx += u * c.row_x[k], dy += u * c.row_y[k];
    }
    // Surface gradient G with G tangent_x = dx, G tangent_y = dy, G normal = 0.
    gradient[i] = Mat3::from_columns(dx, dy, Vec3{}) * inverse(Mat3::from_columns(c.tangent_x, c.tangent_y, c.normal));
    out[i] = surface_stress(gradient[i], c.normal, traction[i], m);
  });
  parallel_for(rims_.size(), 64, [&](std::size_t r) {
    std::vector<RimSide> sides;
    for (const std::uint32_t c : rims_[r]) sides.push_back({corners_[c].normal, traction[c], gradient[c]});
    Sym3 s;
    if (!rim_stress(sides, m, s)) return;
    for (const std::uint32_t c : rims_[r]) out[c] = s;
  });
  return out;
}

}  // namespace sherd
