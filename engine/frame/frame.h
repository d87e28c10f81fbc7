// A frame: everything the renderer and the writers may know. Meshes are shared, not copied.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

struct Colour {
  float r = 0.8f, g = 0.8f, b = 0.8f;  // linear, 0..1
};

// A quantity shown on the surface of one mesh in place of the body's colour.
struct SurfaceField {
  std::vector<float> value;  // at the corners of triangles, three a triangle: it may jump at creases
  bool on_cracks = true;     // false: crack faces keep their colour
  Vec3Column displacement;   // of vertices as drawn, m; empty: none
};

// What the colours of all fields of a frame mean.
struct FieldScale {
  std::string name, unit;  // unit "" or SI
  Real low = 0, high = 1;  // values of the two ends
};

struct FrameBody {
  std::uint32_t id = 0;  // body id of the run
  std::string name;
  std::shared_ptr<const SurfaceMesh> mesh;  // mesh coordinates
  std::uint32_t mesh_version = 0;           // (id, version) identifies an uploaded mesh
  Mat3 rotation = Mat3::identity();         // world = rotation * x + translation
  Vec3 translation;
  Colour colour;                              // original surface
  Colour crack_colour;                        // faces of FaceKind::kCrack
  std::uint32_t parent = kNone;               // id of the body it broke off; kNone for a body of the scene
  float opacity = 1;                          // of the original surface, 0..1; crack faces stay opaque
  std::shared_ptr<const SurfaceField> field;  // of `mesh`; null: the colours above
};

struct Frame {
  std::size_t index = 0;
  Real time = 0;  // s
  std::vector<FrameBody> bodies;
  std::optional<FieldScale> scale;  // when a body may have a field
};

struct View {
  Vec3 eye{0, 1, 3}, target{0, 0, 0}, up{0, 1, 0};
  Real field_of_view = 40;    // vertical, degrees
  Vec3 light{0.5, 1.0, 0.4};  // direction towards the sun, world, any length > 0
  bool wireframe = false;     // draw the edges of the triangles over the bodies
  bool ground = true;         // draw the plane y = ground_height and shadows on it
  Real ground_height = 0;     // m
  Colour ground_colour{0.62f, 0.60f, 0.57f};
  Colour sky_colour{0.86f, 0.90f, 0.95f};
  int width = 1280, height = 720;  // pixels
  int samples = 4;                 // antialiasing: samples per pixel (1, 2, 4, 8)
};

}  // namespace sherd
