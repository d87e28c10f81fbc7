// What the rendering laws measure in a picture, and the scenes they look at.
#pragma once
#include <gtest/gtest.h>

#include <filesystem>

#include "engine/mesh/shapes.h"
#include "render/rasterizer.h"

namespace sherd {

inline FrameBody body_of(SurfaceMesh mesh, std::uint32_t id, const Vec3& translation = {}) {
  FrameBody body;
  body.id = id;
  body.name = "body";
  body.mesh = std::make_shared<const SurfaceMesh>(std::move(mesh));
  body.translation = translation;
  body.colour = {0.8f, 0.8f, 0.8f};
  body.crack_colour = {0.8f, 0.1f, 0.05f};
  return body;
}

inline SurfaceMesh all_crack(SurfaceMesh mesh) {
  mesh.faces.resize(mesh.triangle_count());
  for (FaceKind& kind : mesh.faces.kind) kind = FaceKind::kCrack;
  return mesh;
}

// Straight ahead, no ground, a sky that no lit body resembles.
inline View plain_view(int width, int height) {
  View view;
  view.eye = {0, 0, 5};
  view.target = {0, 0, 0};
  view.field_of_view = 40;
  view.light = {0.3, 0.5, 1};
  view.ground = false;
  view.sky_colour = {0.0f, 0.0f, 0.6f};  // below the tone curve's shoulder: no red at all
  view.width = width, view.height = height;
  return view;
}

inline double brightness(const Image& image, int x, int y) {
  const std::uint8_t* p = image.pixel(x, y);
  return (p[0] + p[1] + p[2]) / 3.0;
}

// Against the blue sky of plain_view: red is all the body's.
inline bool shows_body(const Image& image, int x, int y) {
  return image.pixel(x, y)[0] > 30;
}

// A folder of this test's own, removed with it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(::testing::TempDir()) /
            (std::string("sherd_render_") + test->test_suite_name() + "_" + test->name());
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace sherd
