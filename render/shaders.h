// The shading language texts, version 330. Positions are world metres relative to View::target.
#pragma once
#include <string>

namespace sherd::shaders {

std::string body_vertex();        // a_position, a_normal -> v_position, v_normal
std::string ground_vertex();      // a disc under the target
std::string screen_vertex();      // one triangle over the whole target -> v_uv in 0..1
std::string depth_fragment();     // shadow map: nothing but depth
std::string geometry_fragment();  // view-space normal and distance, for the occlusion pass
std::string occlusion_fragment();
std::string blur_fragment();
std::string surface_fragment();  // bodies and ground, linear light
std::string edge_fragment();     // one colour, blended
std::string sky_fragment();
std::string finish_fragment();  // tone curve, box filter, sRGB

}  // namespace sherd::shaders
