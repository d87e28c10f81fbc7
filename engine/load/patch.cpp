#include "engine/load/patch.h"

#include <algorithm>

namespace sherd {
namespace {

Real weight(const ContactPatch& p, const Vec3& x) {
  const Real s = distance2(x, p.centre) / (p.radius * p.radius);
  return s < 1 ? std::sqrt(1 - s) : 0;
}

// Calls visit(corners, area, weight at centroid) for every panel of a face.
template <class F>
void for_each_panel(const ContactPatch& p, const std::array<Vec3, 3>& c, int depth, const F& visit) {
  const Real size2 = std::max({distance2(c[0], c[1]), distance2(c[1], c[2]), distance2(c[2], c[0])});
  const Vec3 centre = (c[0] + c[1] + c[2]) / 3.0;
  const Real reach = p.radius + std::sqrt(size2);
  if (distance2(centre, p.centre) > reach * reach) return;
  if (size2 * 9 > p.radius * p.radius && depth > 0) {
    const Vec3 m0 = 0.5 * (c[0] + c[1]), m1 = 0.5 * (c[1] + c[2]), m2 = 0.5 * (c[2] + c[0]);
    for (const std::array<Vec3, 3>& s : {std::array{c[0], m0, m2}, {m0, c[1], m1}, {m2, m1, c[2]}, {m0, m1, m2}})
      for_each_panel(p, s, depth - 1, visit);
    return;
  }
  const Real w = weight(p, centre);
  if (w > 0) visit(c, 0.5 * norm(cross(c[1] - c[0], c[2] - c[0])), w);
}

constexpr int kMaxDepth = 10;  // a face a thousand times the patch

std::array<Vec3, 3> corners_of(const SurfaceMesh& mesh, std::uint32_t f) {
  return {mesh.corner(f, 0), mesh.corner(f, 1), mesh.corner(f, 2)};
}

Real integrate_weight(const SurfaceMesh& mesh, const ContactPatch& p) {
  Real sum = 0;
  for (const std::uint32_t f : p.faces)
    for_each_panel(p, corners_of(mesh, f), kMaxDepth, [&](const auto&, Real area, Real w) { sum += area * w; });
  return sum;
}

}  // namespace

ContactPatch make_patch(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& twins, const TriangleBvh& bvh,
                        const Vec3& centre, Real radius, const Vec3& force) {
  const TriangleBvh::Closest start = bvh.closest(centre);
  ContactPatch p;
  p.centre = start.point, p.radius = radius, p.force = force;
  p.axis = normalized(mesh.area_normal2(start.face));
  std::vector<std::uint32_t> stack{start.face};
  std::vector<bool> seen(mesh.triangle_count(), false);
  seen[start.face] = true;
  p.faces = stack;
  while (!stack.empty()) {
    const std::uint32_t f = stack.back();
    stack.pop_back();
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t e = twins[3 * f + k];
      if (e == kNone) continue;
      const std::uint32_t g = e / 3;
      if (seen[g]) continue;
      seen[g] = true;
      const Vec3 q = closest_point_on_triangle(p.centre, mesh.corner(g, 0), mesh.corner(g, 1), mesh.corner(g, 2));
      if (distance2(q, p.centre) >= radius * radius || dot(mesh.area_normal2(g), p.axis) <= 0) continue;
      p.faces.push_back(g), stack.push_back(g);
    }
  }
  std::sort(p.faces.begin(), p.faces.end());
  p.normalisation = integrate_weight(mesh, p);
  if (p.normalisation <= 0) {  // below resolution: the whole closest face carries the force
    p.faces.assign(1, start.face);
    p.radius = std::sqrt(norm(mesh.area_normal2(start.face)));
    p.normalisation = integrate_weight(mesh, p);
  }
  return p;
}

ContactPatch patch_part(const SurfaceMesh& piece, const ContactPatch& whole) {
  ContactPatch p = whole;
  p.faces.clear();
  for (std::uint32_t f = 0; f < piece.triangle_count(); ++f) {
    if (piece.faces.kind[f] != FaceKind::kOriginal || dot(piece.area_normal2(f), whole.axis) <= 0) continue;
    const Vec3 q = closest_point_on_triangle(whole.centre, piece.corner(f, 0), piece.corner(f, 1), piece.corner(f, 2));
    if (distance2(q, whole.centre) < whole.radius * whole.radius) p.faces.push_back(f);
  }
  p.normalisation = integrate_weight(piece, p);
  p.force = whole.force * (p.normalisation / whole.normalisation);
  return p;
}

void append_panels(const SurfaceMesh& mesh, const ContactPatch& patch, TractionPanels& panels) {
  for (const std::uint32_t f : patch.faces)
    for_each_panel(patch, corners_of(mesh, f), kMaxDepth, [&](const std::array<Vec3, 3>& c, Real, Real w) {
      panels.corners.push_back(c);
      panels.traction.push_back(patch.force * (w / patch.normalisation));
      panels.face.push_back(f);
    });
}

std::array<Real, 6> quadratic_shape(Real s, Real t) {
  const Real r = 1 - s - t;
  return {r * (2 * r - 1), s * (2 * s - 1), t * (2 * t - 1), 4 * r * s, 4 * s * t, 4 * t * r};
}

Vec3 traction_at(const Load& load, const SurfaceMesh& mesh, const Vec3& x, std::uint32_t face) {
  Vec3 t = load.face_traction.empty() ? Vec3{} : load.face_traction[face];
  for (const ContactPatch& p : load.patches)
    if (std::binary_search(p.faces.begin(), p.faces.end(), face)) t += p.force * (weight(p, x) / p.normalisation);
  if (load.quadratic_traction.empty()) return t;
  const Vec3 a = mesh.corner(face, 0), e1 = mesh.corner(face, 1) - a, e2 = mesh.corner(face, 2) - a, d = x - a;
  const Real g11 = dot(e1, e1), g12 = dot(e1, e2), g22 = dot(e2, e2), det = g11 * g22 - g12 * g12;
  const Real d1 = dot(d, e1), d2 = dot(d, e2);
  const std::array<Real, 6> shape = quadratic_shape((g22 * d1 - g12 * d2) / det, (g11 * d2 - g12 * d1) / det);
  for (std::size_t k = 0; k < shape.size(); ++k) t += load.quadratic_traction[6 * face + k] * shape[k];
  return t;
}

}  // namespace sherd
