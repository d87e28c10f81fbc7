// Laws of the indirect (single layer) operator and its solver.
#include "engine/elastostatic/indirect.h"

#include <gtest/gtest.h>

#include <limits>

#include "kernels/core/parallel.h"
#include "kernels/core/random.h"
#include "kernels/fundamental/kelvin.h"
#include "tests/elastostatic/indirect_support.h"

namespace sherd {
namespace {

const Elastic kMaterial{3.0, 0.3};

Load stretch(const SurfaceMesh& mesh) {
  return face_load(mesh, [](const Vec3&, const Vec3& n) { return Vec3{0, n.y, 0}; });
}
IndirectSolution solve(const SurfaceMesh& mesh, const Load& load, const IndirectOptions& options = {},
                       const Elastic& m = kMaterial) {
  return IndirectBody(mesh, m, options).solve(load, ParticularSolution(load.body_force, m));
}
IndirectOptions precise() {
  IndirectOptions o;
  o.krylov.tolerance = 1e-11, o.double_storage = true;
  return o;
}

TEST(IndirectOperator, IsTheTractionOfTheLayerWithAJumpOfOneHalf) {
  // One loaded panel: itself it gives the jump, far panels the traction of a point force.
  const SurfaceMesh mesh = make_sphere(1, 0.5);
  const IndirectBody body(mesh, kMaterial, precise());
  const Boundary& b = body.boundary();
  std::vector<Real> rho(3 * mesh.triangle_count(), 0), t(rho.size());
  const std::size_t source = 5;
  const Vec3 density{0.4, -1.2, 0.7};
  for (int k = 0; k < 3; ++k) rho[3 * source + static_cast<std::size_t>(k)] = density[k];
  body.system().apply(rho, t);
  for (std::size_t p = 0; p < mesh.triangle_count(); ++p) {
    const Vec3 at{t[3 * p], t[3 * p + 1], t[3 * p + 2]};
    if (p == source) {
      // The normal part of a flat panel's own traction is half the density: the principal value only turns the
      // tangential density into normal traction and back, and vanishes for an equilateral panel.
      EXPECT_LT(norm(at - density * 0.5), 0.05 * norm(density));
      continue;
    }
    if (distance(b.centroid[p], b.centroid[source]) < 1.5) continue;
    const Vec3 point = kelvin::traction(b.centroid[p] - b.centroid[source], density * b.panels[source].area,
                                        b.panels[p].normal, kMaterial);
    EXPECT_LT(norm(at - point), 0.05 * norm(density) * b.panels[source].area);  // one point: (0.5 / 1.5)^2 / 24 * 6
  }
}

TEST(IndirectOperator, FarFieldRulesKeepTheProductToTheirAccuracy) {
  const SurfaceMesh mesh = make_sphere(0.6, 0.12);
  IndirectOptions exact = precise(), fast = precise();
  exact.quadrature = {1e30, 1e30};
  Random random(4);
  std::vector<Real> rho(3 * mesh.triangle_count()), y(rho.size()), z(rho.size());
  for (Real& v : rho) v = random.uniform(-1, 1);
  IndirectBody(mesh, kMaterial, exact).system().apply(rho, y);
  IndirectBody(mesh, kMaterial, fast).system().apply(rho, z);
  Real difference = 0, size = 0;
  for (std::size_t i = 0; i < y.size(); ++i)
    difference = std::max(difference, std::abs(y[i] - z[i])), size = std::max(size, std::abs(y[i]));
  EXPECT_LT(difference,
            1e-5 * size);  // per panel 6e-6 at 3 edges, 6e-5 at 8 (boundary.h), of panels worth 1e-2 of a row
}

TEST(IndirectBody, DensityScalesWithTheLoadAloneToTheLastBit) {
  // Powers of two scale without rounding: size and stiffness leave the density, the load multiplies it.
  const SurfaceMesh mesh = make_box({1, 0.6, 0.8}, 0.25);
  const Vec3Column one = solve(mesh, stretch(mesh)).density;
  SurfaceMesh large = mesh;
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) large.vertices.set(i, mesh.vertices[i] * 1024.0);
  Load load = stretch(large);
  for (std::size_t t = 0; t < large.triangle_count(); ++t) load.face_traction.set(t, load.face_traction[t] * 65536.0);
  const Vec3Column other = solve(large, load, {}, {kMaterial.mu * 1048576, kMaterial.nu}).density;
  for (std::size_t t = 0; t < one.size(); ++t) EXPECT_EQ(one[t] * 65536.0, other[t]);
}

TEST(IndirectBody, BothKrylovMethodsAgreeAndBulkyBodiesNeedFewProducts) {
  for (const SurfaceMesh& mesh : {make_box({1, 1, 1}, 0.2), make_sphere(0.6, 0.2), make_shell(1, 0.5, 0.4)}) {
    IndirectOptions o;
    o.krylov.tolerance = 1e-6;
    const Load load = stretch(mesh);
    const IndirectSolution a = solve(mesh, load, o);
    o.method = KrylovMethod::kGmres;
    const IndirectSolution b = solve(mesh, load, o);
    ASSERT_TRUE(a.ok) << a.reason;
    ASSERT_TRUE(b.ok) << b.reason;
    EXPECT_LE(a.krylov.products, 30);
    EXPECT_LE(b.krylov.products, 30);
    Real size = 0, difference = 0;
    for (std::size_t t = 0; t < a.density.size(); ++t)
      size = std::max(size, norm(a.density[t])), difference = std::max(difference, norm(a.density[t] - b.density[t]));
    EXPECT_LT(difference, 1e-4 * size);  // residuals of 1e-6 times a condition number of some 10, in the maximum norm
  }
}

TEST(IndirectBody, GmresConvergesOnThinPlatesAndNarrowSlotsForAnyPoissonRatioAndBicgstabSaysWhetherItDid) {
  SurfaceMesh slot = make_box({1, 1, 1}, 0.34);
  const SurfaceMesh cavity = make_plate(0.5, 0.5, 3e-4, 0.3);  // a thousandth of an edge
  const auto offset = static_cast<std::uint32_t>(slot.vertex_count());
  for (std::size_t i = 0; i < cavity.vertex_count(); ++i) slot.vertices.push_back(cavity.vertices[i]);
  for (const Triangle& t : cavity.triangles) slot.add_triangle(offset + t[0], offset + t[2], offset + t[1]);
  for (const SurfaceMesh& mesh : {make_plate(1, 1, 0.05, 0.12), slot})
    for (const Real nu : {-0.5, 0.3, 0.499}) {
      IndirectOptions o;
      o.krylov.tolerance = 1e-6, o.method = KrylovMethod::kGmres;
      const IndirectSolution s = solve(mesh, stretch(mesh), o, {1.0, nu});
      EXPECT_TRUE(s.ok) << nu << " " << s.reason;
      EXPECT_LE(s.krylov.products, 80);
      // On the slot BiCGSTAB needs several times the products and stalls at nu = 0.499.
      o.method = KrylovMethod::kBicgstab;
      const IndirectSolution t = solve(mesh, stretch(mesh), o, {1.0, nu});
      if (t.ok)
        EXPECT_LE(t.krylov.residual, 10 * o.krylov.tolerance);
      else
        EXPECT_NE(t.reason.find("relative residual"), std::string::npos) << t.reason;
    }
}

TEST(IndirectBody, ReportsTheShareOfTheLoadThatDoesNotBalance) {
  const SurfaceMesh mesh = make_box({1, 1, 1}, 0.25);
  const IndirectSolution balanced = solve(mesh, stretch(mesh));
  EXPECT_LT(balanced.incompatibility, 1e-14);
  // A uniform traction is a rigid motion: all of it.
  const IndirectSolution rigid = solve(mesh, face_load(mesh, [](const Vec3&, const Vec3&) { return Vec3{0, 0, 2}; }));
  EXPECT_NEAR(rigid.incompatibility, 1, 1e-12);
  EXPECT_TRUE(rigid.ok) << rigid.reason;
  // The stretch's mean square is 1/3 on a cube; 0.1 across it adds 0.01: the share is its root mean square.
  const IndirectSolution mixed = solve(mesh, face_load(mesh, [](const Vec3&, const Vec3& n) {
                                         return Vec3{0.1, n.y, 0};
                                       }));
  EXPECT_NEAR(mixed.incompatibility, 0.1 / std::sqrt(1.0 / 3 + 0.01), 1e-12);
  EXPECT_TRUE(mixed.ok) << mixed.reason;
}

TEST(IndirectBody, PanelsAndCurvedTractionsActThroughTheirMeanOnAFace) {
  const SurfaceMesh mesh = make_box({1, 1, 1}, 0.5);
  const Load constant = stretch(mesh);
  Load panels, quadratic;
  quadratic.quadratic_traction.resize(6 * mesh.triangle_count());
  Random random(8);
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    const Vec3 a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2),
               traction = constant.face_traction[t];
    panels.panels.corners.push_back({a, b, 0.5 * (b + c)});  // half of the face bears twice the traction
    panels.panels.traction.push_back(traction * 2.0);
    panels.panels.face.push_back(t);
    for (std::size_t k = 0; k < 6; ++k)  // corner values have no mean
      quadratic.quadratic_traction.set(6 * t + k, k < 3 ? Vec3{random.uniform(), random.uniform(), 0} : traction);
  }
  const Vec3Column one = solve(mesh, constant, precise()).density;
  for (const Load* load : {&panels, &quadratic}) {
    const Vec3Column other = solve(mesh, *load, precise()).density;
    for (std::size_t t = 0; t < one.size(); ++t) EXPECT_LT(norm(one[t] - other[t]), 1e-9);
  }
}

TEST(IndirectBody, TroubleIsAStatusWithAReason) {
  const SurfaceMesh mesh = make_box({1, 1, 1}, 0.34);
  IndirectOptions few;
  few.krylov.max_iterations = 1, few.krylov.tolerance = 1e-10;
  const IndirectSolution stopped = solve(mesh, stretch(mesh), few);
  EXPECT_FALSE(stopped.ok);
  EXPECT_NE(stopped.reason.find("stopped after 1"), std::string::npos) << stopped.reason;

  Load load = stretch(mesh);
  load.face_traction.set(3, {std::numeric_limits<Real>::quiet_NaN(), 0, 0});
  const IndirectSolution bad = solve(mesh, load);
  EXPECT_FALSE(bad.ok);
  EXPECT_EQ(bad.reason, "the load is not finite");

  IndirectOptions small;
  small.max_bytes = 1000;
  const IndirectBody refused(mesh, kMaterial, small);
  EXPECT_FALSE(refused.ready());
  EXPECT_NE(refused.reason().find("raise edge_length"), std::string::npos) << refused.reason();
  EXPECT_FALSE(refused.solve(load, ParticularSolution({}, kMaterial)).ok);
}

TEST(IndirectBody, SameBitsForAnyNumberOfThreads) {
  const SurfaceMesh mesh = make_box({1, 0.6, 0.8}, 0.2);
  Load load = stretch(mesh);
  load.body_force.constant = {0, 0.1, 0};
  std::vector<Vec3Column> results;
  for (const int threads : {1, 2, 4}) {
    const ThreadLimit limit(threads);
    results.push_back(solve(mesh, load).density);
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

}  // namespace
}  // namespace sherd
