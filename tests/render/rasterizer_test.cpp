#include "render/rasterizer.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <thread>

#include "kernels/core/error.h"
#include "tests/render/picture.h"

namespace sherd {
namespace {

TEST(Rasterizer, ASphereIsRoundAndInTheMiddle) {
  Rasterizer rasterizer;
  Frame frame;
  frame.bodies = {body_of(make_sphere(1, 0.05), 0)};
  const View view = plain_view(320, 240);
  const Image image = rasterizer.render(frame, view);
  double area = 0, x_sum = 0, y_sum = 0;
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 320; ++x)
      if (shows_body(image, x, y)) area += 1, x_sum += x + 0.5, y_sum += y + 0.5;
  // The silhouette of a sphere of radius r at distance d is a circle of radius r / sqrt(d^2 - r^2) at unit distance.
  const double scale = 120 / std::tan(20 * std::numbers::pi / 180), radius = scale / std::sqrt(24.0);
  EXPECT_NEAR(x_sum / area, 160, 0.01 * radius);
  EXPECT_NEAR(y_sum / area, 120, 0.01 * radius);
  // Edge pixels are counted whole or not at all: half a pixel of bias would be 1.5 %; a facetted sphere loses 0.06 %.
  EXPECT_NEAR(area / (std::numbers::pi * radius * radius), 1, 0.015);
}

TEST(Rasterizer, TheTopRowIsUpInTheWorldAndTheRightColumnIsRight) {
  Rasterizer rasterizer;
  Frame frame;
  frame.bodies = {body_of(make_sphere(0.3, 0.1), 0, {1, 0.8, 0})};
  const Image image = rasterizer.render(frame, plain_view(200, 150));
  double x_mean = 0, y_mean = 0, count = 0;
  for (int y = 0; y < 150; ++y)
    for (int x = 0; x < 200; ++x)
      if (shows_body(image, x, y)) x_mean += x, y_mean += y, count += 1;
  ASSERT_GT(count, 0);
  EXPECT_GT(x_mean / count, 110);
  EXPECT_LT(y_mean / count, 65);
}

TEST(Rasterizer, TheShadowFallsOnTheSideAwayFromTheLight) {
  Rasterizer rasterizer;
  Frame frame;
  frame.bodies = {body_of(make_sphere(0.5, 0.1), 0, {0, 0.5, 0})};
  View view;
  view.eye = {0, 6, 0.01}, view.target = {0, 0, 0}, view.up = {0, 0, -1};
  view.width = 240, view.height = 240;
  // Seen from above: the shadow's centre lies 0.5 m / tan(elevation 45 degrees) = 0.5 m and its far end 1.2 m from the
  // sphere's foot. 1 m from the foot is out of the sphere's silhouette (0.55 m here) and within the shadow.
  const double metre = 120 / std::tan(20 * std::numbers::pi / 180) / 6;
  for (const double side : {1.0, -1.0}) {
    view.light = {side, 1, 0};
    const Image image = rasterizer.render(frame, view);
    const double lit = brightness(image, static_cast<int>(120 + side * metre), 120);
    const double shaded = brightness(image, static_cast<int>(120 - side * metre), 120);
    EXPECT_LT(shaded, 0.8 * lit) << "light from x = " << side;
  }
}

TEST(Rasterizer, GroundFarFromAnyShadowIsLitEvenlyBehindTheShadowMap) {
  Rasterizer rasterizer;
  Frame frame;
  frame.bodies = {body_of(make_sphere(0.2, 0.1), 0, {-0.8, 0.2, 0})};
  View view;
  view.eye = {0, 6, 0.01}, view.target = {0, 0, 0}, view.up = {0, 0, -1}, view.light = {-1, 1, 0};
  view.width = 240, view.height = 240;
  const Image image = rasterizer.render(frame, view);
  // The shadow ends within 0.6 m of the foot; all points of the right half are the same distance class from the middle.
  for (int x = 130; x < 240; x += 5)
    EXPECT_NEAR(brightness(image, x, 120), brightness(image, 120, 120 + (x - 120)), 3) << x;
}

TEST(Rasterizer, ALitFlatFaceHasNoShadowPattern) {
  Rasterizer rasterizer;
  Frame frame;
  frame.bodies = {body_of(make_box({2, 2, 2}, 0.5), 0)};
  View view = plain_view(200, 200);
  for (const Vec3 light : {Vec3{0.1, 0.1, 1}, Vec3{2, 1, 1}, Vec3{4, 1, 1}}) {
    view.light = light;
    const Image image = rasterizer.render(frame, view);
    for (int y = 60; y < 140; ++y)
      for (int x = 60; x < 140; ++x)
        // Gloss and occlusion change slowly; a self-shadowed pixel would differ from its neighbour by tens.
        ASSERT_NEAR(brightness(image, x, y), brightness(image, x + 1, y), 4) << x << ' ' << y << " light " << light.x;
  }
}

TEST(Rasterizer, CrackFacesShowTheCrackColour) {
  Rasterizer rasterizer;
  SurfaceMesh box = make_box({1, 1, 1}, 1);
  box.faces.resize(box.triangle_count());
  for (std::size_t t = 0; t < box.triangle_count(); ++t)
    if (box.centroid(t).z > 0.49 && box.centroid(t).y > -0.5) box.faces.kind[t] = FaceKind::kCrack;
  Frame frame;
  frame.bodies = {body_of(box, 0)};
  frame.bodies[0].colour = {0.1f, 0.6f, 0.1f};
  View view = plain_view(200, 200);
  view.eye = {0, 3, 4};
  const Image image = rasterizer.render(frame, view);
  int red = 0, green = 0;
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x) {
      const std::uint8_t* p = image.pixel(x, y);
      red += p[0] > p[1] + 60 && p[0] > p[2] + 60, green += p[1] > p[0] + 40 && p[1] > p[2] + 40;
    }
  EXPECT_GT(red, 400);
  EXPECT_GT(green, 400);
}

TEST(Rasterizer, TheSameFrameGivesTheSameBytesWhateverWasDrawnBefore) {
  Rasterizer rasterizer, fresh;
  Frame frame, other;
  frame.bodies = {body_of(make_sphere(0.5, 0.1), 0, {0, 0.5, 0}),
                  body_of(make_box({1, 0.4, 0.4}, 0.2), 1, {1, 0.2, 0})};
  other.bodies = {body_of(make_box({2, 1, 1}, 0.2), 0), body_of(make_sphere(0.3, 0.1), 7)};
  other.bodies[1].opacity = 0.4f;
  View view;
  view.width = 200, view.height = 120;
  View large = view;
  large.width = 260, large.samples = 8;
  const Image first = rasterizer.render(frame, view);
  rasterizer.render(other, large);
  EXPECT_EQ(first, rasterizer.render(frame, view));
  EXPECT_EQ(first, fresh.render(frame, view));
  Image threaded;
  std::thread([&] { threaded = rasterizer.render(frame, view); }).join();
  EXPECT_EQ(first, threaded);
}

TEST(Rasterizer, TwoMeshesUnderOneIdAndVersionAreRefused) {
  Rasterizer rasterizer;
  Frame frame;
  frame.bodies = {body_of(make_sphere(0.5, 0.2), 0), body_of(make_box({1, 1, 1}, 0.5), 0)};
  EXPECT_THROW(rasterizer.render(frame, plain_view(64, 64)), InputError);
}

TEST(Rasterizer, AntialiasingFillsEdgesWithIntermediateValues) {
  Rasterizer rasterizer;
  Frame frame;
  frame.bodies = {body_of(make_sphere(1, 0.1), 0)};
  View view = plain_view(200, 200);
  const auto edge_blues = [&](int samples) {
    view.samples = samples;
    const Image image = rasterizer.render(frame, view);
    // The sky has no red and the body much: little red occurs only in blends along the rim.
    std::set<int> values;
    for (int x = 0; x < 200; ++x)
      for (int y = 0; y < 200; ++y)
        if (image.pixel(x, y)[0] > 5 && image.pixel(x, y)[0] < 60) values.insert(image.pixel(x, y)[0]);
    return values.size();
  };
  const std::size_t none = edge_blues(1);
  EXPECT_GT(edge_blues(4), none + 3);
  EXPECT_GT(edge_blues(8), none + 3);
}

TEST(Rasterizer, TheCloserBodyHidesTheOther) {
  Rasterizer rasterizer;
  Frame frame;
  FrameBody near = body_of(make_sphere(0.5, 0.1), 0, {0, 0, 1}), far = body_of(make_sphere(0.5, 0.1), 1, {0, 0, -1});
  near.colour = {0.7f, 0.1f, 0.1f}, far.colour = {0.1f, 0.7f, 0.1f};
  const View view = plain_view(100, 100);
  for (int order = 0; order < 2; ++order) {
    frame.bodies = order == 0 ? std::vector{near, far} : std::vector{far, near};
    const Image image = rasterizer.render(frame, view);
    EXPECT_GT(image.pixel(50, 50)[0], image.pixel(50, 50)[1] + 50);
  }
}

TEST(Rasterizer, ATranslucentBodyShowsTheCrackInside) {
  Rasterizer rasterizer;
  Frame frame;
  frame.bodies = {body_of(make_sphere(1, 0.1), 0), body_of(all_crack(make_box({0.5, 0.5, 0.05}, 0.1)), 1)};
  const View view = plain_view(100, 100);
  const auto redness = [&](float opacity) {
    frame.bodies[0].opacity = opacity;
    const Image image = rasterizer.render(frame, view);
    const std::uint8_t* p = image.pixel(50, 50);
    return p[0] - p[1];
  };
  EXPECT_LT(redness(1), 30);
  EXPECT_GT(redness(0.25f), 60);
}

// A box's front face is two triangles when its edge is the whole side: its diagonal runs through the middle.
TEST(Rasterizer, AWireframeDarkensEdgesAndNothingElse) {
  Rasterizer rasterizer;
  Frame frame;
  frame.bodies = {body_of(make_box({2, 2, 2}, 2), 0)};
  View view = plain_view(200, 200);
  const Image plain = rasterizer.render(frame, view);
  view.wireframe = true;
  const Image wired = rasterizer.render(frame, view);
  std::size_t darker = 0, changed_off_edges = 0;
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x) {
      const double change = brightness(wired, x, y) - brightness(plain, x, y);
      EXPECT_LT(change, 2);
      const bool middle = std::abs(x - 99.5) < 50 && std::abs(y - 99.5) < 50;
      const bool diagonal = std::abs(std::abs(x - 99.5) - std::abs(y - 99.5)) < 3;
      if (middle && change < -30) ++darker;
      if (middle && !diagonal && std::abs(change) > 2) ++changed_off_edges;
    }
  EXPECT_GT(darker, 90u);  // the diagonal crosses 100 rows there
  EXPECT_EQ(changed_off_edges, 0u);
}

TEST(Rasterizer, AMovedPoseMovesThePicture) {
  Rasterizer rasterizer;
  Frame frame;
  // A mesh far from its own origin, brought back by the pose: single precision must not show.
  SurfaceMesh mesh = make_sphere(0.5, 0.1);
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) mesh.vertices.add(i, {1e5, -2e5, 3e5});
  const View view = plain_view(120, 120);
  frame.bodies = {body_of(std::move(mesh), 0, {-1e5, 2e5, -3e5})};
  const Image moved = rasterizer.render(frame, view);
  frame.bodies = {body_of(make_sphere(0.5, 0.1), 1)};
  const Image plain = rasterizer.render(frame, view);
  int different = 0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 120; ++x) different += std::abs(brightness(moved, x, y) - brightness(plain, x, y)) > 8;
  EXPECT_LT(different, 20);  // of some 3000 on the sphere; coordinates were rounded at 3e-11 m before the cancelling
}

TEST(Rasterizer, AnUndrawableViewOrBodyIsRefused) {
  Rasterizer rasterizer;
  const Real nan = std::numeric_limits<Real>::quiet_NaN();
  Frame frame;
  frame.bodies = {body_of(make_sphere(0.5, 0.2), 0)};
  const auto refused_view = [&](auto&& change) {
    View view = plain_view(64, 64);
    change(view);
    EXPECT_THROW(rasterizer.render(frame, view), InputError);
  };
  refused_view([](View& v) { v.width = 0; });
  refused_view([](View& v) { v.height = 100000; });
  refused_view([](View& v) { v.target = v.eye; });
  refused_view([](View& v) { v.light = {}; });
  refused_view([](View& v) { v.field_of_view = 180; });
  refused_view([](View& v) { v.samples = 3; });
  refused_view([&](View& v) { v.eye.x = nan; });
  const auto refused_body = [&](auto&& change) {
    Frame bad = frame;
    change(bad.bodies[0]);
    EXPECT_THROW(rasterizer.render(bad, plain_view(64, 64)), InputError);
  };
  refused_body([](FrameBody& b) { b.mesh = nullptr; });
  refused_body([&](FrameBody& b) { b.translation.y = nan; });
  refused_body([&](FrameBody& b) { b.rotation[1][2] = nan; });
  refused_body([](FrameBody& b) { b.opacity = 2; });
  EXPECT_NO_THROW(rasterizer.render(frame, plain_view(64, 64)));
}

TEST(Rasterizer, LookingAlongTheUpDirectionAndAnEmptyFrameStillGiveAPicture) {
  Rasterizer rasterizer;
  View view;
  view.eye = {0, 3, 0}, view.target = {}, view.width = 33, view.height = 17;
  Frame frame;
  EXPECT_EQ(rasterizer.render(frame, view).rgb.size(), 3u * 33 * 17);
  frame.bodies = {body_of(SurfaceMesh{}, 0), body_of(make_sphere(0.5, 0.2), 1)};
  EXPECT_EQ(rasterizer.render(frame, view).rgb.size(), 3u * 33 * 17);
}

}  // namespace
}  // namespace sherd
