#include "render/shaders.h"

#include "render/colour_map.h"

namespace sherd::shaders {
namespace {

const char* const kVersion = "#version 330 core\n";

// Constant below the horizon, so the ground can fade into it without a seam.
const char* const kSky = R"(
uniform vec3 u_sky;
vec3 sky(vec3 direction) {
  float height = smoothstep(0.0, 0.75, direction.y);
  return u_sky * mix(vec3(1.0), vec3(0.66, 0.76, 0.90), height);
}
)";

// Soft shadow of the sun. A first set of taps finds what is in the way, and how far from it: the penumbra widens with
// that distance. Taps lie on a golden-angle spiral. The reference depth follows the receiver's plane, so that wide
// filters do not shade the surface itself.
const char* const kShadow = R"(
uniform sampler2D u_shadow_depth;
uniform sampler2DShadow u_shadow;
uniform mat4 u_sun_clip;
uniform mat3 u_sun_axes;
uniform float u_sun_width;
uniform float u_sun_depth;
uniform float u_shadow_texel;
uniform float u_sun_tangent;

vec2 spiral(int i, int n, float turn) {
  float angle = 2.39996323 * float(i) + turn;
  return sqrt((float(i) + 0.5) / float(n)) * vec2(cos(angle), sin(angle));
}

// Beyond the map's far end nothing was drawn: depth 1 there is lit.
float reference(float depth, vec2 slope, vec2 tap) { return min(depth + dot(slope, tap), 1.0); }

float sunlight(vec3 p, vec3 n) {
  vec3 m = u_sun_axes * n;
  float texel = u_shadow_texel * u_sun_width;
  vec3 q = p + n * texel * (1.0 + 2.0 * (1.0 - max(m.z, 0.0)));
  vec3 s = 0.5 * (u_sun_clip * vec4(q, 1.0)).xyz + 0.5;
  if (any(lessThan(s.xy, vec2(0.0))) || any(greaterThan(s.xy, vec2(1.0)))) return 1.0;
  // d depth / d uv on the receiver's plane; steep planes are cut off where the cosine law has darkened them anyway.
  vec2 slope = m.xy / max(m.z, 0.2) * (u_sun_width / u_sun_depth);
  float constant = texel / u_sun_depth;
  float turn = 6.2831853 * fract(52.9829189 * fract(dot(floor(gl_FragCoord.xy), vec2(0.06711056, 0.00583715))));

  float reach = clamp(u_sun_tangent * u_sun_depth / u_sun_width, 3.0 * u_shadow_texel, 0.05);
  float blocker = 0.0, blockers = 0.0;
  for (int i = 0; i < 12; ++i) {
    vec2 d = reach * spiral(i, 12, turn);
    float depth = texture(u_shadow_depth, s.xy + d).r;
    if (depth < reference(s.z, slope, d) - constant - abs(slope.x + slope.y) * 0.5 * u_shadow_texel)
      blocker += depth, blockers += 1.0;
  }
  // A thin caster can slip between the taps.
  if (blockers == 0.0) return texture(u_shadow, vec3(s.xy, reference(s.z, slope, vec2(0.0)) - constant));
  float gap = max(s.z - blocker / blockers, 0.0) * u_sun_depth;
  float radius = clamp(u_sun_tangent * gap / u_sun_width, 1.6 * u_shadow_texel, reach);
  float lit = 0.0;
  for (int i = 0; i < 24; ++i) {
    vec2 d = radius * spiral(i, 24, turn);
    lit += texture(u_shadow, vec3(s.xy + d, reference(s.z, slope, d) - constant));
  }
  return lit / 24.0;
}
)";

}  // namespace

std::string body_vertex() {
  return std::string(kVersion) + R"(
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in float a_value;
uniform mat4 u_view_projection;
uniform mat3 u_rotation;
uniform vec3 u_translation;
uniform vec2 u_range;
out vec3 v_position;
out vec3 v_normal;
out float v_value;
void main() {
  v_value = (a_value - u_range.x) / (u_range.y - u_range.x);
  v_position = u_rotation * a_position + u_translation;
  v_normal = u_rotation * a_normal;
  gl_Position = u_view_projection * vec4(v_position, 1.0);
}
)";
}

std::string ground_vertex() {
  return std::string(kVersion) + R"(
uniform mat4 u_view_projection;
uniform float u_ground_height;
uniform float u_ground_radius;
uniform int u_ground_sectors;
out vec3 v_position;
out vec3 v_normal;
out float v_value;
void main() {
  v_value = 0.0;
  int corner = gl_VertexID % 3;
  float angle = -6.2831853 * float(gl_VertexID / 3 + corner - 1) / float(u_ground_sectors);
  vec2 p = corner == 0 ? vec2(0.0) : u_ground_radius * vec2(cos(angle), sin(angle));
  v_position = vec3(p.x, u_ground_height, p.y);
  v_normal = vec3(0.0, 1.0, 0.0);
  gl_Position = u_view_projection * vec4(v_position, 1.0);
}
)";
}

std::string screen_vertex() {
  return std::string(kVersion) + R"(
out vec2 v_uv;
void main() {
  v_uv = vec2(gl_VertexID == 1 ? 2.0 : 0.0, gl_VertexID == 2 ? 2.0 : 0.0);
  gl_Position = vec4(2.0 * v_uv - 1.0, 1.0, 1.0);
}
)";
}

std::string depth_fragment() {
  return std::string(kVersion) + "void main() {}\n";
}

std::string geometry_fragment() {
  return std::string(kVersion) + R"(
in vec3 v_position;
in vec3 v_normal;
uniform vec3 u_eye;
uniform mat3 u_view_axes;
out vec4 o_geometry;
void main() {
  vec3 n = normalize(gl_FrontFacing ? v_normal : -v_normal);
  o_geometry = vec4(u_view_axes * n, -(u_view_axes * (v_position - u_eye)).z);
}
)";
}

// Share of the sky hidden by what the screen shows nearby: the cosine-weighted, distance-weighted mean of how far
// neighbours rise above the tangent plane (after McGuire, Mara and Luebke 2012).
std::string occlusion_fragment() {
  return std::string(kVersion) + R"(
in vec2 v_uv;
uniform sampler2D u_geometry;
uniform vec2 u_tangent;
uniform float u_radius;
out vec4 o_occlusion;
vec3 view_position(ivec2 pixel, float distance) {
  vec2 uv = (vec2(pixel) + 0.5) / vec2(textureSize(u_geometry, 0));
  return distance * vec3((2.0 * uv - 1.0) * u_tangent, -1.0);
}
void main() {
  ivec2 size = textureSize(u_geometry, 0), pixel = ivec2(gl_FragCoord.xy);
  vec4 here = texelFetch(u_geometry, pixel, 0);
  if (here.w <= 0.0) {
    o_occlusion = vec4(1.0, 0.0, 0.0, 1.0);
    return;
  }
  vec3 p = view_position(pixel, here.w), n = normalize(here.xyz);
  float reach = clamp(u_radius / (here.w * u_tangent.y) * 0.5 * float(size.y), 2.0, 0.12 * float(size.y));
  float turn = 6.2831853 / 16.0 * float((pixel.x * 5 + pixel.y * 11 + (pixel.x & pixel.y & 3)) & 15);
  float sum = 0.0;
  const int kTaps = 14;
  for (int i = 0; i < kTaps; ++i) {
    float r = (float(i) + 0.5) / float(kTaps);
    float angle = 2.39996323 * float(i) + turn;
    ivec2 q = clamp(pixel + ivec2(round(reach * r * vec2(cos(angle), sin(angle)))), ivec2(0), size - 1);
    float distance = texelFetch(u_geometry, q, 0).w;
    if (distance <= 0.0) continue;
    vec3 v = view_position(q, distance) - p;
    float vv = dot(v, v), fall = max(1.0 - vv / (u_radius * u_radius), 0.0);
    float rise = dot(v, n) * inversesqrt(vv + 1e-4 * u_radius * u_radius);
    sum += fall * fall * max(rise - 0.06, 0.0);
  }
  o_occlusion = vec4(max(1.0 - 1.7 * sum / float(kTaps), 0.0), here.w, 0.0, 1.0);
}
)";
}

// Means over four by four pixels: one period of the pattern that turns the spirals.
std::string blur_fragment() {
  return std::string(kVersion) + R"(
uniform sampler2D u_occlusion;
out vec4 o_occlusion;
void main() {
  ivec2 size = textureSize(u_occlusion, 0), pixel = ivec2(gl_FragCoord.xy);
  float distance = texelFetch(u_occlusion, pixel, 0).g, sum = 0.0, weights = 0.0;
  for (int y = -2; y < 2; ++y)
    for (int x = -2; x < 2; ++x) {
      vec2 sample_here = texelFetch(u_occlusion, clamp(pixel + ivec2(x, y), ivec2(0), size - 1), 0).rg;
      float weight = abs(sample_here.g - distance) <= 0.03 * distance ? 1.0 : 0.0;
      sum += weight * sample_here.r, weights += weight;
    }
  o_occlusion = vec4(weights > 0.0 ? sum / weights : 1.0, distance, 0.0, 1.0);
}
)";
}

std::string surface_fragment() {
  return std::string(kVersion) + kSky + kShadow + colour_map_glsl() + R"(
in vec3 v_position;
in vec3 v_normal;
in float v_value;
uniform int u_field;
uniform vec3 u_eye;
uniform mat3 u_view_axes;
uniform vec3 u_sun;
uniform vec3 u_colour;
uniform vec3 u_bounce;
uniform float u_opacity;
uniform float u_gloss;
uniform float u_fade;
uniform sampler2D u_occlusion;
uniform vec2 u_size;
out vec4 o_colour;

// The occlusion is half as fine as the picture: mean of the four texels around, of those at this distance.
float ambient_light(float distance) {
  ivec2 size = textureSize(u_occlusion, 0);
  vec2 at = gl_FragCoord.xy / u_size * vec2(size) - 0.5, corner = floor(at), part = at - corner;
  float sum = 0.0, weights = 0.0;
  for (int i = 0; i < 4; ++i) {
    vec2 step = vec2(i & 1, i >> 1);
    vec2 there = texelFetch(u_occlusion, clamp(ivec2(corner + step), ivec2(0), size - 1), 0).rg;
    vec2 near = mix(1.0 - part, part, step);
    float off = abs(there.g - distance) / (0.02 * distance);
    float weight = (near.x * near.y + 1e-3) / (1.0 + off * off * off * off);
    sum += weight * there.r, weights += weight;
  }
  return sum / weights;
}

void main() {
  vec3 n = normalize(gl_FrontFacing ? v_normal : -v_normal), v = normalize(u_eye - v_position);
  vec3 base = u_field != 0 ? map_colour(v_value) : u_colour;
  float cosine = max(dot(n, u_sun), 0.0);
  // The map holds flat triangles: the flat normal, not the smooth one, says where they are.
  vec3 flat_normal = normalize(cross(dFdx(v_position), dFdy(v_position)));
  flat_normal = dot(flat_normal, n) < 0.0 ? -flat_normal : flat_normal;
  float sun = cosine > 0.0 ? cosine * sunlight(v_position, flat_normal) : 0.0;
  float open = u_opacity < 1.0 ? 1.0 : ambient_light(-(u_view_axes * (v_position - u_eye)).z);

  const vec3 kKey = vec3(0.98, 0.89, 0.76);
  vec3 above = vec3(0.30, 0.325, 0.37), side = vec3(0.19, 0.195, 0.205);
  vec3 below = vec3(0.05) + 0.22 * u_bounce;
  vec3 hemisphere = n.y > 0.0 ? mix(side, above, n.y) : mix(side, below, -n.y);
  // A weak lamp behind the camera's shoulder keeps forms readable on the side away from the sun.
  vec3 fill_from = normalize(vec3(-u_sun.x, 0.35, -u_sun.z) + 0.8 * v);
  float fill = 0.10 * max(dot(n, fill_from), 0.0);
  // Light that bounces between bright surfaces keeps creases from going grey (Jimenez et al. 2016).
  vec3 a = 2.04 * base - 0.33, b = -4.80 * base + 0.64, c = 2.76 * base + 0.69;
  vec3 opened = max(vec3(open), ((open * a + b) * open + c) * open);
  vec3 light = kKey * sun + opened * (hemisphere + fill);

  vec3 h = normalize(v + u_sun);
  // Clamped above as well: rounding makes a cosine exceed 1, and pow of a negative number is undefined.
  float facing = clamp(dot(n, v), 0.0, 1.0), fresnel = 0.04 + 0.96 * pow(1.0 - clamp(dot(h, v), 0.0, 1.0), 5.0);
  float rim = pow(1.0 - facing, 4.0);
  vec3 gloss = u_gloss * (kKey * (sun * fresnel * 9.0 * pow(max(dot(n, h), 0.0), 48.0)) + 0.12 * rim * open * above);
  if (u_field != 0) gloss *= 0.25;  // a highlight would read as another value
  vec3 colour = base * light + gloss;

  float alpha = 1.0;
  if (u_opacity < 1.0) {  // glass-like: dark, dense outlines, clear faces
    float edge = pow(1.0 - facing, 2.0);
    alpha = mix(u_opacity, 1.0, 0.8 * edge);
    colour *= 1.0 - 0.55 * edge;
  }
  if (u_fade > 0.0) {
    float away = length(v_position.xz) / u_fade;
    colour = mix(colour, u_sky, smoothstep(0.1, 1.0, away));
  }
  o_colour = vec4(colour * alpha, alpha);
}
)";
}

std::string edge_fragment() {
  return std::string(kVersion) + R"(
uniform vec3 u_colour;
uniform float u_opacity;
out vec4 o_colour;
void main() { o_colour = vec4(u_colour * u_opacity, u_opacity); }
)";
}

std::string sky_fragment() {
  return std::string(kVersion) + kSky + R"(
in vec2 v_uv;
uniform vec2 u_tangent;
uniform mat3 u_view_axes;
out vec4 o_colour;
void main() {
  vec3 ray = transpose(u_view_axes) * vec3((2.0 * v_uv - 1.0) * u_tangent, -1.0);
  o_colour = vec4(sky(normalize(ray)), 1.0);
}
)";
}

// The curve is Khronos' PBR Neutral: colours keep hue and strength up to bright light, then roll off to white.
std::string finish_fragment() {
  return std::string(kVersion) + R"(
uniform sampler2D u_light;
uniform int u_factor;
out vec4 o_colour;
vec3 tone(vec3 c) {
  const float kStart = 0.8 - 0.04, kDesaturation = 0.15;
  float low = min(c.r, min(c.g, c.b));
  c -= low < 0.08 ? low - 6.25 * low * low : 0.04;
  float peak = max(c.r, max(c.g, c.b));
  if (peak < kStart) return c;
  float d = 1.0 - kStart, rolled = 1.0 - d * d / (peak + d - kStart);
  float g = 1.0 - 1.0 / (kDesaturation * (peak - rolled) + 1.0);
  return mix(c * (rolled / peak), vec3(rolled), g);
}
void main() {
  vec3 sum = vec3(0.0);
  for (int y = 0; y < u_factor; ++y)
    for (int x = 0; x < u_factor; ++x)
      sum += tone(texelFetch(u_light, ivec2(gl_FragCoord.xy) * u_factor + ivec2(x, y), 0).rgb);
  vec3 c = clamp(sum / float(u_factor * u_factor), 0.0, 1.0);
  o_colour = vec4(mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c)), 1.0);
}
)";
}

}  // namespace sherd::shaders
