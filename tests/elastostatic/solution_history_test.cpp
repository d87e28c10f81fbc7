// A guess from earlier solutions is their best approximation, and saves the solver's work where loads are alike.
#include "engine/elastostatic/solution_history.h"

#include <gtest/gtest.h>

#include <numeric>

#include "engine/elastostatic/solver.h"
#include "engine/mesh/shapes.h"
#include "kernels/core/random.h"

namespace sherd {
namespace {

using Vector = std::vector<Real>;

// x = 2 b: any system will do.
Vector twice(Vector b) {
  for (Real& v : b) v *= 2;
  return b;
}

Vector random_vector(std::size_t n, Random& random) {
  Vector v(n);
  for (Real& x : v) x = random.uniform(-1, 1);
  return v;
}

Real distance_of(const Vector& a, const Vector& b) {
  Real sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

TEST(SolutionHistory, ASumOfEarlierRightHandSidesIsGuessedExactly) {
  Random random(1);
  SolutionHistory history;
  const Vector a = random_vector(50, random), b = random_vector(50, random);
  history.add(a, twice(a)), history.add(b, twice(b));
  Vector sum(50), x(50);
  for (std::size_t i = 0; i < 50; ++i) sum[i] = 3 * a[i] - 0.5 * b[i];
  EXPECT_TRUE(history.guess(sum, x));
  EXPECT_LE(distance_of(x, twice(sum)), 1e-12 * distance_of(sum, Vector(50)));
}

TEST(SolutionHistory, AnUnrelatedRightHandSideStartsFromZero) {
  SolutionHistory history;
  Vector a(10), b(10), x(10, 7);
  a[0] = 1, b[1] = 1;
  history.add(a, twice(a));
  EXPECT_FALSE(history.guess(b, x));
  EXPECT_EQ(x, Vector(10));
}

TEST(SolutionHistory, KeepsTheLatestAndOnlyWhatIsNew) {
  Random random(2);
  SolutionHistory history;
  const Vector a = random_vector(50, random);
  history.add(a, twice(a)), history.add(twice(a), twice(twice(a)));
  EXPECT_EQ(history.pairs.size(), 1u);
  history.add(Vector(50), Vector(50));
  EXPECT_EQ(history.pairs.size(), 1u);
  Vector last;
  for (std::size_t i = 0; i < 2 * SolutionHistory::kMost; ++i) {
    last = random_vector(50, random);
    history.add(last, twice(last));
  }
  EXPECT_EQ(history.pairs.size(), SolutionHistory::kMost);
  Vector x(50);
  EXPECT_TRUE(history.guess(last, x));
  // `last` is in the span of what is kept: its older parts, which fell out, were taken out of it before.
  EXPECT_LE(distance_of(x, twice(last)), distance_of(twice(last), Vector(50)));
}

// A pull along x at both ends of a box, `size` Pa, as constant tractions.
Load pull(const SurfaceMesh& mesh, Real size, const Vec3& axis) {
  Load load;
  load.face_traction.resize(mesh.triangle_count());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Vec3 n = normalized(mesh.area_normal2(t));
    load.face_traction.set(t, axis * (size * dot(n, axis) * (1 + mesh.centroid(t).x * mesh.centroid(t).y)));
  }
  return load;
}

TEST(SolutionHistory, TheSameLoadScaledNeedsNoIterationAndGivesTheSameDisplacement) {
  const SurfaceMesh mesh = make_box({1, 0.6, 0.4}, 0.15);
  ElasticOptions o;
  o.preconditioning = Preconditioning::kDeflation;  // factors would need one iteration anyway
  const ElasticBody body(mesh, {1, 0.25}, o);
  ASSERT_TRUE(body.ready());
  SolutionHistory history;
  const Load first = pull(mesh, 1, {1, 0, 0}), again = pull(mesh, -3, {1, 0, 0});
  const auto p1 = body.particular(first), p2 = body.particular(again);
  const ElasticSolution a = body.solve(first, p1, &history), b = body.solve(again, p2, &history),
                        cold = body.solve(again, p2);
  ASSERT_TRUE(a.ok && b.ok && cold.ok);
  EXPECT_FALSE(a.warm);
  EXPECT_TRUE(b.warm);
  EXPECT_EQ(b.krylov.iterations, 0);
  EXPECT_GT(cold.krylov.iterations, 0);
  // Both residuals are below the tolerance; the operator's condition on the strained part is below 100 for such a body.
  Real largest = 0, difference = 0;
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    largest = std::max(largest, norm(cold.displacement[i]));
    difference = std::max(difference, norm(b.displacement[i] - cold.displacement[i]));
  }
  EXPECT_LE(difference, 100 * o.krylov.tolerance * largest);
}

}  // namespace
}  // namespace sherd
