// Fields as colours of surfaces.
#include <cmath>
#include <functional>

#include "kernels/core/error.h"
#include "render/colour_map.h"
#include "render/draw_mesh.h"
#include "render/legend.h"
#include "tests/render/picture.h"

namespace sherd {
namespace {

std::shared_ptr<SurfaceField> field_of(const SurfaceMesh& mesh, const std::function<Real(const Vec3&)>& f) {
  auto field = std::make_shared<SurfaceField>();
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) field->value.push_back(static_cast<float>(f(mesh.corner(t, k))));
  return field;
}

Real luminance(const std::array<float, 3>& c) {
  Real y = 0;
  const std::array<Real, 3> weight{0.2126, 0.7152, 0.0722};
  for (std::size_t k = 0; k < 3; ++k) y += weight[k] * std::pow((c[k] + 0.055) / 1.055, 2.4);
  return y;
}

TEST(ColourMap, GetsEvenlyLighter) {
  // CIE lightness of viridis grows from 15 to 91, straight to within 3; straight lines between control points add 1.
  const auto lightness = [](float t) { return 116 * std::cbrt(luminance(map_colour(t))) - 16; };
  for (int i = 0; i <= 100; ++i) {
    const float t = static_cast<float>(i) / 100;
    EXPECT_NEAR(lightness(t), 15 + 76 * t, 4) << t;
  }
  EXPECT_EQ(map_colour(-1), map_colour(0));
  EXPECT_EQ(map_colour(2), map_colour(1));
}

TEST(DrawMesh, AFieldsValueIsTheMeanOfTheCornersThatShareAVertex) {
  const SurfaceMesh box = make_box({1, 1, 1}, 0.5);
  const auto field = field_of(box, [](const Vec3& p) { return p.x + 2 * p.y; });
  const DrawMesh drawn = make_draw_mesh(box, field.get());
  ASSERT_EQ(drawn.values.size(), drawn.vertices.size() / 6);
  for (std::size_t i = 0; i < drawn.values.size(); ++i)  // single precision
    EXPECT_NEAR(drawn.values[i], drawn.vertices[6 * i] + 2 * drawn.vertices[6 * i + 1], 1e-6);
  EXPECT_TRUE(make_draw_mesh(box).values.empty());
}

TEST(DrawMesh, AFieldsDisplacementMovesTheSurface) {
  const SurfaceMesh box = make_box({1, 1, 1}, 0.5);
  const auto field = field_of(box, [](const Vec3&) { return 0; });
  for (std::size_t v = 0; v < box.vertex_count(); ++v)
    field->displacement.push_back({0, 0.25 * (box.vertices[v].y + 0.5), 0});
  const DrawMesh drawn = make_draw_mesh(box, field.get());
  EXPECT_DOUBLE_EQ(drawn.box.low.y, -0.5);
  EXPECT_DOUBLE_EQ(drawn.box.high.y, 0.75);
}

TEST(Rasterizer, AFieldGivesItsColoursInsteadOfTheBodys) {
  Rasterizer rasterizer;
  Frame frame;
  frame.bodies = {body_of(make_box({1, 1, 1}, 0.25), 0)};
  frame.scale = FieldScale{"displacement", "m", 2, 4};
  // Below 2 on the left, above 4 on the right: the map's two ends, dark violet and yellow.
  frame.bodies[0].field = field_of(*frame.bodies[0].mesh, [](const Vec3& p) { return 3 + 20 * p.x; });
  const Image image = rasterizer.render(frame, plain_view(200, 200));
  const std::uint8_t *left = image.pixel(75, 100), *right = image.pixel(125, 100);
  EXPECT_GT(left[2], left[1]);
  EXPECT_GT(left[0], left[1]);
  EXPECT_GT(right[0], 2 * right[2]);
  EXPECT_GT(right[1], 2 * right[2]);
  // Another field on the same mesh is seen.
  frame.bodies[0].field = field_of(*frame.bodies[0].mesh, [](const Vec3&) { return 9; });
  const Image other = rasterizer.render(frame, plain_view(200, 200));
  EXPECT_GT(other.pixel(75, 100)[1], 2 * other.pixel(75, 100)[2]);
}

TEST(Rasterizer, CrackFacesKeepTheirColourWhereAFieldDoesNotReach) {
  Rasterizer rasterizer;
  Frame frame;
  frame.bodies = {body_of(all_crack(make_box({1, 1, 1}, 0.25)), 0)};
  const Image plain = rasterizer.render(frame, plain_view(120, 120));
  frame.scale = FieldScale{"displacement", "m", 0, 1};
  auto field = field_of(*frame.bodies[0].mesh, [](const Vec3&) { return 0.5; });
  field->on_cracks = false;
  frame.bodies[0].field = field;
  EXPECT_EQ(rasterizer.render(frame, plain_view(120, 120)), plain);  // too small for a legend
}

TEST(Rasterizer, RefusesAFieldOfAnotherMesh) {
  Rasterizer rasterizer;
  Frame frame;
  frame.bodies = {body_of(make_box({1, 1, 1}, 0.25), 0)};
  frame.scale = FieldScale{};
  frame.bodies[0].field = field_of(make_box({1, 1, 1}, 0.5), [](const Vec3&) { return 0; });
  EXPECT_THROW(rasterizer.render(frame, plain_view(60, 60)), InputError);
}

TEST(Legend, NumbersHaveThreeDigitsAndAPrefix) {
  EXPECT_EQ(legend_number(0, "m"), "0 m");
  EXPECT_EQ(legend_number(2.4963e-5, "m"), "25 um");
  EXPECT_EQ(legend_number(5186.2, "J/m3"), "5.19 kJ/m3");
  EXPECT_EQ(legend_number(-1.5e6, "Pa"), "-1.5 MPa");
  EXPECT_EQ(legend_number(1e-20, "m"), "1e-08 pm");
}

TEST(Legend, TheBarRunsFromTheMapsLowEndBelowToItsHighEndAbove) {
  Image image{640, 480, std::vector<std::uint8_t>(3 * 640 * 480, 255)};
  draw_legend({"stress", "Pa", 0, 1}, image);
  const auto ink = [](float t) {
    std::array<int, 3> c{};
    for (std::size_t k = 0; k < 3; ++k) c[k] = static_cast<int>(std::lround(255 * map_colour(t)[k]));
    return c;
  };
  const auto at = [&](int y) {
    const std::uint8_t* p = image.pixel(25, y);
    return std::array<int, 3>{p[0], p[1], p[2]};
  };
  for (int k = 0; k < 3; ++k) {  // half a pixel of 240 and the rounding
    const auto i = static_cast<std::size_t>(k);
    EXPECT_NEAR(at(120)[i], ink(1)[i], 3);
    EXPECT_NEAR(at(359)[i], ink(0)[i], 3);
    EXPECT_NEAR(at(240)[i], ink(0.5f)[i], 3);
  }
  // A picture too small for it stays as it is.
  Image small{64, 64, std::vector<std::uint8_t>(3 * 64 * 64, 255)};
  const Image before = small;
  draw_legend({"stress", "Pa", 0, 1}, small);
  EXPECT_EQ(small, before);
}

}  // namespace
}  // namespace sherd
