#include "engine/fracture/guide.h"

#include <algorithm>
#include <cmath>

#include "engine/fracture/guide_shape.h"

namespace sherd {
namespace {

constexpr Real kLookAhead = 0.4;     // of h: about a step of a front; farther cuts corners, nearer overshoots
constexpr Real kBorderAhead = 0.25;  // of h: half a step, so that fronts stop within that of the guide's border

}  // namespace

Guide::Guide(const GuideSpec& spec, const TriangleBvh& body, const SurfaceMesh& mesh, Real edge_length)
    : Guide(guide_shape(spec, body, edge_length), body, mesh, edge_length) {}

Guide::Guide(GuideShape shape, const TriangleBvh& body, const SurfaceMesh& mesh, Real edge_length)
    : edge_length_(edge_length), surface_(std::move(shape.surface)), bvh_(surface_) {
  const std::vector<std::uint32_t> twin = build_twins(surface_);
  border_edge_.resize(twin.size());
  border_vertex_.resize(surface_.vertex_count());
  for (std::size_t e = 0; e < twin.size(); ++e) {
    if (twin[e] != kNone) continue;
    const Triangle& t = surface_.triangles[e / 3];
    border_edge_[e] = border_vertex_[t[e % 3]] = border_vertex_[t[(e + 1) % 3]] = 1;
  }
  seeds_ = guide_seeds(*this, bvh_, body, mesh, shape.reference);
}

std::vector<CrackSeed> Guide::seeds(Real strength) const {
  std::vector<CrackSeed> seeds = seeds_;
  for (CrackSeed& seed : seeds) seed.stress.value = strength;
  return seeds;
}

Guide::Place Guide::nearest(const Vec3& x) const {
  const TriangleBvh::Closest c = bvh_.closest(x);
  if (c.face == kNone) return {x, {}, 0};
  Place place{c.point, normalized(surface_.area_normal2(c.face)), 0};
  const auto& t = bvh_.corners(c.face);
  const Real near = 1e-9 * edge_length_;
  bool border = false;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const Vec3 a = t[k], b = t[(k + 1) % 3];
    border = border || (border_vertex_[surface_.triangles[c.face][k]] && distance(a, c.point) <= near) ||
             (border_edge_[3 * c.face + k] && norm(cross(normalized(b - a), c.point - a)) <= near);
  }
  const Vec3 away = x - c.point;
  if (border) place.beyond = norm(away - dot(away, place.normal) * place.normal);
  if (place.beyond <= near) place.beyond = 0;
  return place;
}

GuideDeviation deviation(const CrackSheet& sheet, const Guide& guide) {
  GuideDeviation d;
  std::size_t count = 0;
  for (std::size_t v = 0; v < sheet.position.size(); ++v) {
    if (sheet.state[v] == NodeState::kExited) continue;
    const Real off = distance(sheet.position[v], guide.nearest(sheet.position[v]).point);
    d.rms += off * off, d.largest = std::max(d.largest, off), ++count;
  }
  if (count > 0) d.rms = std::sqrt(d.rms / static_cast<Real>(count));
  return d;
}

PrincipalStress GuideField::at(const Vec3& x, const Vec3& heading) const {
  const Real h = guide_.edge_length();
  const Guide::Place here = guide_.nearest(x);
  const Vec3 out = norm2(heading) > 0 ? heading : x - seed_.position;
  const Vec3 along = normalized(out - dot(out, here.normal) * here.normal);
  if (guide_.nearest(x + kBorderAhead * h * along).beyond > 0) return {0, here.normal};
  if (norm2(along) == 0) return {strength_, here.normal};
  // Tangents of the way to the guide ahead, and of the guide across it.
  const Vec3 side = kLookAhead * h * cross(here.normal, along);
  const Vec3 ahead = guide_.nearest(x + kLookAhead * h * along).point - x;
  const Vec3 across = guide_.nearest(x + side).point - guide_.nearest(x - side).point;
  const Vec3 e = cross(ahead, across);
  // Beside a border the guide may leave no room for one of them.
  return {strength_, norm(e) > 0.05 * h * h ? normalized(e) : here.normal};
}

void GuideField::principal_stress(const Vec3Column& points, std::vector<PrincipalStress>& out) const {
  out.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) out[i] = at(points[i], {});
}

void GuideField::stress_ahead(const Vec3Column& points, const Vec3Column& headings,
                              std::vector<PrincipalStress>& out) const {
  out.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) out[i] = at(points[i], headings[i]);
}

}  // namespace sherd
