#include "engine/fracture/guide.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "engine/fracture/guide_shape.h"

namespace sherd {
namespace {

constexpr Real kLookAhead = 0.4;     // of h: about a step of a front; farther cuts corners, nearer overshoots
constexpr Real kBorderAhead = 0.25;  // of h: half a step, so that fronts stop within that of the guide's border

// A place where an edge of the body passes through the guide.
struct Crossing {
  Vec3 point, normal;  // of the body's surface; unit
  Vec3 across;         // normal of the guide
  Real sine = 0;       // of the angle between guide and surface
  bool smooth = true;  // the edge is no crease
  std::size_t curve = 0;
};

class Curves {
 public:
  explicit Curves(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t of(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t i, std::size_t j) { parent_[std::max(of(i), of(j))] = std::min(of(i), of(j)); }

 private:
  std::vector<std::size_t> parent_;
};

// Crossings of all edges of the mesh, in the order of their directed edges; those that share a face share a curve.
std::vector<Crossing> find_crossings(const SurfaceMesh& mesh, const SurfaceMesh& guide, const TriangleBvh& bvh) {
  constexpr Real kSmoothCosine = 0.82;  // 35 degrees, as between smooth groups of the surface
  const std::vector<std::uint32_t> twin = build_twins(mesh);
  std::vector<Crossing> found;
  std::vector<std::size_t> at(twin.size(), kNone);  // per directed edge
  std::vector<TriangleBvh::Hit> hits;
  for (std::uint32_t e = 0; e < twin.size(); ++e) {
    if (twin[e] == kNone || twin[e] < e) continue;
    const Triangle& t = mesh.triangles[e / 3];
    const Vec3 a = mesh.vertices[t[e % 3]], b = mesh.vertices[t[(e + 1) % 3]];
    bvh.all_hits(a, b - a, 0, 1, hits);
    if (hits.empty()) continue;
    const Vec3 n = normalized(mesh.area_normal2(e / 3)), m = normalized(mesh.area_normal2(twin[e] / 3));
    Crossing c;
    c.point = a + hits[0].t * (b - a);
    c.normal = normalized(n + m);
    c.across = normalized(guide.area_normal2(hits[0].face));
    c.smooth = dot(n, m) > kSmoothCosine;
    c.sine = norm(cross(c.across, c.normal));
    at[e] = at[twin[e]] = found.size();
    found.push_back(c);
  }
  Curves curves(found.size());
  for (std::size_t f = 0; f < mesh.triangle_count(); ++f)
    for (std::size_t k = 0; k < 3; ++k)
      if (const std::size_t i = at[3 * f + k], j = at[3 * f + (k + 1) % 3]; i != kNone && j != kNone) curves.join(i, j);
  for (std::size_t i = 0; i < found.size(); ++i) found[i].curve = curves.of(i);
  return found;
}

}  // namespace

Guide::Guide(const GuideSpec& spec, const TriangleBvh& body, const SurfaceMesh& mesh, Real edge_length)
    : Guide(guide_shape(spec, body, edge_length), mesh, edge_length) {}

Guide::Guide(GuideShape shape, const SurfaceMesh& mesh, Real edge_length)
    : edge_length_(edge_length), surface_(std::move(shape.surface)), bvh_(surface_) {
  const std::vector<std::uint32_t> twin = build_twins(surface_);
  border_edge_.resize(twin.size());
  border_vertex_.resize(surface_.vertex_count());
  for (std::size_t e = 0; e < twin.size(); ++e) {
    if (twin[e] != kNone) continue;
    const Triangle& t = surface_.triangles[e / 3];
    border_edge_[e] = border_vertex_[t[e % 3]] = border_vertex_[t[(e + 1) % 3]] = 1;
  }

  // The first fan of a crack must lie on the guide, and squarely in the body.
  constexpr Real kSquare = 0.7;
  const auto fit = [&](const Crossing& c) {
    const Vec3 inward = normalized(dot(c.normal, c.across) * c.across - c.normal);
    const bool on_guide = nearest(c.point + edge_length * inward).beyond == 0;
    return (on_guide ? 4 : 0) + (c.smooth ? 2 : 0) + (c.sine > kSquare ? 1 : 0);
  };
  std::map<std::size_t, std::pair<int, Crossing>> best;
  for (const Crossing& c : find_crossings(mesh, surface_, bvh_)) {
    const int fitness = fit(c);
    const auto [known, fresh] = best.try_emplace(c.curve, fitness, c);
    if (fresh) continue;
    const auto& [other, place] = known->second;
    if (fitness > other ||
        (fitness == other && distance2(c.point, shape.reference) < distance2(place.point, shape.reference)))
      known->second = {fitness, c};
  }
  for (const auto& [curve, chosen] : best)
    seeds_.push_back(
        {.position = chosen.second.point, .normal = chosen.second.normal, .stress = {0, chosen.second.across}});
  std::stable_sort(seeds_.begin(), seeds_.end(), [&](const CrackSeed& a, const CrackSeed& b) {
    return distance2(a.position, shape.reference) < distance2(b.position, shape.reference);
  });
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

PrincipalStress GuideField::at(const Vec3& x) const {
  const Real h = guide_.edge_length();
  const Guide::Place here = guide_.nearest(x);
  const Vec3 out = x - seed_.position, along = normalized(out - dot(out, here.normal) * here.normal);
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
  for (std::size_t i = 0; i < points.size(); ++i) out[i] = at(points[i]);
}

}  // namespace sherd
