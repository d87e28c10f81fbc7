#include "render/colour_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace sherd {
namespace {

// matplotlib's viridis (Smith and van der Walt, CC0) at eighths; straight lines between, in sRGB, are within 0.02.
constexpr std::array<std::array<int, 3>, 9> kViridis{{{0x44, 0x01, 0x54},
                                                      {0x47, 0x2d, 0x7b},
                                                      {0x3b, 0x52, 0x8b},
                                                      {0x2c, 0x72, 0x8e},
                                                      {0x21, 0x91, 0x8c},
                                                      {0x28, 0xae, 0x80},
                                                      {0x5e, 0xc9, 0x62},
                                                      {0xad, 0xdc, 0x30},
                                                      {0xfd, 0xe7, 0x25}}};

}  // namespace

std::array<float, 3> map_colour(float t) {
  const float x = std::clamp(t, 0.0f, 1.0f) * static_cast<float>(kViridis.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(x), kViridis.size() - 2);
  const float part = x - static_cast<float>(i);
  std::array<float, 3> colour{};
  for (std::size_t k = 0; k < 3; ++k)
    colour[k] = ((1 - part) * static_cast<float>(kViridis[i][k]) + part * static_cast<float>(kViridis[i + 1][k])) / 255;
  return colour;
}

std::string colour_map_glsl() {
  std::string points;
  for (const auto& c : kViridis)
    points += fmt::format("{}vec3({}, {}, {})", points.empty() ? "" : ", ", c[0], c[1], c[2]);
  return fmt::format(R"(
const vec3 kMap[{0}] = vec3[{0}]({1});
vec3 map_colour(float t) {{
  float x = clamp(t, 0.0, 1.0) * float({0} - 1);
  int i = min(int(x), {0} - 2);
  vec3 c = mix(kMap[i], kMap[i + 1], x - float(i)) / 255.0;
  return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c));
}}
)",
                     kViridis.size(), points);
}

}  // namespace sherd
