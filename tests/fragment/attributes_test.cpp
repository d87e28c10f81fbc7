// What faces carry through a cut (the design's T16): every point of an original face has the material, source and
// channel values it had, at the place it had; crack walls have their own.
#include "engine/mesh/attributes.h"
#include "engine/fracture/thicken.h"
#include "engine/mesh/shapes.h"
#include "tests/fragment/slabs.h"

namespace sherd {
namespace {

// Channel "place": each corner's own position, so that a value that is not linear in place shows. Channel "uv": two
// numbers that jump at every edge.
SurfaceMesh decorated(SurfaceMesh body) {
  number_sources(body);
  CornerChannel place{"place", 3, {}}, uv{"uv", 2, {}};
  for (std::size_t t = 0; t < body.triangle_count(); ++t) {
    body.faces.material[t] = static_cast<std::uint16_t>(t % 5 + 2);
    for (int k = 0; k < 3; ++k) {
      for (int i = 0; i < 3; ++i) place.value.push_back(static_cast<float>(body.corner(t, k)[i]));
      uv.value.push_back(static_cast<float>(t)), uv.value.push_back(static_cast<float>(k));
    }
  }
  body.channels = {place, uv};
  return body;
}

constexpr Real kWave = 2 * 3.14159265358979 * 2 / 2.6;  // two whole waves: the mean normal is +z

// Of a wavy square larger than the body.
CrackSheet wavy_sheet() {
  constexpr std::uint32_t n = 14;
  CrackSheet s;
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i) {
      const Real x = 2.6 * i / n - 1.3, y = 2.6 * j / n - 1.3;
      s.position.push_back({x + 0.011, y + 0.007, 0.06 * std::sin(kWave * x) + 0.013});
      s.normal.push_back({0, 0, 1});
      const bool border = i == 0 || j == 0 || i == n || j == n;
      s.state.push_back(border ? NodeState::kExited : NodeState::kInterior);
    }
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
      s.triangles.push_back({a, b, c}), s.triangles.push_back({a, c, d});
    }
  return s;
}

// Distance of p from the plane of the triangle, and the smallest of its three weights there.
std::pair<Real, Real> place_in(const SurfaceMesh& body, std::uint32_t face, const Vec3& p) {
  const auto w = corner_weights(body, face, p);
  return {std::abs(dot(normalized(body.area_normal2(face)), p - body.corner(face, 0))), std::min({w[0], w[1], w[2]})};
}

class CutAttributes : public testing::TestWithParam<int> {
 protected:
  SurfaceMesh body() const {
    return decorated(GetParam() == 0 ? make_sphere(1, 0.2) : moved(make_box({1, 1, 1}, 0.125), [](const Vec3& p) {
      return p + Vec3{0.003, 0.002, 0.001};
    }));
  }
};

TEST_P(CutAttributes, EveryOriginalFaceKeepsThemAtEveryPoint) {
  const SurfaceMesh mesh = body();
  SlabOptions options;
  options.thickness = 0.01, options.crack = 5;
  std::string reason;
  const auto slab = thicken(wavy_sheet(), options, reason);
  ASSERT_TRUE(slab) << reason;
  const CutResult result = cut_of(mesh, *slab);
  expect_good(mesh, result);
  ASSERT_EQ(result.fragments.size(), 2u);
  Real area[2] = {0, 0};
  std::size_t whole = 0, parts = 0;
  for (const SurfaceMesh& f : result.fragments) {
    ASSERT_EQ(check_attributes(f), "");
    ASSERT_EQ(f.channels.size(), 2u);
    for (std::size_t t = 0; t < f.triangle_count(); ++t) {
      const bool crack = f.faces.kind[t] == FaceKind::kCrack;
      area[crack] += 0.5 * norm(f.area_normal2(t));
      if (crack) continue;
      const auto source = static_cast<std::uint32_t>(f.faces.source[t]);
      EXPECT_EQ(f.faces.material[t], mesh.faces.material[source]);
      EXPECT_EQ(f.faces.side[t], 0);
      bool same = true;
      for (int k = 0; k < 3; ++k) {
        const Vec3 p = f.corner(t, k);
        const auto [off, weight] = place_in(mesh, source, p);
        // Points are rounded once; coordinates are of size 1.
        EXPECT_LT(off, 1e-15);
        EXPECT_GT(weight, -1e-13);
        same = same && p == mesh.corner(source, k);
        const std::size_t corner = 3 * t + static_cast<std::size_t>(k);
        // Floats of size 1: two roundings of 6e-8, of the parent's values and of the result.
        for (std::size_t i = 0; i < 3; ++i)
          EXPECT_NEAR(f.channels[0].value[3 * corner + i], p[static_cast<int>(i)], 2e-7);
        EXPECT_NEAR(f.channels[1].value[2 * corner], static_cast<float>(source), 1e-3);
      }
      ++(same ? whole : parts);
    }
  }
  EXPECT_GT(whole, 300u);
  EXPECT_GT(parts, 100u);
  // What the slab takes of the outside is its band around the section, thickness times perimeter (slanted where the
  // sheet leaves the surface at an angle: the waves' slope is below 0.3, the sphere's below 0.1).
  const Real perimeter = GetParam() == 0 ? 2 * 3.14159265358979 : 4;
  const Real gone = surface_area(mesh) - area[0];
  EXPECT_GT(gone, 0.95 * 0.01 * perimeter);
  EXPECT_LT(gone, 1.25 * 0.01 * perimeter);
}

TEST_P(CutAttributes, WallsHaveTheirSideTheirMaterialAndTheirOwnTexture) {
  const SurfaceMesh mesh = body();
  SlabOptions options;
  options.thickness = 0.01, options.crack = 5, options.material = 9, options.uv_scale = 3;
  std::string reason;
  const auto slab = thicken(wavy_sheet(), options, reason);
  ASSERT_TRUE(slab) << reason;
  const CutResult result = cut_of(mesh, *slab);
  ASSERT_EQ(result.fragments.size(), 2u) << result.reason;
  for (const SurfaceMesh& f : result.fragments) {
    std::size_t walls = 0;
    int side = 0;
    for (std::size_t t = 0; t < f.triangle_count(); ++t) {
      if (f.faces.kind[t] != FaceKind::kCrack) continue;
      ++walls;
      EXPECT_EQ(f.faces.crack[t], 5);
      EXPECT_EQ(f.faces.source[t], -1);
      EXPECT_EQ(f.faces.material[t], 9);
      // The slab's wall on the side of the sheet's normal (+z) bounds the upper piece, whose own normal points down.
      EXPECT_EQ(f.faces.side[t], f.area_normal2(t).z < 0 ? 1 : -1);
      side = f.faces.side[t];
      // An isometry of the plane across the mean normal times the scale; floats of size 4, two of them interpolated.
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        const Vec3 d = f.corner(t, static_cast<int>(next)) - f.corner(t, static_cast<int>(k));
        Real uv[2];
        for (std::size_t i = 0; i < 2; ++i)
          uv[i] = static_cast<Real>(f.channels[1].value[2 * (3 * t + next) + i]) -
                  static_cast<Real>(f.channels[1].value[2 * (3 * t + k) + i]);
        EXPECT_NEAR(std::hypot(uv[0], uv[1]), 3 * std::hypot(d.x, d.y), 5e-6);
      }
    }
    EXPECT_GT(walls, 100u);
    EXPECT_NE(side, 0);
  }
}

// Of edges between original faces that bend by more than 40 degrees, m.
Real sharp_length(const SurfaceMesh& mesh) {
  const std::vector<std::uint32_t> twin = build_twins(mesh);
  Real sum = 0;
  for (std::uint32_t e = 0; e < twin.size(); ++e) {
    const std::uint32_t f = e / 3, g = twin[e] / 3;
    if (e > twin[e] || mesh.faces.kind[f] == FaceKind::kCrack || mesh.faces.kind[g] == FaceKind::kCrack) continue;
    const Real bend = dot(normalized(mesh.area_normal2(f)), normalized(mesh.area_normal2(g)));
    const int k = static_cast<int>(e % 3);
    if (bend < std::cos(40.0 / 180 * 3.14159265358979)) sum += distance(mesh.corner(f, k), mesh.corner(f, (k + 1) % 3));
  }
  return sum;
}

TEST(CutFeatures, SharpEdgesStayWhereTheyWereButForTheSlabsWidth) {
  const SurfaceMesh body = make_box({1, 1, 1}, 0.25);
  EXPECT_NEAR(sharp_length(body), 12, 1e-12);
  SurfaceMesh slab = moved(make_box({0.02, 2.3, 2.9}, 5), [](const Vec3& p) { return p + Vec3{0.137, 0, 0}; });
  slab.faces.kind.assign(slab.triangle_count(), FaceKind::kCrack);
  const CutResult result = cut_of(body, slab);
  expect_good(body, result);
  Real sum = 0;
  for (const SurfaceMesh& f : result.fragments) sum += sharp_length(f);
  EXPECT_NEAR(sum, 12 - 4 * 0.02, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Bodies, CutAttributes, testing::Values(0, 1));

TEST(CutChannels, AChannelOfTheWrongLengthIsRefused) {
  SurfaceMesh mesh = decorated(make_sphere(1, 0.5));
  mesh.channels[0].value.pop_back();
  const CutResult result = cut_of(mesh, make_slab({}));
  EXPECT_FALSE(result.ok);
  EXPECT_NE(result.reason.find("place"), std::string::npos) << result.reason;
}

}  // namespace
}  // namespace sherd
