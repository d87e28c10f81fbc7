// Laws of the analysis a researcher calls: loads in balance, solids apart, linearity, what it refuses.
#include "engine/stress/analysis.h"

#include <gtest/gtest.h>

#include "engine/mesh/shapes.h"
#include "engine/mesh/solids.h"
#include "engine/stress/analysis_input.h"
#include "kernels/core/error.h"
#include "kernels/core/random.h"

namespace sherd {
namespace {

const Elastic kMaterial{3e10, 0.22};

SurfaceMesh both(SurfaceMesh a, const SurfaceMesh& b, const Vec3& shift = {}) {
  const auto offset = static_cast<std::uint32_t>(a.vertex_count());
  for (std::size_t v = 0; v < b.vertex_count(); ++v) a.vertices.push_back(b.vertices[v] + shift);
  for (const Triangle& t : b.triangles) a.add_triangle(t[0] + offset, t[1] + offset, t[2] + offset);
  return a;
}

// Tractions of a uniform stress along `axis`.
Vec3Column tension(const SurfaceMesh& mesh, Real size, int axis) {
  Vec3Column out(mesh.triangle_count());
  for (std::size_t t = 0; t < out.size(); ++t) {
    Vec3 v;
    v[axis] = size * normalized(mesh.area_normal2(t))[axis];
    out.set(t, v);
  }
  return out;
}

void expect_refused(const SurfaceMesh& mesh, const Elastic& material, const AnalysisOptions& options,
                    const std::string& part) {
  try {
    Analysis analysis(mesh, material, options);
    ADD_FAILURE() << "accepted; expected: " << part;
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
  }
}

TEST(Analysis, SplitTrianglesAreTheSamePolyhedronChildByChild) {
  const SurfaceMesh coarse = make_torus(1, 0.4, 0.4);
  const SurfaceMesh fine = split_triangles(coarse, 2);
  ASSERT_EQ(fine.triangle_count(), 16 * coarse.triangle_count());
  EXPECT_NEAR(signed_volume(fine), signed_volume(coarse), 1e-13);
  for (std::size_t t = 0; t < fine.triangle_count(); ++t) {
    const Vec3 parent = coarse.area_normal2(t / 16);
    EXPECT_LT(norm(fine.area_normal2(t) * 16.0 - parent), 1e-13 * norm(parent) + 1e-14);
    const Vec3 inside = fine.centroid(t) - coarse.corner(t / 16, 0);
    EXPECT_LT(std::abs(dot(inside, normalized(parent))), 1e-14);
  }
  for (const std::uint32_t e : build_twins(fine)) ASSERT_NE(e, kNone);
}

TEST(Analysis, TheBalancedForceLeavesNoNetForceAndNoNetMoment) {
  SurfaceMesh mesh = make_goblet(1, 0.25, 0.02, 0.08);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) mesh.vertices.set(v, mesh.vertices[v] + Vec3{20, -5, 8});
  Vec3Column traction(mesh.triangle_count());
  Random random(7);
  for (std::size_t t = 0; t < traction.size(); ++t)
    traction.set(t, {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0, 1)});
  BodyForce force;
  force.constant = {3, -2, 9}, force.origin = {1, 1, 1};
  for (int i = 0; i < 9; ++i) force.linear[i / 3][i % 3] = random.uniform(-2, 2);
  SolidReport given, balanced;
  const BodyForce b = balanced_force(mesh, traction, force, given);
  EXPECT_GT(given.force_residual, 0.01);
  EXPECT_GT(given.moment_residual, 0.001);
  balanced_force(mesh, traction, b, balanced);
  // Sums of some thousand terms, each rounded to 1e-16; the moment adds the inverse of the inertia.
  EXPECT_LT(balanced.force_residual, 1e-13);
  EXPECT_LT(balanced.moment_residual, 1e-12);
}

TEST(Analysis, ABalancedLoadIsLeftAsItIs) {
  const SurfaceMesh box = make_box({1, 2, 3}, 0.5);
  SolidReport report;
  BodyForce force;
  force.linear[1][1] = 4;  // stretches about the centroid: balanced by symmetry
  const BodyForce b = balanced_force(box, tension(box, 5, 0), force, report);
  EXPECT_LT(report.force_residual, 1e-14);
  EXPECT_LT(report.moment_residual, 1e-14);
  EXPECT_EQ(b.linear[1][1], 4);
  EXPECT_EQ(b.constant, (Vec3{}));
  EXPECT_NEAR(report.volume, 6, 1e-13);
  EXPECT_NEAR(report.area, 22, 1e-13);
}

TEST(Analysis, ASolidInACavityIsAnotherSolid) {
  const SurfaceMesh shell = make_hollow_sphere(1, 0.6, 0.3), ball = make_box({0.4, 0.4, 0.4}, 0.2);
  const SurfaceMesh mesh = both(ball, shell);
  const std::vector<SolidFaces> solids = group_shells(mesh);
  ASSERT_EQ(solids.size(), 2u);
  EXPECT_EQ(solids[0].faces.size(), shell.triangle_count());
  EXPECT_EQ(solids[0].faces[0], ball.triangle_count());
  EXPECT_NEAR(solids[0].volume, signed_volume(shell), 1e-12);
  EXPECT_NEAR(solids[1].volume, 0.064, 1e-12);

  Analysis analysis(mesh, kMaterial, {});
  Vec3Column points;
  for (const Real r : {0.1, 0.8, 0.99}) points.push_back({0, r, 0});
  const LocatedPoints located = analysis.locate(points, {});
  EXPECT_EQ(located.solid, (std::vector<std::uint32_t>{1, 0, 0}));
  Vec3Column gap;
  gap.push_back({0, 0.4, 0});
  EXPECT_THROW(analysis.locate(gap, {}), InputError);
  // Pressure on the shell's outside does not reach the ball within.
  Vec3Column traction(mesh.triangle_count());
  for (std::size_t t = 0; t < traction.size(); ++t)
    if (norm(mesh.centroid(t)) > 0.85) traction.set(t, normalized(mesh.area_normal2(t)) * -1.0);
  ASSERT_TRUE(analysis.solve(traction, {}));
  std::vector<Sym3> stress;
  analysis.stress(located, stress);
  EXPECT_EQ(stress[0], Sym3{});
  EXPECT_LT(eigen_symmetric(stress[1]).value[2], -1);  // the hoop carries it in a wall thinner than the radius
}

TEST(Analysis, LoadsOnTheSameMeshSuperpose) {
  const SurfaceMesh mesh = make_sphere(1, 0.5);
  Analysis analysis(mesh, kMaterial, {.tolerance = 1e-9});
  const Vec3Column x_pull = tension(mesh, 1, 0), y_pull = tension(mesh, 1, 1);
  Vec3Column sum(mesh.triangle_count());
  for (std::size_t t = 0; t < sum.size(); ++t) sum.set(t, 2.0 * x_pull[t] - y_pull[t]);
  BodyForce spin;
  spin.linear = Mat3::identity() * 1.0;
  Vec3Column points;
  std::vector<std::uint32_t> face;
  for (const std::uint32_t t : {0u, 9u, 40u}) points.push_back(mesh.centroid(t)), face.push_back(t);
  points.push_back({0.3, -0.2, 0.4}), face.push_back(kNone);
  const LocatedPoints located = analysis.locate(points, face);
  std::vector<Sym3> a, b, c;
  ASSERT_TRUE(analysis.solve(x_pull, spin));
  analysis.stress(located, a);
  ASSERT_TRUE(analysis.solve(y_pull, {}));
  analysis.stress(located, b);
  BodyForce twice = spin;
  twice.linear *= 2.0;
  ASSERT_TRUE(analysis.solve(sum, twice));
  analysis.stress(located, c);
  for (std::size_t i = 0; i < c.size(); ++i) {
    const Sym3 d = c[i] - (a[i] * 2.0 - b[i]);
    EXPECT_LT(std::abs(d.xx) + std::abs(d.yy) + std::abs(d.zz) + std::abs(d.xy),
              1e-5);  // far rules for constant and for linear tractions differ by 1e-6 a panel
  }
}

TEST(Analysis, WithoutLoadThereIsNoStress) {
  const SurfaceMesh mesh = make_sphere(1, 0.6);
  Analysis analysis(mesh, kMaterial, {});
  Vec3Column points;
  points.push_back({0.1, 0.2, 0.3});
  const LocatedPoints located = analysis.locate(points, {});
  ASSERT_TRUE(analysis.solve({}, {}));
  std::vector<Sym3> stress;
  analysis.stress(located, stress);
  EXPECT_EQ(stress[0], Sym3{});
  EXPECT_EQ(analysis.report().force_residual(), 0);
}

TEST(Analysis, OperatorsThatDoNotFitInDoubleAreStoredInSingleThenRefused) {
  const SurfaceMesh mesh = make_box({1, 1, 1}, 0.3);
  const std::size_t n = 3 * mesh.vertex_count();
  const Vec3Column pull = tension(mesh, 1, 2);
  Vec3Column points;
  points.push_back({0.1, 0.2, 0.3});
  for (const bool fits : {true, false}) {
    Analysis analysis(mesh, kMaterial, {.max_bytes = 8 * n * n - (fits ? 0 : 1)});
    EXPECT_EQ(analysis.report().double_storage, fits);
    EXPECT_EQ(analysis.report().warnings.size(), fits ? 0u : 1u);
    ASSERT_TRUE(analysis.solve(pull, {}));
    std::vector<Sym3> stress;
    analysis.stress(analysis.locate(points, {}), stress);
    EXPECT_NEAR(stress[0].zz, 1, 1e-4);
  }
  expect_refused(mesh, kMaterial, {.name = "box", .max_bytes = 4 * n * n - 1}, "box: ");
  expect_refused(mesh, kMaterial, {.refine = 6}, "refine less");
}

TEST(Analysis, WhatHasNoAnswerIsRefused) {
  const SurfaceMesh mesh = make_box({1, 1, 1}, 0.5);
  const Real nan = std::numeric_limits<Real>::quiet_NaN();
  expect_refused({}, kMaterial, {.name = "x"}, "x: the mesh is empty");
  expect_refused(mesh, {1, 0.5}, {}, "Poisson's ratio 0.5");
  expect_refused(mesh, {1, -1}, {}, "Poisson's ratio -1");
  expect_refused(mesh, {1, nan}, {}, "Poisson's ratio nan");
  expect_refused(mesh, {0, 0.3}, {}, "modulus must be positive");
  expect_refused(mesh, {nan, 0.3}, {}, "modulus must be positive");
  expect_refused(mesh, kMaterial, {.feature_angle = nan}, "feature angle");
  SurfaceMesh far = mesh;
  far.vertices.set(3, {nan, 0, 0});
  expect_refused(far, kMaterial, {}, "not finite");
  Analysis analysis(mesh, kMaterial, {});
  Vec3Column traction = tension(mesh, 1, 0);
  traction.y[4] = nan;
  EXPECT_THROW(analysis.solve(traction, {}), InputError);
  EXPECT_THROW(analysis.solve(Vec3Column(3), {}), InputError);
  BodyForce force;
  force.linear[1][2] = nan;
  EXPECT_THROW(analysis.solve({}, force), InputError);
}

}  // namespace
}  // namespace sherd
