#include "engine/fracture/guide_shape.h"

#include <algorithm>

namespace sherd {
namespace {

// The line swept from `over` outside to `depth` inside, two vertices a point.
SurfaceMesh curtain(const GuideLine& line, Real over, Real depth) {
  SurfaceMesh mesh;
  for (const Vec3& p : line.points) {
    mesh.vertices.push_back(p - over * line.inward);
    mesh.vertices.push_back(p + depth * line.inward);
  }
  for (std::uint32_t i = 0; i + 1 < line.points.size(); ++i) {
    const std::uint32_t v = 2 * i;
    mesh.add_triangle(v, v + 1, v + 3);
    mesh.add_triangle(v, v + 3, v + 2);
  }
  return mesh;
}

// Two triangles across the whole body.
SurfaceMesh plane_across(const GuidePlane& plane, const Box& box) {
  const Vec3 n = plane.normal, centre = box.centre() - dot(box.centre() - plane.point, n) * n;
  const Vec3 axis = std::abs(n.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 u = box.diagonal() * normalized(cross(n, axis)), v = cross(n, u);
  SurfaceMesh mesh;
  for (const Vec3& p : {centre - u - v, centre + u - v, centre + u + v, centre - u + v}) mesh.vertices.push_back(p);
  mesh.add_triangle(0, 1, 2);
  mesh.add_triangle(0, 2, 3);
  return mesh;
}

Vec3 middle_of(const std::vector<Vec3>& points) {
  Real length = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) length += distance(points[i], points[i + 1]);
  Real left = 0.5 * length;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Real segment = distance(points[i], points[i + 1]);
    if (left <= segment && segment > 0) return points[i] + left / segment * (points[i + 1] - points[i]);
    left -= segment;
  }
  return points.empty() ? Vec3{} : points.back();
}

Vec3 area_centre(const SurfaceMesh& mesh) {
  Vec3 sum;
  Real area = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Real a = norm(mesh.area_normal2(t));
    sum += a * mesh.centroid(t), area += a;
  }
  return area > 0 ? sum / area : Vec3{};
}

}  // namespace

std::optional<GuideLine> surface_line(const GuidePlane& plane, const TriangleBvh& body) {
  const TriangleBvh::Closest c = body.closest(plane.point);
  if (c.face == kNone) return std::nullopt;
  // The plane need not pass through that place exactly: the foot on the plane counts.
  const Vec3 foot = c.point - dot(c.point - plane.point, plane.normal) * plane.normal;
  const auto& t = body.corners(c.face);
  const Vec3 outward = normalized(cross(t[1] - t[0], t[2] - t[0]));
  const Vec3 inward = dot(outward, plane.normal) * plane.normal - outward;
  constexpr Real kLeastSine = 0.1;
  if (norm(inward) < kLeastSine) return std::nullopt;
  const Vec3 along = body.box().diagonal() * normalized(cross(plane.normal, inward));
  return GuideLine{{foot - along, foot, foot + along}, normalized(inward)};
}

GuideSpec pinned(const GuideSpec& spec, const TriangleBvh& body) {
  const auto* plane = std::get_if<GuidePlane>(&spec);
  if (!plane || plane->depth == 0) return spec;
  const std::optional<GuideLine> line = surface_line(*plane, body);
  if (!line) return spec;
  return GuidePolyline{line->points, line->inward, plane->depth};
}

Real overhang(const GuideLine& line, Real edge_length) {
  Real longest = 0;
  for (std::size_t i = 0; i + 1 < line.points.size(); ++i)
    longest = std::max(longest, distance(line.points[i], line.points[i + 1]));
  return 2 * edge_length + 0.5 * longest;  // the surface between the points rises at most as a half circle over them
}

GuideShape guide_shape(const GuideSpec& spec, const TriangleBvh& body, Real edge_length) {
  const Real across = body.box().diagonal();
  if (const auto* plane = std::get_if<GuidePlane>(&spec)) {
    if (plane->depth == 0) return {plane_across(*plane, body.box()), body.closest(plane->point).point};
    const std::optional<GuideLine> line = surface_line(*plane, body);
    if (!line) return {};
    return {curtain(*line, across, plane->depth), line->points[1]};
  }
  if (const auto* drawn = std::get_if<GuidePolyline>(&spec)) {
    const GuideLine line{drawn->points, drawn->inward};
    return {curtain(line, overhang(line, edge_length), drawn->depth > 0 ? drawn->depth : across),
            middle_of(line.points)};
  }
  const SurfaceMesh& surface = std::get<SurfaceMesh>(spec);
  return {surface, area_centre(surface)};
}

}  // namespace sherd
