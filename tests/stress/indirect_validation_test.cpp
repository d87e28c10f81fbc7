// What the indirect formulation is good for and what not, against exact solutions: errors of the largest principal
// stress at corners relative to the body's largest, as rms.
#include <gtest/gtest.h>

#include <functional>

#include "engine/stress/indirect_state.h"
#include "kernels/fundamental/kelvin.h"
#include "tests/elastostatic/indirect_support.h"

namespace sherd {
namespace {

const Elastic kMaterial{1.0, 0.3};
using StressAt = std::function<Sym3(const Vec3&)>;
using TractionAt = std::function<Vec3(const Vec3& x, const Vec3& n)>;

Real corner_error(const char* name, const SurfaceMesh& mesh, const BodyForce& force, const TractionAt& traction,
                  const StressAt& exact, Real peak) {
  const TriangleBvh bvh(mesh);
  const SurfaceRecovery recovery(mesh, {});
  IndirectOptions options;
  options.krylov.tolerance = 1e-6;
  const IndirectBody body(mesh, kMaterial, options);
  Load load;
  load.body_force = force;
  load.face_traction.resize(mesh.triangle_count());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    load.face_traction.set(t, traction(mesh.centroid(t), body.boundary().panels[t].normal));
  const ParticularSolution particular(force, kMaterial);
  const IndirectSolution solution = body.solve(load, particular);
  EXPECT_TRUE(solution.ok) << solution.reason;
  const IndirectState state(body, recovery, bvh, load, particular, solution);
  Real sum = 0;
  std::size_t n = 0;
  for (std::size_t c = 0; c < recovery.corners().size(); ++c) {
    // Loaded faces at sharp edges are left out, as in the design notes.
    const bool loaded = norm(load.face_traction[recovery.corners()[c].faces[0]]) > 0;
    if (force.constant.y != 0 && loaded) continue;
    const Vec3 x = mesh.vertices[recovery.corners()[c].vertex];
    const Real e = (eigen_symmetric(state.corner_stress()[c]).value[0] - eigen_symmetric(exact(x)).value[0]) / peak;
    sum += e * e, ++n;
  }
  const Real rms = std::sqrt(sum / static_cast<Real>(n));
  std::printf("indirect, %s: %zu triangles, rms %.2f %%, %d products\n", name, mesh.triangle_count(), 100 * rms,
              solution.krylov.products);
  return rms;
}

TEST(ValidationIndirect, ThickSphereUnderInnerPressureConvergesAtFirstOrder) {
  const StressAt lame = [](const Vec3& x) {
    const Real r3 = norm2(x) * norm(x), k = 0.125 / 0.875;
    const Vec3 e = normalized(x);
    return symmetric_part(Mat3::identity() * (k * (1 + 0.5 / r3)) - outer(e, e) * (1.5 * k / r3));
  };
  const TractionAt pressure = [](const Vec3& x, const Vec3& n) { return norm(x) < 0.75 ? n * -1.0 : Vec3{}; };
  const Real coarse = corner_error("Lame", make_shell(1, 0.5, 0.29), {}, pressure, lame, 1),
             fine = corner_error("Lame", make_shell(1, 0.5, 0.2), {}, pressure, lame, 1);
  EXPECT_LT(fine, 0.015);  // prototype on jittered meshes: 1.46 %, 0.89 % at 640, 1440 triangles
  EXPECT_GT(std::log(coarse / fine) / std::log(1.5), 0.9);
}

// Spherical cavity of radius 1 in an infinite body under unit tension along z (Goodier 1933): the tension plus three
// decaying fields, a centre of dilatation, its second derivative and a force dipole, whose strengths follow from the
// traction-free cavity.
StressAt cavity_stress() {
  const auto stress_of = [](const auto& u) {
    return [u](const Vec3& x) {
      Mat3 g;
      for (int k = 0; k < 3; ++k) {
        const Vec3 d = derivative(u, x, k, 0.02 * norm(x));
        for (int i = 0; i < 3; ++i) g[i][k] = d[i];
      }
      return kelvin::hooke(g, kMaterial);
    };
  };
  const std::array<StressAt, 3> field = {
      stress_of([](const Vec3& x) { return x / (norm2(x) * norm(x)); }), stress_of([](const Vec3& x) {
        const Real r2 = norm2(x);
        return (x * (3 - 15 * x.z * x.z / r2) + Vec3{0, 0, 6 * x.z}) / (r2 * r2 * norm(x));
      }),
      stress_of([](const Vec3& x) {
        return kelvin::gradient(x, {0, 0, 1}, kMaterial).column(2);
      })};
  Mat3 a;
  Vec3 b;
  for (const Real z : {-0.9, -0.3, 0.5, 0.96}) {
    const Vec3 n{std::sqrt(1 - z * z), 0, z};
    for (int i = 0; i < 3; ++i) {
      const Vec3 t = field[static_cast<std::size_t>(i)](n) * n;
      b[i] -= t.z * z;
      for (int j = 0; j < 3; ++j) a[i][j] += dot(t, field[static_cast<std::size_t>(j)](n) * n);
    }
  }
  const Vec3 strength = inverse(a) * b;
  return [=](const Vec3& x) {
    Sym3 s{0, 0, 1, 0, 0, 0};
    for (int i = 0; i < 3; ++i) s += field[static_cast<std::size_t>(i)](x) * strength[i];
    return s;
  };
}

TEST(ValidationIndirect, StressAroundACavityConvergesAtFirstOrder) {
  const StressAt exact = cavity_stress();
  const Real peak = (27 - 15 * 0.3) / (2 * (7 - 5 * 0.3));
  ASSERT_NEAR(exact({1, 0, 0}).zz, peak, 1e-8);
  const TractionAt pull = [&](const Vec3& x, const Vec3& n) { return norm(x) > 2 ? exact(x) * n : Vec3{}; };
  const Real coarse = corner_error("cavity", make_shell(4, 1, 0.29), {}, pull, exact, peak),
             fine = corner_error("cavity", make_shell(4, 1, 0.2), {}, pull, exact, peak);
  EXPECT_LT(fine, 0.04);  // prototype: 5.0 %, 3.3 %
  EXPECT_GT(std::log(coarse / fine) / std::log(1.5), 0.9);
}

TEST(ValidationIndirect, SharpEdgesCostTensOfPercentAndRefiningHardlyHelps) {
  const TractionAt stretch = [](const Vec3&, const Vec3& n) { return Vec3{0, n.y, 0}; };
  const StressAt uniform = [](const Vec3&) { return Sym3{0, 1, 0, 0, 0, 0}; };
  const Real coarse = corner_error("cube", make_box({1, 1, 1}, 0.25), {}, stretch, uniform, 1),
             fine = corner_error("cube", make_box({1, 1, 1}, 0.125), {}, stretch, uniform, 1);
  // Prototype: 30 %, 28 % at 192, 768 triangles. Should this ever fail from below, the formulation has changed.
  for (const Real e : {coarse, fine}) {
    EXPECT_GT(e, 0.2);
    EXPECT_LT(e, 0.36);
  }
  EXPECT_LT(std::log(coarse / fine) / std::log(2.0), 0.5);
}

TEST(ValidationIndirect, HangingBarIsOffByASixth) {
  // Prototype: 18 % at 448 triangles (the direct formulation: 1 %).
  BodyForce force;
  force.constant = {0, -1, 0};
  const Real error = corner_error(
      "self weight", make_box({1, 3, 1}, 0.25), force,
      [](const Vec3&, const Vec3& n) {
        return Vec3{0, n.y > 0.5 ? 3.0 : 0.0, 0};
      },
      [](const Vec3& x) { return Sym3{0, x.y + 1.5, 0, 0, 0, 0}; }, 3);
  EXPECT_GT(error, 0.1);
  EXPECT_LT(error, 0.22);
}

}  // namespace
}  // namespace sherd
