// Gradients of contact patches' tractions in vector registers, in chunks, are those of panel after panel.
#include "engine/stress/load_gradients.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/stress/layer_gradient.h"
#include "kernels/core/parallel.h"
#include "kernels/core/random.h"

namespace sherd {
namespace {

constexpr Elastic kMaterial{3e10, 0.22};

Vec3 random_point(Random& random, Real size) {
  const Real x = random.uniform(-size, size), y = random.uniform(-size, size), z = random.uniform(-size, size);
  return {x, y, z};
}

// 700 panels, more than two chunks, of about a hundredth in a cube.
TractionPanels random_panels(Random& random) {
  TractionPanels panels;
  for (std::uint32_t i = 0; i < 700; ++i) {
    const Vec3 a = random_point(random, 0.5);
    panels.corners.push_back({a, a + random_point(random, 0.01), a + random_point(random, 0.01)});
    panels.traction.push_back(random_point(random, 1));
    panels.face.push_back(0);
  }
  return panels;
}

// Some near a panel, all others near or far from most.
Vec3Column points_near(const TractionPanels& panels, std::size_t count, Random& random) {
  Vec3Column x;
  for (std::size_t k = 0; k < count; ++k)
    x.push_back(k % 3 == 0 ? panels.corners[k][0] + random_point(random, 0.03) : random_point(random, 0.7));
  return x;
}

// The sums differ in their order: 700 terms of the size of the largest, some 1e-13 of the sum of sizes.
TEST(LoadGradients, AreTheSumOverPanelsOneByOne) {
  Random random(11);
  const TractionPanels panels = random_panels(random);
  const QuadratureOptions options;
  const LoadGradients gradients(panels, kMaterial, options);
  for (const std::size_t count : {1u, 8u, 9u, 200u}) {
    const Vec3Column x = points_near(panels, count, random);
    std::vector<Mat3> got(count);
    gradients.add(x, got);
    for (std::size_t k = 0; k < count; ++k) {
      Mat3 expected;
      Real size = 0;
      for (std::size_t i = 0; i < panels.size(); ++i) {
        const auto& [a, b, c] = panels.corners[i];
        const Mat3 g = layer_gradient(make_panel(a, b, c), x[k], panels.traction[i], kMaterial, options).kelvin;
        expected += g;
        for (int j = 0; j < 9; ++j) size += std::abs(g.m[j / 3][j % 3]);
      }
      for (int j = 0; j < 9; ++j)
        EXPECT_LE(std::abs(got[k].m[j / 3][j % 3] - expected.m[j / 3][j % 3]), 1e-12 * size) << count << " " << k;
    }
  }
}

TEST(LoadGradients, HaveTheSameBitsForAnyThreads) {
  Random random(12);
  const TractionPanels panels = random_panels(random);
  const LoadGradients gradients(panels, kMaterial, {});
  const Vec3Column x = points_near(panels, 20, random);
  std::vector<Mat3> one(x.size()), four(x.size());
  {
    const ThreadLimit limit(1);
    gradients.add(x, one);
  }
  const ThreadLimit limit(4);
  gradients.add(x, four);
  for (std::size_t k = 0; k < x.size(); ++k)
    for (int j = 0; j < 9; ++j) EXPECT_EQ(one[k].m[j / 3][j % 3], four[k].m[j / 3][j % 3]);
}

TEST(LoadGradients, OfNoLoadAddNothing) {
  const LoadGradients gradients({}, kMaterial, {});
  Vec3Column x;
  x.push_back({1, 2, 3});
  std::vector<Mat3> out(1);
  gradients.add(x, out);
  for (int j = 0; j < 9; ++j) EXPECT_EQ(out[0].m[j / 3][j % 3], 0);
}

}  // namespace
}  // namespace sherd
