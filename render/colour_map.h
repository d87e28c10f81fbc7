// Numbers to colours: viridis, even to the eye and readable in grey and to the colour-blind.
#pragma once
#include <array>
#include <string>

namespace sherd {

// sRGB, 0..1; t outside 0..1 gives the end's colour.
std::array<float, 3> map_colour(float t);
// GLSL: vec3 map_colour(float t), the same in linear RGB.
std::string colour_map_glsl();

}  // namespace sherd
