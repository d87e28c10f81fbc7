#include "tools/campaign/solvable.h"

#include "engine/stress/analysis.h"
#include "kernels/core/error.h"
#include "kernels/core/random.h"

namespace sherd::campaign {
namespace {

// Traction of the divergence-free stress sigma = ((x - c) . v) u u^T, Pa, constant on each face; what the midpoint rule
// leaves of net force and moment is taken out by a traction a + b x (x - c).
Vec3Column bending_traction(const SurfaceMesh& mesh, const Vec3& u, const Vec3& v) {
  const std::size_t n = mesh.triangle_count();
  Vec3 centre;
  Real area = 0;
  for (std::size_t t = 0; t < n; ++t) {
    const Real a = 0.5 * norm(mesh.area_normal2(t));
    centre += a * mesh.centroid(t), area += a;
  }
  centre *= 1 / area;
  Vec3Column traction(n);
  Vec3 force, moment;
  Mat3 inertia;
  for (std::size_t t = 0; t < n; ++t) {
    const Vec3 r = mesh.centroid(t) - centre, normal2 = mesh.area_normal2(t);
    const Real a = 0.5 * norm(normal2);
    traction.set(t, dot(r, v) * dot(normalized(normal2), u) * u);
    force += a * traction[t], moment += a * cross(r, traction[t]);
    inertia += a * (dot(r, r) * Mat3::identity() - outer(r, r));
  }
  const Vec3 shift = -force / area, turn = -(inverse(inertia) * moment);
  for (std::size_t t = 0; t < n; ++t) traction.add(t, shift + cross(turn, mesh.centroid(t) - centre));
  return traction;
}

}  // namespace

Solvability solve_piece(const SurfaceMesh& piece, std::uint64_t seed) {
  Random random(seed);
  Vec3 u;
  for (int i = 0; i < 3; ++i) u[i] = random.uniform(-1, 1);
  u = normalized(u);
  Solvability result;
  try {
    constexpr Elastic kMaterial{1, 0.3};
    Analysis analysis(piece, kMaterial, {});
    result.solved = analysis.solve(bending_traction(piece, u, any_perpendicular(u)), {});
    result.warnings = analysis.report().warnings;
  } catch (const InputError& e) {
    result.warnings.push_back(e.what());
  }
  return result;
}

}  // namespace sherd::campaign
