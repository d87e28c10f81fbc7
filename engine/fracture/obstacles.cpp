#include "engine/fracture/obstacles.h"

namespace sherd {
namespace {

constexpr Real kAlongCosine = 0.7;  // sheets less than 45 degrees apart lie along each other

Vec3 face_normal(const TriangleBvh& tree, std::uint32_t face) {
  const auto& c = tree.corners(face);
  return normalized(cross(c[1] - c[0], c[2] - c[0]));
}

}  // namespace

bool lies_across(const Vec3& normal, const Vec3& other) {
  return std::abs(dot(normal, other)) < kAlongCosine;
}

void Obstacles::add_sheet(std::int32_t crack, const CrackSheet& sheet) {
  SurfaceMesh mesh;
  mesh.vertices = sheet.position;
  mesh.triangles = sheet.triangles;
  sheets_.push_back({crack, std::make_shared<TriangleBvh>(mesh)});
}

void Obstacles::set_walls(const SurfaceMesh& body) {
  SurfaceMesh mesh;
  mesh.vertices = body.vertices;
  for (std::size_t t = 0; t < body.triangle_count(); ++t)
    if (body.faces.kind[t] == FaceKind::kCrack) mesh.triangles.push_back(body.triangles[t]);
  walls_ = mesh.triangles.empty() ? nullptr : std::make_shared<TriangleBvh>(mesh);
}

bool Obstacles::first_hit(const Vec3& from, const Vec3& direction, Real length, const Vec3& plane, Hit& hit) const {
  bool found = false;
  std::vector<TriangleBvh::Hit> hits;
  for (const Sheet& sheet : sheets_) {
    sheet.tree->all_hits(from, direction, 0, found ? hit.t : length, hits);
    for (const TriangleBvh::Hit& h : hits) {
      const Vec3 normal = face_normal(*sheet.tree, h.face);
      if (!lies_across(normal, plane) || (found && h.t >= hit.t)) continue;
      hit = {h.t, sheet.crack, normal};
      found = true;
      break;
    }
  }
  return found;
}

bool Obstacles::nearest_wall(const Vec3& x, Real reach, Vec3& point) const {
  if (!walls_) return false;
  const TriangleBvh::Closest c = walls_->closest(x, reach);
  if (c.face == kNone) return false;
  point = c.point;
  return true;
}

}  // namespace sherd
