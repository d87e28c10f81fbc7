// The operator by the fast multipole method against the dense one.
#include "engine/elastostatic/fast_operator.h"

#include <gtest/gtest.h>

#include "engine/elastostatic/direct_assembly.h"
#include "engine/elastostatic/panel_search.h"
#include "engine/elastostatic/solver.h"
#include "engine/mesh/shapes.h"
#include "kernels/core/parallel.h"
#include "kernels/core/random.h"

namespace sherd {
namespace {

constexpr Elastic kMaterial{1, 0.3};
constexpr std::size_t kLeaf = 60;  // so that these small bodies have a far field

struct Pair {
  Boundary boundary;
  Reconstruction reconstruction;
  Testing testing;
  DenseOperator<double> dense;
  FastOperator fast;

  Pair(const SurfaceMesh& mesh, const std::vector<VertexTest>& tests, const FastOptions& options)
      : boundary(mesh, QuadratureOptions{}),
        reconstruction(boundary.mesh, kMaterial.nu, {}),
        testing(boundary, reconstruction, tests),
        dense(mesh.vertex_count()),
        fast(boundary, reconstruction, kMaterial.nu, testing, options) {
    assemble_direct(boundary, reconstruction, kMaterial.nu, testing, dense);
  }
};

std::vector<VertexTest> half_tested(const SurfaceMesh& mesh) {
  std::vector<VertexTest> out(mesh.vertex_count(), VertexTest::kCollocation);
  for (std::size_t v = 0; v < out.size(); ++v)
    if (mesh.vertices[v].x > 0) out[v] = VertexTest::kGalerkin;
  return out;
}

std::vector<Real> field(const SurfaceMesh& mesh, int kind) {
  std::vector<Real> x;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3 p = mesh.vertices[v];
    const Vec3 u = kind == 0   ? Vec3{1, 2, 3}
                   : kind == 1 ? cross(Vec3{1, 2, 3}, p)
                               : Vec3{std::sin(3 * p.y), p.x * p.z, std::cos(2 * p.x)};
    for (int k = 0; k < 3; ++k) x.push_back(u[k]);
  }
  return x;
}

Real size(const std::vector<Real>& v) {
  Real sum = 0;
  for (const Real a : v) sum += a * a;
  return std::sqrt(sum);
}

TEST(FastOperator, AgreesWithTheDenseOneToItsTolerance) {
  // Collocated and tested rows in one body. The far field's tolerance is relative to potentials of the size of x; what
  // three sources a panel miss beyond four edges adds 6e-7 of it (measured), float storage of blocks 1e-7.
  const SurfaceMesh mesh = make_box({1, 0.8, 0.6}, 0.17);
  for (const Real tolerance : {1e-4, 1e-6}) {
    FastOptions options;
    options.tolerance = tolerance, options.leaf_size = kLeaf, options.arithmetic = fmm::Arithmetic::kDouble;
    const Pair p(mesh, half_tested(mesh), options);
    ASSERT_FALSE(p.fast.plan().statistics().direct);
    for (int kind = 0; kind < 3; ++kind) {
      const std::vector<Real> x = field(mesh, kind);
      std::vector<Real> fast(x.size()), dense(x.size());
      p.fast.apply(x, fast), p.dense.apply(x, dense);
      for (std::size_t i = 0; i < x.size(); ++i) fast[i] -= dense[i];
      EXPECT_LT(size(fast), (tolerance + 3e-6) * size(x)) << tolerance << ", field " << kind;
    }
  }
}

TEST(FastOperator, AnnihilatesTranslationsFarBelowItsTolerance) {
  // The double layer of 1 is taken with the same approximations; float blocks leave their rounding.
  const SurfaceMesh mesh = make_sphere(1, 0.25);
  FastOptions options;
  options.tolerance = 1e-4, options.leaf_size = kLeaf, options.arithmetic = fmm::Arithmetic::kDouble;
  const Pair p(mesh, half_tested(mesh), options);
  const std::vector<Real> x = field(mesh, 0);
  std::vector<Real> y(x.size());
  p.fast.apply(x, y);
  EXPECT_LT(size(y), 1e-7 * size(x));
}

TEST(FastOperator, DiagonalBlocksOfCollocatedVerticesAreTheDenseOnes) {
  const SurfaceMesh mesh = make_sphere(1, 0.2);
  FastOptions options;
  options.tolerance = 1e-5;
  const Pair p(mesh, std::vector<VertexTest>(mesh.vertex_count(), VertexTest::kCollocation), options);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const Mat3 a = p.fast.diagonal_block(v), b = p.dense.diagonal_block(v);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) EXPECT_NEAR(a[i][j], b[i][j], 3e-5);
  }
}

TEST(FastOperator, SameBitsForAnyNumberOfThreads) {
  const SurfaceMesh mesh = make_box({1, 0.8, 0.6}, 0.2);
  const auto product = [&](int threads) {
    const ThreadLimit limit(threads);
    const Boundary boundary(mesh, QuadratureOptions{});
    const Reconstruction reconstruction(boundary.mesh, kMaterial.nu, {});
    const Testing testing(boundary, reconstruction, half_tested(mesh));
    FastOptions options;
    options.tolerance = 1e-5, options.leaf_size = kLeaf;
    const FastOperator fast(boundary, reconstruction, kMaterial.nu, testing, options);
    std::vector<Real> y(fast.size());
    fast.apply(field(mesh, 2), y);
    return y;
  };
  const std::vector<Real> one = product(1);
  EXPECT_EQ(product(2), one);
  EXPECT_EQ(product(4), one);
}

TEST(FastOperator, BodiesSolvedOnItDeformAsOnTheDenseOne) {
  // A bulky and a slender body, under squeezing and bending. Both solutions leave a residual of 1e-6; the far field is
  // chosen so that its error stays near 1e-5 / sigma whatever the shape (fast_operator.h), sigma > 1e-3 here.
  for (const SurfaceMesh& mesh : {make_sphere(1, 0.35), make_plate(1, 0.6, 0.08, 0.12)}) {
    Load load;
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      const Vec3 c = mesh.centroid(t);
      load.face_traction.push_back({c.x * c.y, c.x * c.x - c.z * c.z, -c.z});
    }
    std::vector<Vec3Column> u;
    for (const OperatorKind kind : {OperatorKind::kDense, OperatorKind::kFast}) {
      ElasticOptions options;
      options.kind = kind, options.fast.leaf_size = kLeaf, options.krylov.tolerance = 1e-6;
      const ElasticBody body(mesh, kMaterial, options);
      const ElasticSolution s = body.solve(load, body.particular(load));
      ASSERT_TRUE(s.ok) << s.reason;
      u.push_back(s.displacement);
    }
    Real difference = 0, scale = 0;
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
      difference += norm2(u[0][v] - u[1][v]), scale += norm2(u[0][v]);
    EXPECT_LT(std::sqrt(difference / scale), 2e-3);
  }
}

TEST(FastOperator, ABodyMadeAnewWithACoarseSpaceSolvesBitForBitAsTheOneThatLearnedItNeedsOne) {
  const SurfaceMesh mesh = make_plate(2, 0.2, 0.1, 0.14);  // slender, though its walls are not
  Load load;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) load.face_traction.push_back({0, mesh.centroid(t).x, 0});
  ElasticOptions options;
  options.kind = OperatorKind::kFast, options.krylov.tolerance = 1e-12;
  const ElasticBody body(mesh, kMaterial, options);
  EXPECT_FALSE(body.needs_coarse_space());
  const ElasticSolution first = body.solve(load, body.particular(load));
  ASSERT_TRUE(first.ok) << first.reason;
  ASSERT_TRUE(body.needs_coarse_space()) << first.krylov.iterations;
  const ElasticSolution later = body.solve(load, body.particular(load));
  EXPECT_LT(later.krylov.iterations, first.krylov.iterations);
  options.coarse_space = true;
  const ElasticBody anew(mesh, kMaterial, options);
  const ElasticSolution told = anew.solve(load, anew.particular(load));
  EXPECT_EQ(told.displacement, later.displacement);
  EXPECT_EQ(told.krylov.iterations, later.krylov.iterations);
}

TEST(FastOperator, TooLargeAnOperatorIsRefusedWithItsSize) {
  const SurfaceMesh mesh = make_sphere(1, 0.3);
  ElasticOptions options;
  options.kind = OperatorKind::kFast, options.max_bytes = 1 << 20;
  const ElasticBody body(mesh, kMaterial, options);
  EXPECT_FALSE(body.ready());
  EXPECT_NE(body.reason().find("raise edge_length"), std::string::npos) << body.reason();
}

TEST(PanelSearch, FindsEveryPanelThatReachesTheBox) {
  Random random(9);
  Vec3Column centre;
  std::vector<Real> reach2;
  for (int i = 0; i < 3000; ++i) {
    centre.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.1, 0.1)});
    reach2.push_back(std::pow(10.0, random.uniform(-6, -1)));
  }
  const PanelSearch search(centre, reach2);
  for (int trial = 0; trial < 50; ++trial) {
    const Vec3 x{random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2), random.uniform(-0.2, 0.2)};
    Box at;
    at.grow(x);
    std::vector<char> found(centre.size(), 0);
    std::size_t visited = 0;
    search.visit(at, [&](std::size_t b) {
      for (const std::uint32_t t : search.block(b)) found[t] = 1, ++visited;
    });
    for (std::size_t t = 0; t < centre.size(); ++t) EXPECT_TRUE(found[t] || distance2(x, centre[t]) > reach2[t]);
    EXPECT_LT(visited, centre.size());
  }
}

}  // namespace
}  // namespace sherd
