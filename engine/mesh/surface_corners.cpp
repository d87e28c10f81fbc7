#include "engine/mesh/surface_corners.h"

#include <algorithm>
#include <numbers>

namespace sherd {
namespace {

std::vector<std::uint32_t> smooth_twins(const SurfaceMesh& mesh, Real feature_angle) {
  std::vector<std::uint32_t> twin = build_twins(mesh);
  const Real angle = std::max(feature_angle, 0.01) * std::numbers::pi / 180;
  for (std::uint32_t e = 0; e < twin.size(); ++e)
    if (twin[e] != kNone && twin[e] > e) {
      const Vec3 a = normalized(mesh.area_normal2(e / 3)), b = normalized(mesh.area_normal2(twin[e] / 3));
      // atan2 resolves small angles, whose cosine is 1 to rounding.
      if (std::atan2(norm(cross(a, b)), dot(a, b)) > angle) twin[twin[e]] = kNone, twin[e] = kNone;
    }
  return twin;
}

}  // namespace

SurfaceCorners make_surface_corners(const SurfaceMesh& mesh, Real feature_angle) {
  SurfaceCorners out;
  out.smooth = smooth_twins(mesh, feature_angle);
  const std::vector<std::uint32_t>& smooth = out.smooth;
  out.of.assign(3 * mesh.triangle_count(), kNone);
  for (std::uint32_t e = 0; e < out.of.size(); ++e) {
    if (out.of[e] != kNone) continue;
    SurfaceCorner c;
    c.vertex = mesh.triangles[e / 3][e % 3];
    // Walk the smooth fan around the vertex both ways from this face.
    const auto id = static_cast<std::uint32_t>(out.corner.size());
    std::vector<std::uint32_t> stack{e};
    out.of[e] = id;
    while (!stack.empty()) {
      const std::uint32_t h = stack.back(), t = h / 3, k = h % 3;
      stack.pop_back();
      c.faces.push_back(t);
      const std::uint32_t next = smooth[3 * t + k], before = smooth[3 * t + (k + 2) % 3];
      for (const std::uint32_t candidate : {next == kNone ? kNone : 3 * (next / 3) + (next % 3 + 1) % 3, before})
        if (candidate != kNone && out.of[candidate] == kNone) out.of[candidate] = id, stack.push_back(candidate);
    }
    std::sort(c.faces.begin(), c.faces.end());
    out.corner.push_back(std::move(c));
  }
  return out;
}

}  // namespace sherd
