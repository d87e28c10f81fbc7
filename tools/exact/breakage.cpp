#include "tools/exact/breakage.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "engine/body/mass.h"
#include "engine/fragment/cut.h"
#include "engine/mesh/remesh.h"
#include "engine/mesh/shapes.h"
#include "engine/mesh/shapes_revolve.h"
#include "kernels/core/error.h"
#include "kernels/quadrature/gauss.h"

namespace sherd::exact {
namespace {

constexpr Real kPi = std::numbers::pi;
const Elastic kMaterial{1.0, 0.25};

// Closed prism over a convex counter-clockwise polygon in the xy plane, from -half to +half along z.
SurfaceMesh convex_prism(const std::vector<Vec3>& polygon, Real half) {
  SurfaceMesh mesh;
  const auto n = static_cast<std::uint32_t>(polygon.size());
  for (const Real z : {-half, half})
    for (const Vec3& p : polygon) mesh.vertices.push_back({p.x, p.y, z});
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    mesh.add_triangle(i, j, n + j), mesh.add_triangle(i, n + j, n + i);
    if (i == 0 || j == 0) continue;
    mesh.add_triangle(0, j, i), mesh.add_triangle(n, n + i, n + j);
  }
  return mesh;
}

SurfaceMesh remeshed(const SurfaceMesh& mesh, Real edge) {
  RemeshOptions options;
  options.edge_length = edge;
  SurfaceMesh out;
  const RemeshReport report = remesh(mesh, options, out);
  SHERD_CHECK(report.status == RemeshStatus::kOk, "remeshing failed: {}", report.reason);
  return out;
}

// `mesh` without a wedge along z whose mouth opens at `mouth` towards -`inward` (unit vectors in the xy plane).
SurfaceMesh with_notch(const SurfaceMesh& mesh, const Vec3& mouth, const Vec3& inward, const Notch& notch, Real half,
                       Real edge) {
  const Real slope = notch.angle * kPi / 360;  // of a flank against the notch's middle plane
  const Vec3 side = cross(Vec3{0, 0, 1}, inward), centre = mouth + (notch.depth - notch.root_radius) * inward;
  // The root's arc meets the flanks tangentially; the flanks run on past the mouth by the notch's depth.
  const int arcs = notch.root_radius > 0 ? std::max(4, static_cast<int>(std::ceil(2 * (kPi / 2 - slope) / 0.35))) : 0;
  std::vector<Vec3> polygon;
  for (int i = 0; i <= arcs; ++i) {
    const Real a = (kPi / 2 - slope) * (2.0 * i / std::max(arcs, 1) - 1);
    polygon.push_back(centre + notch.root_radius * (std::cos(a) * inward + std::sin(a) * side));
  }
  const auto flank = [&](const Vec3& from, Real sign) {
    const Real length = 2 * notch.depth / std::cos(slope);
    return from - length * std::cos(slope) * inward + sign * length * std::sin(slope) * side;
  };
  polygon.push_back(flank(polygon.back(), 1));
  polygon.push_back(flank(polygon.front(), -1));
  CutOptions options;
  options.edge_length = edge;
  const CutResult result = cut(mesh, convex_prism(polygon, 1.5 * half), options);
  SHERD_CHECK(result.ok && result.fragments.size() == 1, "the notch does not fit: {}", result.reason);
  return remeshed(result.fragments[0], edge);
}

// Adds the body force that balances the tractions.
void relieve(const SurfaceMesh& mesh, Load& load) {
  const MassProperties mass = mass_properties(mesh, 1);
  Vec3 force, moment;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Real area = 0.5 * norm(mesh.area_normal2(t));
    for (const TrianglePoint& p : kGauss7) {
      const std::array<Real, 6> shape = quadratic_shape(p.b, p.c);
      Vec3 traction;
      for (std::size_t k = 0; k < 6; ++k) traction += shape[k] * load.quadratic_traction[6 * t + k];
      const Vec3 f = area * p.weight * traction;
      force += f;
      moment += cross(mesh.corner(t, 0) * p.a + mesh.corner(t, 1) * p.b + mesh.corner(t, 2) * p.c - mass.centre, f);
    }
  }
  load.body_force.origin = mass.centre;
  load.body_force.constant = force * (-1 / mass.volume);
  load.body_force.linear = cross_matrix(inverse(mass.inertia) * moment) * -1.0;
}

// A smooth bump of unit height and integral `width`.
Real bump(Real x, Real width) {
  const Real s = x / width;
  return std::abs(s) < 1 ? 0.5 * (1 + std::cos(kPi * s)) : 0;
}

}  // namespace

Load breakage_load(const Breakage& b, const SurfaceMesh& mesh) {
  Load load;
  load.quadratic_traction.reserve(6 * mesh.triangle_count());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Vec3 n = normalized(mesh.area_normal2(t));
    const bool wall = mesh.faces.kind[t] == FaceKind::kCrack;
    const auto add = [&](const Vec3& x) { load.quadratic_traction.push_back(wall ? Vec3{} : b.traction(x, n)); };
    for (int k = 0; k < 3; ++k) add(mesh.corner(t, k));
    for (int k = 0; k < 3; ++k) add(0.5 * (mesh.corner(t, k) + mesh.corner(t, (k + 1) % 3)));
  }
  relieve(mesh, load);
  return load;
}

Breakage notched_bar(Real edge, const Notch& notch) {
  const Vec3 size{1, 3, 0.5};
  Breakage b{"notched bar in tension", {}, kMaterial, edge, {}};
  b.mesh = with_notch(make_box(size, edge), {-0.5 * size.x, 0, 0}, {1, 0, 0}, notch, 0.5 * size.z, edge);
  b.traction = [](const Vec3&, const Vec3& n) { return std::abs(n.y) > 0.999 ? n : Vec3{}; };
  return b;
}

Breakage chalk(Real edge, Real turn) {
  constexpr Real kRadius = 0.5, kLength = 4, kWaist = 0.02;
  Breakage b{"chalk in torsion", {}, kMaterial, edge, {}};
  Profile p;
  p.add_line({0, -0.5 * kLength}, {kRadius, -0.5 * kLength}, edge);
  p.add(
      [](Real s) {
        const Real c = std::sin(kPi * s);
        return ProfilePoint{kRadius * (1 - kWaist * c * c), (s - 0.5) * kLength};
      },
      edge);
  p.add_line({kRadius, 0.5 * kLength}, {0, 0.5 * kLength}, edge);
  b.mesh = remeshed(revolve(p), edge);
  b.traction = [turn](const Vec3& x, const Vec3& n) {
    return std::abs(n.y) > 0.999 ? (turn * n.y / kRadius) * Vec3{x.z, 0, -x.x} : Vec3{};
  };
  return b;
}

Breakage bent_beam(Real edge, const Notch& notch, Real notch_place) {
  const Vec3 size{4, 1, 0.5};
  constexpr Real kSupport = 1.7, kWidth = 0.2;
  Breakage b{"beam in three-point bending", make_box(size, edge), kMaterial, edge, {}};
  if (notch.depth > 0)
    b.mesh = with_notch(b.mesh, {notch_place, -0.5 * size.y, 0}, {0, 1, 0}, notch, 0.5 * size.z, edge);
  b.traction = [size](const Vec3& x, const Vec3& n) {
    if (n.y > 0.999 && x.y > 0.49 * size.y) return Vec3{0, -bump(x.x, kWidth), 0};
    if (n.y < -0.999 && x.y < -0.49 * size.y) return Vec3{0, 0.5 * bump(std::abs(x.x) - kSupport, kWidth), 0};
    return Vec3{};
  };
  return b;
}

Breakage struck_plate(Real edge) {
  const Vec3 size{2, 0.08, 2};
  constexpr Real kRadius = 0.25, kSupport = 0.9, kWidth = 0.1;
  Breakage b{"plate struck in the middle", make_box(size, edge), kMaterial, edge, {}};
  // The reaction of the support: the integral of the bump is (pi / 2 - 2 / pi) radius^2, that of the square ring's
  // 8 place width.
  constexpr Real kReaction = (kPi / 2 - 2 / kPi) * kRadius * kRadius / (8 * kSupport * kWidth);
  b.traction = [size](const Vec3& x, const Vec3& n) {
    if (n.y > 0.999 && x.y > 0.49 * size.y) return Vec3{0, -bump(std::hypot(x.x, x.z), kRadius), 0};
    if (n.y < -0.999 && x.y < -0.49 * size.y)
      return Vec3{0, kReaction * bump(std::max(std::abs(x.x), std::abs(x.z)) - kSupport, kWidth), 0};
    return Vec3{};
  };
  return b;
}

}  // namespace sherd::exact
