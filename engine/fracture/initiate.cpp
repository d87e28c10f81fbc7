#include "engine/fracture/initiate.h"

#include <algorithm>
#include <numeric>

namespace sherd {
namespace {

// Seeds at vertices. At a reentrant crease (a notch's tip, a cavity's inner edge) the stress on either side is that of
// a free surface, along the side, while the crack opens by the stress between them: there the seed asks just below.
class SeedMaker {
 public:
  SeedMaker(const SurfaceMesh& mesh, const SurfaceRecovery& recovery, const StressState& state)
      : mesh_(mesh),
        recovery_(recovery),
        state_(state),
        outward_(mesh.vertex_count()),
        reentrant_(mesh.vertex_count()) {
    constexpr Real kCrease = 0.82;  // cosine of 35 degrees, as between smooth groups
    for (const StressCorner& corner : recovery.corners()) outward_.add(corner.vertex, corner.normal);
    const std::vector<std::uint32_t> twin = build_twins(mesh);
    for (std::uint32_t e = 0; e < twin.size(); ++e) {
      if (twin[e] == kNone) continue;
      const Triangle& t = mesh.triangles[e / 3];
      const std::uint32_t a = t[e % 3], b = t[(e + 1) % 3];
      const std::uint32_t across = mesh.triangles[twin[e] / 3][(twin[e] % 3 + 2) % 3];
      const Vec3 n = normalized(mesh.area_normal2(e / 3)), m = normalized(mesh.area_normal2(twin[e] / 3));
      if (dot(n, m) < kCrease && dot(n, mesh.vertices[across] - mesh.vertices[a]) > 0)
        reentrant_[a] = reentrant_[b] = 1;
    }
  }

  CrackSeed at(std::uint32_t vertex) const {
    const std::uint32_t corner = state_.worst_corner(vertex);
    const Eigen3 e = eigen_symmetric(state_.corner_stress()[corner]);
    CrackSeed seed{mesh_.vertices[vertex], recovery_.corners()[corner].normal, {e.value[0], e.vector[0]}, vertex};
    const Vec3 outward = normalized(outward_[vertex]);
    if (!reentrant_[vertex] || norm2(outward) == 0) return seed;
    constexpr Real kBelow = 0.5;  // of the edge length: within the first fan of the crack
    Vec3Column place;
    place.push_back(seed.position - kBelow * edge_length(vertex) * outward);
    std::vector<Sym3> stress;
    state_.evaluate(place, stress);
    const Eigen3 below = eigen_symmetric(stress[0]);
    if (!(below.value[0] > 0)) return seed;
    seed.normal = outward;
    seed.stress = {std::max(seed.stress.value, below.value[0]), below.vector[0]};
    return seed;
  }

 private:
  // Mean over the edges of the faces around a vertex.
  Real edge_length(std::uint32_t vertex) const {
    Real sum = 0, count = 0;
    for (const Triangle& t : mesh_.triangles)
      for (std::size_t k = 0; k < 3; ++k)
        if (t[k] == vertex) sum += distance(mesh_.vertices[vertex], mesh_.vertices[t[(k + 1) % 3]]), count += 1;
    return count > 0 ? sum / count : 0;
  }

  const SurfaceMesh& mesh_;
  const SurfaceRecovery& recovery_;
  const StressState& state_;
  Vec3Column outward_;  // sum of the normals of a vertex's smooth groups
  std::vector<std::uint8_t> reentrant_;
};

// Largest principal stress over strength per vertex; 0 where there is no stress.
std::vector<Real> relative_stress(const SurfaceMesh& mesh, const StressState& state, const ScalarField& strength) {
  std::vector<Real> value(mesh.vertex_count(), 0);
  for (std::uint32_t v = 0; v < value.size(); ++v)
    if (const std::uint32_t corner = state.worst_corner(v); corner != kNone)
      value[v] = eigen_symmetric(state.corner_stress()[corner]).value[0] / strength.at(mesh.vertices[v]);
  return value;
}

// Vertices that share an edge with a vertex: neighbour[first[v]] .. neighbour[first[v + 1]], each at least once.
struct Rings {
  explicit Rings(const SurfaceMesh& mesh) : first(mesh.vertex_count() + 1, 0) {
    for (const Triangle& t : mesh.triangles)
      for (const std::uint32_t v : t) first[v + 1] += 2;
    std::partial_sum(first.begin(), first.end(), first.begin());
    neighbour.resize(first.back());
    std::vector<std::size_t> end(first.begin(), first.end() - 1);
    for (const Triangle& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k)
        neighbour[end[t[k]]++] = t[(k + 1) % 3], neighbour[end[t[k]]++] = t[(k + 2) % 3];
  }
  std::span<const std::uint32_t> of(std::uint32_t v) const {
    return std::span(neighbour).subspan(first[v], first[v + 1] - first[v]);
  }
  std::vector<std::size_t> first;
  std::vector<std::uint32_t> neighbour;
};

class PeakFinder {
 public:
  PeakFinder(const SurfaceMesh& mesh, std::span<const Real> value)
      : mesh_(mesh), value_(value), rings_(mesh), visit_(mesh.vertex_count(), kNone) {}

  // The plateau of v; empty when v is not its highest vertex. `least`: lower bound of the plateau.
  std::vector<std::uint32_t> plateau(std::uint32_t v, Real least) {
    const Real floor = std::max(least, (1 - kPlateau) * value_[v]);
    std::vector<std::uint32_t> flooded{v};
    visit_[v] = v;
    for (std::size_t i = 0; i < flooded.size(); ++i)
      for (const std::uint32_t w : rings_.of(flooded[i])) {
        if (higher(w, v)) return {};
        if (visit_[w] == v || !(value_[w] >= floor)) continue;
        visit_[w] = v;
        flooded.push_back(w);
      }
    return flooded;
  }
  bool higher(std::uint32_t a, std::uint32_t b) const { return value_[a] != value_[b] ? value_[a] > value_[b] : a < b; }
  std::uint32_t middle(const std::vector<std::uint32_t>& plateau) const {
    Vec3 centre;
    for (const std::uint32_t v : plateau) centre += mesh_.vertices[v] / static_cast<Real>(plateau.size());
    const auto nearer = [&](std::uint32_t a, std::uint32_t b) {
      const Real da = distance2(mesh_.vertices[a], centre), db = distance2(mesh_.vertices[b], centre);
      return da != db ? da < db : a < b;
    };
    return *std::min_element(plateau.begin(), plateau.end(), nearer);
  }

 private:
  const SurfaceMesh& mesh_;
  std::span<const Real> value_;
  Rings rings_;
  std::vector<std::uint32_t> visit_;  // the last peak whose flood reached the vertex
};

}  // namespace

void StressCrackField::principal_stress(const Vec3Column& points, std::vector<PrincipalStress>& out) const {
  std::vector<Sym3> stress;
  state_.evaluate(points, stress);
  out.resize(points.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Eigen3 e = eigen_symmetric(stress[i]);
    out[i] = {e.value[0], e.vector[0]};
  }
}

std::vector<std::uint32_t> find_peaks(const SurfaceMesh& mesh, std::span<const Real> value, Real least) {
  PeakFinder finder(mesh, value);
  std::vector<std::uint32_t> order;
  for (std::uint32_t v = 0; v < value.size(); ++v)
    if (value[v] > least) order.push_back(v);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return finder.higher(a, b); });
  std::vector<std::uint32_t> peaks;
  for (const std::uint32_t v : order)
    if (const std::vector<std::uint32_t> plateau = finder.plateau(v, least); !plateau.empty())
      peaks.push_back(finder.middle(plateau));
  return peaks;
}

std::vector<CrackSeed> find_seeds(const SurfaceMesh& mesh, const SurfaceRecovery& recovery, const StressState& state,
                                  const ScalarField& strength) {
  const SeedMaker maker(mesh, recovery, state);
  std::vector<CrackSeed> seeds;
  for (const std::uint32_t v : find_peaks(mesh, relative_stress(mesh, state, strength), 1))
    seeds.push_back(maker.at(v));
  return seeds;
}

CrackSeed strongest_point(const SurfaceMesh& mesh, const SurfaceRecovery& recovery, const StressState& state,
                          const ScalarField& strength) {
  const std::vector<Real> value = relative_stress(mesh, state, strength);
  std::uint32_t best = kNone;
  for (std::uint32_t v = 0; v < value.size(); ++v)
    if (state.worst_corner(v) != kNone && (best == kNone || value[v] > value[best])) best = v;
  return best == kNone ? CrackSeed{} : SeedMaker(mesh, recovery, state).at(best);
}

}  // namespace sherd
