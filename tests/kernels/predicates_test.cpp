#include "kernels/core/predicates.h"

#include <gtest/gtest.h>

#include <array>

#include "kernels/core/random.h"

namespace sherd {
namespace {

__extension__ typedef __int128 Wide;
using Lattice = std::array<long long, 3>;

int sign_of(Wide v) {
  return v > 0 ? 1 : (v < 0 ? -1 : 0);
}

Wide determinant_of(const Lattice& a, const Lattice& b, const Lattice& c, const Lattice& d) {
  Wide u[3], v[3], w[3];
  for (std::size_t k = 0; k < 3; ++k) u[k] = b[k] - a[k], v[k] = c[k] - a[k], w[k] = d[k] - a[k];
  return (u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] + (u[0] * v[1] - u[1] * v[0]) * w[2];
}
// Exact: lattice coordinates below 2^53 and a power of two as the unit.
Vec3 to_vec(const Lattice& p, Real unit) {
  return {static_cast<Real>(p[0]) * unit, static_cast<Real>(p[1]) * unit, static_cast<Real>(p[2]) * unit};
}
Lattice random_lattice(Random& random, long long range) {
  Lattice p;
  for (long long& c : p) c = static_cast<long long>(random.next() % static_cast<std::uint64_t>(2 * range + 1)) - range;
  return p;
}

TEST(Predicates, Orient3dOfSmallIntegersEqualsTheIntegerDeterminant) {
  Random random(1);
  int zeros = 0;
  for (int i = 0; i < 200000; ++i) {
    Lattice p[4];
    for (Lattice& q : p) q = random_lattice(random, 3);
    const int expected = sign_of(determinant_of(p[0], p[1], p[2], p[3]));
    zeros += expected == 0;
    ASSERT_EQ(orient3d(to_vec(p[0], 1), to_vec(p[1], 1), to_vec(p[2], 1), to_vec(p[3], 1)), expected);
  }
  EXPECT_GT(zeros, 1000);  // the degenerate case was really among them
}

// Coordinates of 38 bits: the determinant has 117 bits, far beyond double, and fits __int128. The fourth point is a
// lattice combination of the first three moved by at most one unit, so the relative volume is about 2^-38 or exactly
// zero.
TEST(Predicates, Orient3dOfNearlyCoplanarPointsIsExact) {
  Random random(2);
  int seen[3] = {0, 0, 0};
  for (int i = 0; i < 20000; ++i) {
    Lattice a = random_lattice(random, 1ll << 36), b = random_lattice(random, 1ll << 36),
            c = random_lattice(random, 1ll << 36);
    Lattice d;
    const long long s = static_cast<long long>(random.next() % 3) - 1,
                    t = static_cast<long long>(random.next() % 3) - 1;
    const Lattice move = random_lattice(random, i % 2);
    for (std::size_t k = 0; k < 3; ++k) d[k] = a[k] + s * (b[k] - a[k]) + t * (c[k] - a[k]) + move[k];
    const int expected = sign_of(determinant_of(a, b, c, d));
    ++seen[expected + 1];
    const Real unit = 0x1p-40;
    ASSERT_EQ(orient3d(to_vec(a, unit), to_vec(b, unit), to_vec(c, unit), to_vec(d, unit)), expected);
  }
  for (int n : seen) EXPECT_GT(n, 1000);
}

TEST(Predicates, Orient3dChangesSignUnderOddPermutations) {
  Random random(3);
  for (int i = 0; i < 5000; ++i) {
    Vec3 p[4];
    for (Vec3& q : p) q = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    // the centroid of a face is coplanar up to rounding: the filter cannot decide it
    if (i % 2) p[3] = (p[0] + p[1] + p[2]) / 3.0;
    const int s = orient3d(p[0], p[1], p[2], p[3]);
    EXPECT_EQ(orient3d(p[1], p[0], p[2], p[3]), -s);
    EXPECT_EQ(orient3d(p[0], p[2], p[1], p[3]), -s);
    EXPECT_EQ(orient3d(p[0], p[1], p[3], p[2]), -s);
    EXPECT_EQ(orient3d(p[1], p[2], p[3], p[0]), -s);  // a four-cycle is odd
    EXPECT_EQ(orient3d(p[1], p[2], p[0], p[3]), s);
  }
}

TEST(Predicates, CoplanarPointsOfAnAxisPlaneGiveZeroWhereverThePlaneLies) {
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    const int axis = i % 3;
    const Real level = random.uniform(-1e6, 1e6);
    Vec3 p[4];
    for (Vec3& q : p) {
      q = {random.uniform(-1, 1), random.uniform(-1e3, 1e3), random.uniform(-1e-3, 1e-3)};
      q[axis] = level;
    }
    EXPECT_EQ(orient3d(p[0], p[1], p[2], p[3]), 0);
    p[3][axis] = std::nextafter(level, 2e6);
    EXPECT_NE(orient3d(p[0], p[1], p[2], p[3]), 0);
  }
}

TEST(Predicates, PositiveIsTheSideOfTheCounterClockwiseNormal) {
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), 1);
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1e-50}), -1);
  EXPECT_EQ(orient2d(0, 0, 1, 0, 0, 1), 1);
}

TEST(Predicates, Orient2dOfNearlyCollinearPointsIsExact) {
  Random random(5);
  int seen[3] = {0, 0, 0};
  for (int i = 0; i < 50000; ++i) {
    const Lattice a = random_lattice(random, 1ll << 50), b = random_lattice(random, 1ll << 50);
    const Lattice move = random_lattice(random, i % 2);
    const long long s = static_cast<long long>(random.next() % 3) - 1;
    const Lattice c{a[0] + s * (b[0] - a[0]) + move[0], a[1] + s * (b[1] - a[1]) + move[1], 0};
    const Wide det = static_cast<Wide>(b[0] - a[0]) * (c[1] - a[1]) - static_cast<Wide>(b[1] - a[1]) * (c[0] - a[0]);
    const int expected = sign_of(det);
    ++seen[expected + 1];
    const Vec3 p = to_vec(a, 1), q = to_vec(b, 1), r = to_vec(c, 1);
    ASSERT_EQ(orient2d(p.x, p.y, q.x, q.y, r.x, r.y), expected);
  }
  for (int n : seen) EXPECT_GT(n, 1000);
}

TEST(Predicates, TheFilteredValueEnclosesTheExactOne) {
  Random random(6);
  for (int i = 0; i < 5000; ++i) {
    Vec3 p[4];
    for (Vec3& q : p) q = {random.uniform(1000, 1001), random.uniform(-1, 1), random.uniform(0, 1e-3)};
    if (i % 2) p[3] = p[0] + 0.25 * (p[1] - p[0]) + 0.5 * (p[2] - p[0]);
    const FilteredValue f = orient3d_value(p[0], p[1], p[2], p[3]);
    const Expansion exact = orient3d_exact(p[0], p[1], p[2], p[3]);
    EXPECT_GE((Expansion(f.value) + Expansion(f.error) - exact).sign(), 0);
    EXPECT_LE((Expansion(f.value) - Expansion(f.error) - exact).sign(), 0);
  }
}

TEST(Expansion, RingLawsHoldExactlyAndTheEstimateIsTheNearbyDouble) {
  Random random(7);
  for (int i = 0; i < 2000; ++i) {
    Expansion a, b, c;
    for (int k = 0; k < 4; ++k) {
      a = a + Expansion(std::ldexp(random.uniform(-1, 1), static_cast<int>(random.next() % 200) - 100));
      b = b + Expansion(std::ldexp(random.uniform(-1, 1), static_cast<int>(random.next() % 200) - 100));
      c = c + Expansion(random.uniform(-1, 1));
    }
    EXPECT_EQ((a * (b + c) - a * b - a * c).sign(), 0);
    EXPECT_EQ((a + b - a - b).sign(), 0);
    EXPECT_EQ((a * b).sign(), a.sign() * b.sign());
    // two units in the last place: relative error below 2^-51
    const Expansion error = a - Expansion(a.estimate());
    EXPECT_LE(std::abs(error.estimate()), 0x1p-51 * std::abs(a.estimate()));
  }
}

}  // namespace
}  // namespace sherd
