#include "engine/step/framing.h"

#include <algorithm>
#include <numbers>

namespace sherd {

View frame_box(const Box& box, const View& settings) {
  View view = settings;
  const Vec3 direction = normalized(Vec3{0.45, 0.32, 1.0});
  const Vec3 right = normalized(cross(Vec3{0, 1, 0}, direction)), up = cross(direction, right);
  const Real tan_vertical = std::tan(0.5 * settings.field_of_view * std::numbers::pi / 180);
  const Real tan_horizontal = tan_vertical * settings.width / settings.height;
  view.target = box.centre();
  // The least distance at which all eight corners are inside the picture.
  Real distance = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner =
        Vec3{i & 1 ? box.high.x : box.low.x, i & 2 ? box.high.y : box.low.y, i & 4 ? box.high.z : box.low.z} -
        view.target;
    const Real depth = dot(corner, direction);
    distance = std::max({distance, depth + std::abs(dot(corner, right)) / tan_horizontal,
                         depth + std::abs(dot(corner, up)) / tan_vertical});
  }
  view.eye = view.target + direction * (1.08 * std::max(distance, 1e-6));
  return view;
}

}  // namespace sherd
