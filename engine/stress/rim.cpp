#include "engine/stress/rim.h"

#include <Eigen/Dense>

namespace sherd {

std::vector<Rim> convex_rims(const SurfaceMesh& mesh, const SurfaceCorners& corners) {
  std::vector<Rim> at(mesh.vertex_count());
  for (std::uint32_t c = 0; c < corners.corner.size(); ++c) at[corners.corner[c].vertex].push_back(c);
  const std::vector<std::uint32_t> twin = build_twins(mesh);
  for (std::uint32_t e = 0; e < twin.size(); ++e) {
    if (corners.smooth[e] != kNone) continue;
    const Triangle& t = mesh.triangles[e / 3];
    const std::uint32_t p = t[e % 3], q = t[(e % 3 + 1) % 3];
    // The far corner of the neighbour stands out in front of this face: re-entrant. Borders count as such.
    const bool convex = twin[e] != kNone &&
                        dot(mesh.area_normal2(e / 3),
                            mesh.corner(twin[e] / 3, static_cast<int>((twin[e] % 3 + 2) % 3)) - mesh.vertices[p]) < 0;
    if (!convex) at[p].clear(), at[q].clear();
  }
  std::vector<Rim> out;
  for (Rim& r : at)
    if (r.size() > 1) out.push_back(std::move(r));
  return out;
}

bool rim_stress(const std::vector<RimSide>& sides, const Elastic& m, Sym3& out) {
  using Row = Eigen::Matrix<Real, 1, 6>;  // over xx, yy, zz, yz, xz, xy
  Eigen::Matrix<Real, 6, 6> a = Eigen::Matrix<Real, 6, 6>::Zero();
  Eigen::Matrix<Real, 6, 1> b = Eigen::Matrix<Real, 6, 1>::Zero();
  const auto add = [&](const Row& row, Real value, Real weight) {
    a += weight * row.transpose() * row, b += weight * value * row.transpose();
  };
  for (const RimSide& s : sides) {
    const Vec3 n = s.normal, t = s.traction;
    add(Row{n.x, 0, 0, 0, n.z, n.y}, t.x, 1);
    add(Row{0, n.y, 0, n.z, 0, n.x}, t.y, 1);
    add(Row{0, 0, n.z, n.y, n.x, 0}, t.z, 1);
  }
  const Real young = 2 * m.mu * (1 + m.nu), sin20 = 0.342;
  bool any = false;
  for (std::size_t i = 0; i < sides.size(); ++i)
    for (std::size_t j = i + 1; j < sides.size(); ++j) {
      const Vec3 along = cross(sides[i].normal, sides[j].normal);
      if (norm(along) < sin20) continue;
      any = true;
      const Vec3 e = normalized(along);
      const Real strain = 0.5 * (dot(e, sides[i].gradient * e) + dot(e, sides[j].gradient * e));
      // E e.eps e = (1 + nu) e.sigma e - nu trace(sigma)
      const Real k = 1 + m.nu;
      add(Row{k * e.x * e.x - m.nu, k * e.y * e.y - m.nu, k * e.z * e.z - m.nu, 2 * k * e.y * e.z, 2 * k * e.x * e.z,
              2 * k * e.x * e.y},
          young * strain, 0.01);
    }
  if (!any) return false;
  const Eigen::LDLT<Eigen::Matrix<Real, 6, 6>> factors(a);
  const auto d = factors.vectorD();
  if (!(d.minCoeff() > 1e-6 * d.maxCoeff())) return false;
  const Eigen::Matrix<Real, 6, 1> s = factors.solve(b);
  out = {s[0], s[1], s[2], s[3], s[4], s[5]};
  return true;
}

}  // namespace sherd
