// Laws of the direct operator over reconstructed displacements, and of its lane kernels.
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/elastostatic/direct_assembly.h"
#include "engine/elastostatic/panel_rows.h"
#include "engine/elastostatic/source_block.h"
#include "kernels/core/parallel.h"
#include "tests/elastostatic/robust_support.h"

namespace sherd {
namespace {

constexpr QuadratureOptions kExact{1e30, 1e30};

enum class Rows { kCollocation, kGalerkin, kMixed };

std::vector<VertexTest> tests_of(const SurfaceMesh& mesh, Rows rows) {
  std::vector<VertexTest> out(mesh.vertex_count(),
                              rows == Rows::kGalerkin ? VertexTest::kGalerkin : VertexTest::kCollocation);
  if (rows == Rows::kMixed)
    for (std::size_t v = 0; v < out.size(); ++v)
      if (mesh.vertices[v].x > 0) out[v] = VertexTest::kGalerkin;
  return out;
}

struct System {
  Boundary boundary;
  Reconstruction reconstruction;
  Testing testing;
  DenseOperator<double> matrix;
  System(const SurfaceMesh& mesh, Real nu, Rows rows, const QuadratureOptions& quadrature)
      : boundary(mesh, quadrature),
        reconstruction(boundary.mesh, nu, {}),
        testing(boundary, reconstruction, tests_of(mesh, rows)),
        matrix(mesh.vertex_count()) {
    assemble_direct(boundary, reconstruction, nu, testing, matrix);
  }
  System(const System&) = delete;
  System& operator=(const System&) = delete;
  std::vector<Real> apply(const Vec3Column& u) const {
    const std::vector<Real> x = interleaved(u);
    std::vector<Real> y(x.size());
    matrix.apply(x, y);
    return y;
  }
};

constexpr Rows kAllRows[] = {Rows::kCollocation, Rows::kGalerkin, Rows::kMixed};

// Translations panel by panel; rotations by the closed surface as a whole, so that Gauss rules leave their own error.
TEST(RobustOperator, AnnihilatesRigidMotionsWithAnyRows) {
  const SurfaceMesh box = make_box({1, 0.8, 0.9}, 0.3);
  const auto translation = [](const Vec3&) { return Vec3{0.4, -0.3, 0.9}; };
  const auto rotation = [](const Vec3& x) { return cross(Vec3{0.2, 0.8, -0.5}, x); };
  for (const SurfaceMesh& mesh :
       {box, make_sphere(0.6, 0.3), make_hollow_sphere(1, 0.6, 0.6), with_slivers(box, 6, 1e-4, 2)})
    for (const Rows rows : kAllRows) {
      const System exact(mesh, 0.3, rows, kExact), fast(mesh, 0.3, rows, {});
      const std::size_t n = mesh.triangle_count();
      // Rounding of some 1e3 terms of order 1.
      EXPECT_LT(largest(exact.apply(sample(mesh, translation))), 1e-13) << n << " " << int(rows);
      EXPECT_LT(largest(exact.apply(sample(mesh, rotation))), 1e-13) << n << " " << int(rows);
      EXPECT_LT(largest(fast.apply(sample(mesh, translation))), 1e-13) << n << " " << int(rows);
      // 1e-6 of a panel's share of the rotation, below a hundredth, at three edges.
      EXPECT_LT(largest(fast.apply(sample(mesh, rotation))), 1e-8) << n << " " << int(rows);
    }
}

TEST(RobustOperator, SatisfiesSomiglianaExactlyForQuadraticDisplacementsOnFlatFaces) {
  const SurfaceMesh mesh = make_box({1, 0.8, 0.9}, 0.25);
  for (const Real nu : {-0.5, 0.3, 0.499}) {
    const Elastic material{1.5, nu};
    const QuadraticField field(material, 11);
    const Load load = traction_load(mesh, [&](const Vec3& x) { return field.stress(x); });
    const Vec3Column u = sample(mesh, [&](const Vec3& x) { return field.displacement(x); });
    for (const Rows rows : kAllRows)
      for (const bool exact : {true, false}) {
        const QuadratureOptions quadrature = exact ? kExact : QuadratureOptions{};
        const System a(mesh, nu, rows, quadrature);
        const std::vector<Real> left = a.apply(u);
        const std::vector<Real> right = interleaved(a.testing.apply(load_potential(
            a.boundary, load, ParticularSolution({}, material), material, quadrature, a.testing.points())));
        std::vector<Real> difference(left.size());
        for (std::size_t i = 0; i < left.size(); ++i) difference[i] = left[i] - right[i];
        // Gauss rules: 6e-6 of a panel's share at three edges (boundary.h), which is a few percent.
        EXPECT_LT(largest(difference), (exact ? 1e-11 : 1e-6) * largest(left)) << "nu " << nu << ", rows " << int(rows);
      }
  }
}

TEST(RobustOperator, FarRulesErrByLessThanTheyPromise) {
  const SurfaceMesh mesh = make_box({1, 0.8, 0.9}, 0.1);
  const QuadraticField field({1.0, 0.3}, 11);
  const Vec3Column u = sample(mesh, [&](const Vec3& x) { return field.displacement(x); });
  const std::vector<Real> exact = System(mesh, 0.3, Rows::kCollocation, kExact).apply(u);
  std::vector<Real> fast = System(mesh, 0.3, Rows::kCollocation, {}).apply(u);
  for (std::size_t i = 0; i < exact.size(); ++i) fast[i] -= exact[i];
  // Per panel the rules err by at most 2e-5 of a panel's share (boundary.h); smooth fields add them with mixed signs.
  EXPECT_LT(largest(fast), 2e-5 * largest(exact));
}

TEST(RobustOperator, SameBitsForAnyNumberOfThreads) {
  const SurfaceMesh mesh = make_box({1, 0.8, 0.9}, 0.2);
  Random random(4);
  Vec3Column u;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) u.push_back(random_vector(random));
  std::vector<std::vector<Real>> results;
  for (const int threads : {1, 2, 4}) {
    const ThreadLimit limit(threads);
    results.push_back(System(mesh, 0.3, Rows::kMixed, {}).apply(u));
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

// Both builds of the lane kernels on one random panel; they differ by the order of fused operations alone.
class LanePair : public ::testing::Test {
 protected:
  static constexpr std::size_t kFreedoms = 14;
  LanePanel panel{};
  LaneTables tables{};
  LaneConstants constants{0.03, 0.06, 0.08};
  std::uint32_t local[kPanelFreedoms] = {3, 0, 7, 1, 13, 5, 6, 2, 11};
  double x[3 * kLanes], mask[kLanes];
  Random random{12};

  LanePair() {
    const auto fill = [&](auto& values) {
      auto* p = reinterpret_cast<double*>(&values);
      for (std::size_t i = 0; i < sizeof(values) / sizeof(double); ++i) p[i] = random.uniform(-1, 1);
    };
    fill(panel), fill(tables);
    for (std::size_t i = 0; i < 3 * kLanes; ++i) x[i] = random.uniform(4, 9);
    for (std::size_t k = 0; k < kLanes; ++k) mask[k] = k % 3 == 0 ? 0 : 1;
  }
  std::vector<double> random_values(std::size_t n) {
    std::vector<double> out(n);
    for (double& v : out) v = random.uniform(-1, 1);
    return out;
  }
  static void expect_same(const std::vector<double>& a, const std::vector<double>& b) {
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-13 * (1 + std::abs(a[i])));
  }
};

TEST_F(LanePair, BaselineAndWideKernelsAgree) {
  const LaneKernels &base = baseline_lane_kernels(), &wide = lane_kernels();
  const auto start = random_values(kFreedoms * kLaneBlock), sums = random_values(kLanes);
  LaneMoments moments;
  for (auto& m : moments.kernel)
    for (auto& i : m)
      for (double& v : i) v = random.uniform(-1, 1);
  for (auto& m : moments.angle)
    for (double& v : m) v = random.uniform(-1, 1);
  const auto weight = random_values(kPanelFreedoms), block = random_values(kLaneBlock);
  const auto run = [&](const LaneKernels& k) {
    std::vector<double> freedoms = start, total = sums;
    k.three_points(panel, tables, constants, x, local, freedoms.data(), total.data());
    k.six_points(panel, tables, constants, x, nullptr, local, freedoms.data(), total.data());
    k.six_points(panel, tables, constants, x, mask, local, freedoms.data(), total.data());
    k.moments(panel, tables, moments, local, freedoms.data(), total.data());
    k.add_weighted(block.data(), weight.data(), local, freedoms.data());
    freedoms.insert(freedoms.end(), total.begin(), total.end());
    return freedoms;
  };
  expect_same(run(base), run(wide));
}

TEST_F(LanePair, AMaskedLaneAddsNothing) {
  for (const LaneKernels* k : {&baseline_lane_kernels(), &lane_kernels()}) {
    std::vector<double> freedoms(kFreedoms * kLaneBlock, 0), total(kLanes, 0);
    k->six_points(panel, tables, constants, x, mask, local, freedoms.data(), total.data());
    for (std::size_t i = 0; i < freedoms.size(); ++i) EXPECT_TRUE(mask[i % kLanes] > 0 || freedoms[i] == 0) << i;
    for (std::size_t i = 0; i < kLanes; ++i) EXPECT_EQ(total[i] == 0, mask[i] == 0);
  }
}

// Closed forms eight at a time are those one by one: near and far from a panel, in its plane, over it, on it, close to
// its edges and corners, for slender panels too; lanes that are not asked for are zero.
TEST(RobustOperator, ClosedFormsOfLanesAreThoseOfOneTarget) {
  Random random(9);
  const LaneConstants constants{0.3, 0.7, 0.9};
  int asked_for = 0, left = 0;
  for (const LaneKernels* kernels : {&baseline_lane_kernels(), &lane_kernels()})
    for (int round = 0; round < 400; ++round) {
      const Real height = round % 4 == 0 ? std::pow(10, -random.uniform(0, 3)) : random.uniform(0.4, 1);
      const Vec3 shift = random_vector(random);
      const PanelFrame f =
          make_panel(shift, shift + Vec3{1, 0.1, 0.2}, shift + Vec3{random.uniform(0, 1), height, 0.3});
      double x[3 * kLanes], on[kLanes], wanted[kLanes];
      Vec3 target[kLanes];
      Side side[kLanes];
      bool asked[kLanes];
      for (std::size_t k = 0; k < kLanes; ++k) {
        const Real a = random.uniform(0, 1), b = random.uniform(0, 1 - a);
        const Vec3 inside = f.vertex[0] * (1 - a - b) + f.vertex[1] * a + f.vertex[2] * b;
        const Vec3 edge = f.vertex[0] * a + f.vertex[1] * (1 - a);
        const Vec3 choices[] = {
            f.centroid() + random_vector(random) * 2.0,       f.centroid() + random_vector(random) * 0.3, inside,
            inside + f.normal * random.uniform(-1e-3, 1e-3),  edge + random_vector(random) * 1e-6,        f.vertex[1],
            f.vertex[1] + f.tangent[0] * random.uniform(0, 2)};
        const std::size_t choice = random.next() % 7;
        target[k] = choices[choice];
        side[k] = choice == 2 || choice == 5 ? Side::kOnSurface : Side::kAway;
        asked[k] = random.uniform(0, 1) < 0.8;
        for (std::size_t i = 0; i < 3; ++i) x[i * kLanes + k] = target[k][static_cast<int>(i)];
        on[k] = side[k] == Side::kOnSurface ? 1 : 0, wanted[k] = asked[k] ? 1 : 0;
      }
      LaneMoments lanes;
      double rest[kLanes];
      std::copy_n(wanted, kLanes, rest);
      kernels->panel_moments(f, constants, x, on, rest, lanes);
      for (std::size_t k = 0; k < kLanes; ++k) asked_for += asked[k], left += rest[k] > 0;
      closed_forms(f, x, on, wanted, constants, *kernels, lanes);
      for (std::size_t k = 0; k < kLanes; ++k) {
        PanelMoments one{};
        if (asked[k]) integrate_panel_moments(f, target[k], side[k], one);
        // As exact as the closed forms are: of the largest entry, for angles of 1 (moments.h).
        const Real size = std::abs(one.inverse[0]);
        for (std::size_t m = 0; m < kQuadraticMonomials; ++m) {
          const Sym3& d = one.dyad[m];
          const Real wanted_value[6] = {d.xx, d.yy, d.zz, d.yz, d.xz, d.xy};
          for (std::size_t i = 0; i < 6; ++i)
            ASSERT_NEAR(lanes.kernel[m][i][k], 0.7 * wanted_value[i] + (i < 3 ? 0.3 * one.inverse[m] : 0), 2e-11 * size)
                << round << " " << k << " " << m << " " << i;
        }
        for (std::size_t m = 0; m < kCubicMonomials; ++m)
          ASSERT_NEAR(lanes.angle[m][k], 0.9 * one.angle[m], 2e-11) << round << " " << k << " " << m;
      }
    }
  EXPECT_LT(left, asked_for / 2);  // what the lanes leave to the one-by-one form: slender panels, edges
}

// A polynomial's value at node a of the cubic element.
Real at_node(const cubic::Polynomial& p, std::size_t a) {
  constexpr Real kCorner[3][2] = {{0, 0}, {1, 0}, {0, 1}};
  if (a == 9) return cubic::evaluate(p, 1.0 / 3, 1.0 / 3);
  if (a < 3) return cubic::evaluate(p, kCorner[a][0], kCorner[a][1]);
  const std::size_t e = (a - 3) / 2, next = (e + 1) % 3;
  const Real l = a % 2 == 1 ? 1.0 / 3 : 2.0 / 3;
  return cubic::evaluate(p, (1 - l) * kCorner[e][0] + l * kCorner[next][0],
                         (1 - l) * kCorner[e][1] + l * kCorner[next][1]);
}

// Loads on the ten nodes of panels, handed to the panels' freedoms, reach the vertices as by the transpose of the
// reconstruction from nodes: the freedoms are the same elements.
TEST(RobustOperator, GatherIsTheTransposedReconstruction) {
  for (const SurfaceMesh& mesh : {make_sphere(0.6, 0.25), make_box({1, 0.8, 0.9}, 0.2)})
    for (const Element element : {Element::kCubic, Element::kLinear}) {
      const Boundary boundary(mesh, {});
      ReconstructionOptions options;
      options.element = element;
      const Reconstruction r(boundary.mesh, 0.3, options);
      SourceBlockBuilder builder(boundary, r, false);
      std::vector<std::uint32_t> panels;
      for (std::uint32_t t = 20; t < 60; ++t) panels.push_back(t);
      const SourceBlock block = builder.build(panels);
      Random random(2);
      std::vector<double> freedoms(kLaneBlock * block.freedoms, 0);
      Vec3Column load[kLanes][3];  // row i of the blocks is a load
      for (auto& rows : load)
        for (Vec3Column& l : rows) l.resize(r.node_count());
      for (std::size_t p = 0; p < panels.size(); ++p)
        for (std::size_t a = 0; a < cubic::kNodes; ++a)
          for (std::size_t e = 0; e < kLaneBlock; ++e) {
            const std::size_t i = e / (3 * kLanes), j = e / kLanes % 3, lane = e % kLanes;
            const Real value = random.uniform(-1, 1);
            Vec3 one;
            one[static_cast<int>(j)] = value;
            load[lane][i].add(r.nodes(panels[p])[a], one);
            for (std::size_t f = 0; f < kPanelFreedoms; ++f)
              freedoms[kLaneBlock * block.local[p][f] + e] += value * at_node(cubic::kHermite[f], a);
          }
      for (const LaneKernels* k : {&baseline_lane_kernels(), &lane_kernels()}) {
        std::vector<double> out(kLaneBlock * mesh.vertex_count(), 0);
        k->gather(block.gather(), freedoms.data(), out.data());
        for (std::size_t lane = 0; lane < kLanes; lane += 3)
          for (std::size_t i = 0; i < 3; ++i) {
            const Vec3Column expected = r.apply_transpose(load[lane][i]);
            for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
              for (std::size_t j = 0; j < 3; ++j)
                EXPECT_NEAR(out[kLaneBlock * v + (3 * i + j) * kLanes + lane], expected[v][static_cast<int>(j)], 1e-12);
          }
      }
    }
}

}  // namespace
}  // namespace sherd
