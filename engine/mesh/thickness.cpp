#include "engine/mesh/thickness.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "engine/mesh/embree_scene.h"
#include "kernels/core/error.h"
#include "kernels/core/parallel.h"

namespace sherd {
namespace {

constexpr Real kInfinity = std::numeric_limits<Real>::infinity();
constexpr Real kDegree = std::numbers::pi / 180;
constexpr Real kStep = 2e-6;    // of the box diagonal: beyond a hit to be passed over, above Embree's float error
constexpr int kMostPasses = 8;  // hits passed over before a ray is given up

void check(const ThicknessOptions& o) {
  if (!(o.parallel_angle > 0 && o.parallel_angle < 90))
    throw InputError(fmt::format("thickness: parallel_angle is {}; give degrees in (0, 90)", o.parallel_angle));
  if (!(o.cone_angle >= 0 && o.cone_angle < 60))
    throw InputError(fmt::format("thickness: cone_angle is {}; give degrees in [0, 60)", o.cone_angle));
  if (o.cone_rays < 0 || o.cone_rays > 1000)
    throw InputError(fmt::format("thickness: cone_rays is {}; give 0 to 1000", o.cone_rays));
  if (!(o.tip_ratio > 1)) throw InputError(fmt::format("thickness: tip_ratio is {}; give more than 1", o.tip_ratio));
  if (!(o.feature_angle > 0 && o.feature_angle <= 180))
    throw InputError(fmt::format("thickness: feature_angle is {}; give degrees in (0, 180]", o.feature_angle));
}

struct Caster {
  const SurfaceMesh& mesh;
  const std::vector<Vec3>& normal;
  const EmbreeScene scene;
  Real step;          // metres
  Real cos_parallel;  // of the largest angle between the two sides of a wall

  // Length to the far side along the unit vector d from a point of `face`; infinity when it is no wall's.
  Real across(std::size_t face, const Vec3& origin, const Vec3& d) const {
    Real t_min = 0;
    for (int pass = 0; pass < kMostPasses; ++pass) {
      const EmbreeScene::Hit hit = scene.first_hit(origin, d, t_min);
      if (hit.face == kNone) return kInfinity;
      // A ray that starts a rounding error outside enters through its own face first; only leaving the solid counts.
      if (hit.face != face && hit.t > 0 && dot(d, normal[hit.face]) > 0)
        return dot(normal[face], normal[hit.face]) <= -cos_parallel ? hit.t : kInfinity;
      t_min = std::max(t_min, hit.t) + step;
    }
    return kInfinity;
  }
};

std::vector<Vec3> unit_normals(const SurfaceMesh& mesh) {
  std::vector<Vec3> normal(mesh.triangle_count());
  for (std::size_t t = 0; t < normal.size(); ++t) normal[t] = normalized(mesh.area_normal2(t));
  return normal;
}

// In terms of (tangent, other tangent, inward normal).
std::vector<Vec3> cone(const ThicknessOptions& o) {
  std::vector<Vec3> directions;
  const Real s = std::sin(o.cone_angle * kDegree), c = std::cos(o.cone_angle * kDegree);
  for (int k = 0; k < o.cone_rays; ++k) {
    const Real azimuth = 2 * std::numbers::pi * k / o.cone_rays;
    directions.push_back({s * std::cos(azimuth), s * std::sin(azimuth), c});
  }
  return directions;
}

// Faces in tips are no walls: judged by the values as measured, so that one tip does not eat into the wall behind it.
void drop_tips(const SurfaceMesh& mesh, const std::vector<Vec3>& normal, const ThicknessOptions& o,
               std::vector<Real>& thickness) {
  const std::vector<std::uint32_t> twin = build_twins(mesh);
  const std::vector<Real> measured = thickness;
  const Real cos_feature = std::cos(o.feature_angle * kDegree);
  for (std::size_t h = 0; h < twin.size(); ++h) {
    if (twin[h] == kNone) continue;
    const std::size_t f = h / 3, g = twin[h] / 3;
    if (measured[g] < kInfinity && measured[g] > o.tip_ratio * measured[f] && dot(normal[f], normal[g]) >= cos_feature)
      thickness[f] = kInfinity;
  }
}

}  // namespace

WallThickness wall_thickness(const SurfaceMesh& mesh, const ThicknessOptions& options) {
  check(options);
  WallThickness result;
  result.face.assign(mesh.triangle_count(), kInfinity);
  result.vertex.assign(mesh.vertex_count(), kInfinity);
  const std::vector<Vec3> normal = unit_normals(mesh);
  const Caster caster{mesh, normal, EmbreeScene(mesh), kStep * bounding_box(mesh).diagonal(),
                      std::cos(options.parallel_angle * kDegree)};
  const std::vector<Vec3> directions = cone(options);
  parallel_for(mesh.triangle_count(), 64, [&](std::size_t f) {
    const Vec3 inward = -normal[f];
    if (!(norm2(inward) > 0)) return;
    const Vec3 a = any_perpendicular(inward), b = cross(inward, a), origin = mesh.centroid(f);
    const auto ray = [&](const Vec3& d) { return caster.across(f, origin, a * d.x + b * d.y + inward * d.z); };
    result.face[f] = caster.across(f, origin, inward);
    if (result.face[f] < kInfinity) return;
    for (const Vec3& d : directions) result.face[f] = std::min(result.face[f], ray(d));
  });
  drop_tips(mesh, normal, options, result.face);
  for (std::size_t f = 0; f < mesh.triangle_count(); ++f)
    for (const std::uint32_t v : mesh.triangles[f]) result.vertex[v] = std::min(result.vertex[v], result.face[f]);
  return result;
}

std::vector<Real> local_edge_length(const SurfaceMesh& mesh) {
  std::vector<Real> area(mesh.vertex_count(), 0), count(mesh.vertex_count(), 0), edge(mesh.triangle_count());
  for (std::size_t f = 0; f < edge.size(); ++f) {
    const Real a = 0.5 * norm(mesh.area_normal2(f));
    for (const std::uint32_t v : mesh.triangles[f]) area[v] += a, count[v] += 1;
  }
  for (std::size_t f = 0; f < edge.size(); ++f) {
    Real mean = 0;
    for (const std::uint32_t v : mesh.triangles[f]) mean += area[v] / count[v] / 3;
    edge[f] = std::sqrt(4 / std::sqrt(3.0) * mean);
  }
  return edge;
}

}  // namespace sherd
