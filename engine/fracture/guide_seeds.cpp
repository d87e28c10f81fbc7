#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "engine/fracture/guide_shape.h"

namespace sherd {
namespace {

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

// Higher is better: the first fan must lie on the guide, not over a crease, and squarely in the body.
int fitness(const Guide& guide, const Crossing& c) {
  constexpr Real kSquare = 0.7;
  const Vec3 inward = normalized(dot(c.normal, c.across) * c.across - c.normal);
  const bool on_guide = guide.nearest(c.point + guide.edge_length() * inward).beyond == 0;
  return (on_guide ? 4 : 0) + (c.smooth ? 2 : 0) + (c.sine > kSquare ? 1 : 0);
}

// Whether a first fan there (seed.cpp) has a third of its nodes in the body: tips and edges are thinner than a fan.
bool has_room(const TriangleBvh& body, const Crossing& c, Real edge_length) {
  constexpr int kDirections = 9;
  constexpr Real kFan = 0.7;  // of the edge length
  const Vec3 inward = normalized(dot(c.normal, c.across) * c.across - c.normal), side = cross(c.across, inward);
  int inside = 0;
  for (int k = 0; k < kDirections; ++k) {
    const Real angle = k * 2 * std::numbers::pi / kDirections;
    inside += body.inside(c.point + kFan * edge_length * (std::cos(angle) * inward + std::sin(angle) * side));
  }
  return 3 * inside >= kDirections;
}

}  // namespace

std::vector<CrackSeed> guide_seeds(const Guide& guide, const TriangleBvh& surface, const TriangleBvh& body,
                                   const SurfaceMesh& mesh, const Vec3& reference) {
  constexpr int kTries = 64;  // places of a curve that are looked at closely
  const auto nearer = [&](const Vec3& a, const Vec3& b) { return distance2(a, reference) < distance2(b, reference); };
  struct Candidate {
    int fitness;
    Crossing place;
  };
  std::map<std::size_t, std::vector<Candidate>> curves;
  for (const Crossing& c : find_crossings(mesh, guide.surface(), surface))
    curves[c.curve].push_back({fitness(guide, c), c});
  std::vector<CrackSeed> seeds;
  for (auto& [curve, places] : curves) {
    std::stable_sort(places.begin(), places.end(), [&](const Candidate& a, const Candidate& b) {
      return a.fitness != b.fitness ? a.fitness > b.fitness : nearer(a.place.point, b.place.point);
    });
    const auto end = places.begin() + std::min<std::ptrdiff_t>(kTries, std::ssize(places));
    auto chosen = std::find_if(places.begin(), end,
                               [&](const Candidate& c) { return has_room(body, c.place, guide.edge_length()); });
    if (chosen == end) chosen = places.begin();  // growth says why it cannot start
    const Crossing& place = chosen->place;
    seeds.push_back({.position = place.point, .normal = place.normal, .stress = {0, place.across}});
  }
  std::stable_sort(seeds.begin(), seeds.end(),
                   [&](const CrackSeed& a, const CrackSeed& b) { return nearer(a.position, b.position); });
  return seeds;
}

}  // namespace sherd
