// Matrices of the view and of the sun. Everything is drawn relative to View::target, so single precision never sees
// large world coordinates.
#pragma once
#include <array>

#include "engine/frame/frame.h"

namespace sherd {

using Matrix4 = std::array<float, 16>;  // column major, as OpenGL reads it

struct Camera {
  Mat3 axes;               // rows: right, up, backward (towards the eye), world
  Vec3 eye;                // relative to the target
  Real distance = 1;       // eye to target, m
  Real tan_half = 0;       // of the vertical field of view
  Real near = 0, far = 0;  // m
  Matrix4 view_projection;
};
// `view` has been checked: finite, eye apart from the target. An up direction along the line of sight is replaced by
// another.
Camera make_camera(const View& view);

struct Sun {
  Vec3 direction;  // towards the sun, unit
  Matrix4 clip;    // world relative to target -> clip space of the shadow map
  Mat3 axes;       // rows: right, up, towards the sun
  Real width = 0;  // of the map, m, both ways
  Real depth = 0;  // of the map, m
};
// The smallest map around `casters` (relative to the target, at least one), in steps of width and position that keep
// the texels of a still body still while others move.
Sun make_sun(const Vec3& light, const std::array<Vec3, 8>* casters, std::size_t count, Real largest, int texels);

}  // namespace sherd
