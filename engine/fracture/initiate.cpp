#include "engine/fracture/initiate.h"

#include <algorithm>

namespace sherd {
namespace {

CrackSeed make_seed(const SurfaceMesh& mesh, const SurfaceRecovery& recovery, const StressState& state,
                    std::uint32_t vertex) {
  const std::uint32_t corner = state.worst_corner(vertex);
  const Eigen3 e = eigen_symmetric(state.corner_stress()[corner]);
  return {mesh.vertices[vertex], recovery.corners()[corner].normal, {e.value[0], e.vector[0]}, vertex};
}

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

std::vector<CrackSeed> find_seeds(const SurfaceMesh& mesh, const SurfaceRecovery& recovery, const StressState& state,
                                  Real strength) {
  const std::size_t n = mesh.vertex_count();
  std::vector<Real> value(n, 0);
  for (std::uint32_t v = 0; v < n; ++v)
    if (state.worst_corner(v) != kNone)
      value[v] = eigen_symmetric(state.corner_stress()[state.worst_corner(v)]).value[0];
  std::vector<bool> maximal(n, true);
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      const bool a_first = value[a] != value[b] ? value[a] > value[b] : a < b;
      maximal[a_first ? b : a] = false;
    }
  std::vector<CrackSeed> seeds;
  for (std::uint32_t v = 0; v < n; ++v)
    if (maximal[v] && value[v] > strength) seeds.push_back(make_seed(mesh, recovery, state, v));
  std::sort(seeds.begin(), seeds.end(), [](const CrackSeed& a, const CrackSeed& b) {
    return a.stress.value != b.stress.value ? a.stress.value > b.stress.value : a.vertex < b.vertex;
  });
  return seeds;
}

CrackSeed strongest_point(const SurfaceMesh& mesh, const SurfaceRecovery& recovery, const StressState& state) {
  CrackSeed best;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    if (state.worst_corner(v) == kNone) continue;
    const CrackSeed s = make_seed(mesh, recovery, state, v);
    if (best.vertex == kNone || s.stress.value > best.stress.value) best = s;
  }
  return best;
}

}  // namespace sherd
