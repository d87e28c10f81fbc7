#include "engine/load/applied_load.h"

#include "kernels/core/error.h"

namespace sherd {
namespace {

using Corners = std::array<Vec3, 3>;

Corners corners_of(const SurfaceMesh& mesh, std::size_t t) {
  return {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
}

Real polygon_area(const std::vector<Vec3>& p) {
  Vec3 sum;
  for (std::size_t i = 2; i < p.size(); ++i) sum += cross(p[i - 1] - p[0], p[i] - p[0]);
  return 0.5 * norm(sum);
}

// Keeps the part of the polygon with sign * p[axis] <= sign * bound (Sutherland and Hodgman 1974).
std::vector<Vec3> clipped(const std::vector<Vec3>& polygon, int axis, Real bound, Real sign) {
  std::vector<Vec3> out;
  const auto depth = [&](const Vec3& p) { return sign * (bound - p[axis]); };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const Real da = depth(a), db = depth(b);
    if (da >= 0) out.push_back(a);
    if ((da > 0 && db < 0) || (da < 0 && db > 0)) out.push_back(a + (b - a) * (da / (da - db)));
  }
  return out;
}

// Share of the face's area that bears the load.
Real share(const SurfaceMesh& mesh, std::size_t t, const Box& box, const Vec3& facing) {
  if (mesh.faces.kind.size() > t && mesh.faces.kind[t] != FaceKind::kOriginal) return 0;
  const Vec3 normal2 = mesh.area_normal2(t);
  const Real area2 = norm(normal2);
  if (area2 <= 0 || dot(normal2, facing) < std::sqrt(0.5) * area2 * norm(facing)) return 0;
  const Corners c = corners_of(mesh, t);
  std::vector<Vec3> polygon(c.begin(), c.end());
  for (int axis = 0; axis < 3 && !polygon.empty(); ++axis)
    polygon = clipped(clipped(polygon, axis, box.high[axis], 1), axis, box.low[axis], -1);
  return polygon.size() < 3 ? 0 : std::min(1.0, polygon_area(polygon) / (0.5 * area2));
}

struct Midpoints {
  Corners at;
  Real weight;  // of each: exact for quadratics over the face, the share included
};
std::vector<Midpoints> loaded_faces(const SurfaceMesh& mesh, const AppliedLoad& load) {
  std::vector<Midpoints> faces;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Real part = share(mesh, t, load.region, load.facing);
    if (part <= 0) continue;
    const Corners c = corners_of(mesh, t);
    faces.push_back(
        {{0.5 * (c[0] + c[1]), 0.5 * (c[1] + c[2]), 0.5 * (c[2] + c[0])}, part * norm(mesh.area_normal2(t)) / 6});
  }
  return faces;
}

}  // namespace

AppliedTraction spread(const SurfaceMesh& mesh, const AppliedLoad& load) {
  const std::vector<Midpoints> faces = loaded_faces(mesh, load);
  Real area = 0;
  Vec3 centre;
  for (const Midpoints& f : faces)
    for (const Vec3& x : f.at) area += f.weight, centre += x * f.weight;
  if (!(area > 0))
    throw InputError(
        fmt::format("a load's region ({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g}) m holds no part of the "
                    "surface; give a box around the loaded faces in the mesh's own coordinates",
                    load.region.low.x, load.region.low.y, load.region.low.z, load.region.high.x, load.region.high.y,
                    load.region.high.z));
  centre = centre / area;
  Mat3 second;  // of the loaded area: the couple of twist x d is second * twist
  for (const Midpoints& f : faces)
    for (const Vec3& x : f.at) {
      const Vec3 d = x - centre;
      second += (Mat3::identity() * norm2(d) - outer(d, d)) * f.weight;
    }
  AppliedTraction t{load.region, load.facing, load.force / area, {}, centre};
  if (load.moment != Vec3{}) t.twist = inverse(second) * load.moment;
  return t;
}

Real add_traction(const SurfaceMesh& mesh, const AppliedTraction& traction, Load& load) {
  if (load.quadratic_traction.empty()) load.quadratic_traction.resize(6 * mesh.triangle_count());
  Real area = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Real part = share(mesh, t, traction.region, traction.facing);
    if (part <= 0) continue;
    area += part * 0.5 * norm(mesh.area_normal2(t));
    const Corners c = corners_of(mesh, t);
    for (std::size_t k = 0; k < 6; ++k) {
      const Vec3 x = k < 3 ? c[k] : 0.5 * (c[k - 3] + c[(k - 2) % 3]);
      load.quadratic_traction.add(6 * t + k, (traction.uniform + cross(traction.twist, x - traction.centre)) * part);
    }
  }
  return area;
}

}  // namespace sherd
