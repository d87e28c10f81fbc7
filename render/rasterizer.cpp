#include "render/rasterizer.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "kernels/core/error.h"
#include "render/camera.h"
#include "render/draw_cache.h"
#include "render/gl.h"
#include "render/legend.h"
#include "render/shaders.h"

#ifdef __SANITIZE_ADDRESS__
// OSMesa keeps a few words a context until the process ends; every program that links this file gets the exception.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libOSMesa\n";
}
#endif

namespace sherd {
namespace {

constexpr int kShadowTexels = 2048;
constexpr int kGroundSectors = 64;
constexpr int kLargestSide = 8192;              // pixels
constexpr Real kGroundReach = 5;                // eye distances from the target to where the ground has become sky
constexpr Real kShadowReach = 12;               // eye distances from the target within which bodies cast shadows
constexpr Real kOcclusionRadius = 0.1;          // of the picture's height at the target
constexpr Real kSunTangent = 0.07;              // half-width of the sun seen from the scene: a large, soft lamp
const Vec3 kEdgeColour{0.03, 0.035, 0.05};      // of a wireframe's lines
constexpr Real kEdge = 0.6, kFaintEdge = 0.15;  // their opacity

// Texture units.
constexpr int kShadowDepthUnit = 0, kShadowCompareUnit = 1, kOcclusionUnit = 2, kInputUnit = 3;

Vec3 to_vec(const Colour& c) {
  return {c.r, c.g, c.b};
}

bool is_colour(const Colour& c) {
  return is_finite(to_vec(c)) && std::min({c.r, c.g, c.b}) >= 0;
}

void check_view(const View& v) {
  const auto require = [](bool ok, const char* what, const char* remedy) {
    if (!ok) throw InputError(fmt::format("view: {}; {}", what, remedy));
  };
  require(v.width > 0 && v.height > 0 && v.width <= kLargestSide && v.height <= kLargestSide,
          "width and height must be 1 to 8192 pixels", "choose a picture size in that range");
  require(is_finite(v.eye) && is_finite(v.target) && is_finite(v.up) && is_finite(v.light),
          "eye, target, up and light must be finite", "correct the camera");
  require(norm(v.eye - v.target) > 0, "eye and target are the same point", "move the eye away from the target");
  require(norm(v.light) > 0, "the light has no direction", "give a vector towards the sun");
  require(v.field_of_view > 0 && v.field_of_view < 170, "the field of view must lie between 0 and 170 degrees",
          "correct the camera");
  require(std::isfinite(v.ground_height), "the ground height must be finite", "correct the ground");
  require(is_colour(v.ground_colour) && is_colour(v.sky_colour), "colours must be finite and not negative",
          "give linear values from 0 to 1");
  require(v.samples == 1 || v.samples == 2 || v.samples == 4 || v.samples == 8, "samples must be 1, 2, 4 or 8",
          "correct the antialiasing");
}

void check_body(const Frame& frame, const FrameBody& b) {
  const auto require = [&](bool ok, const char* what) {
    if (!ok)
      throw InputError(fmt::format("frame {}: body {} '{}' cannot be drawn: {}", frame.index, b.id, b.name, what));
  };
  require(b.mesh != nullptr, "it has no mesh");
  require(is_finite(b.translation) && is_finite(b.rotation.row(0)) && is_finite(b.rotation.row(1)) &&
              is_finite(b.rotation.row(2)),
          "its position or rotation is not finite");
  require(is_colour(b.colour) && is_colour(b.crack_colour), "its colours must be finite and not negative");
  require(!b.field || (frame.scale && b.field->value.size() == 3 * b.mesh->triangle_count()),
          "its field needs a scale and three values a triangle");
  require(b.opacity >= 0 && b.opacity <= 1, "its opacity must lie between 0 and 1");
}

// One body of the frame, placed relative to the view's target.
struct Placed {
  const FrameBody* body;
  const DrawBuffer* buffer;
  Vec3 translation;  // of the buffer's zero
  std::array<Vec3, 8> corners;
  bool translucent() const { return body->opacity < 1; }
  Vec3 centre() const { return 0.5 * (corners[0] + corners[7]); }
};

Placed place(const FrameBody& body, const DrawBuffer& buffer, const Vec3& target) {
  Placed p{&body, &buffer, body.rotation * buffer.origin() + (body.translation - target), {}};
  const Box& box = buffer.box();
  for (std::size_t i = 0; i < 8; ++i) {
    const Vec3 corner{i & 1 ? box.high.x : box.low.x, i & 2 ? box.high.y : box.low.y, i & 4 ? box.high.z : box.low.z};
    p.corners[i] = body.rotation * corner + (body.translation - target);
  }
  return p;
}

GLuint make_sampler(bool compare) {
  GLuint sampler = 0;
  glGenSamplers(1, &sampler);
  const GLint filter = compare ? GL_LINEAR : GL_NEAREST;
  glSamplerParameteri(sampler, GL_TEXTURE_MIN_FILTER, filter);
  glSamplerParameteri(sampler, GL_TEXTURE_MAG_FILTER, filter);
  glSamplerParameteri(sampler, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glSamplerParameteri(sampler, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glSamplerParameteri(sampler, GL_TEXTURE_COMPARE_MODE, compare ? GL_COMPARE_REF_TO_TEXTURE : GL_NONE);
  glSamplerParameteri(sampler, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  return sampler;
}

class Context {
 public:
  Context() {
    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              3,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              3,
                              0};
    context_ = OSMesaCreateContextAttribs(attributes, nullptr);
    if (!context_)
      throw InputError("rendering: OSMesa offers no OpenGL 3.3 core context; install a Mesa with the llvmpipe driver");
  }
  ~Context() { OSMesaDestroyContext(context_); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  void acquire() {
    SHERD_CHECK(OSMesaMakeCurrent(context_, pixels_.data(), GL_UNSIGNED_BYTE, kSide, kSide),
                "OSMesaMakeCurrent failed");
  }
  static void release() { OSMesaMakeCurrent(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); }

 private:
  // OSMesa wants a window of its own; all drawing goes to framebuffer objects.
  static constexpr int kSide = 16;
  std::array<unsigned char, 4 * kSide * kSide> pixels_{};
  OSMesaContext context_ = nullptr;
};

// A context belongs to one thread at a time: hold it only while drawing.
struct Current {
  explicit Current(Context& context) { context.acquire(); }
  ~Current() { Context::release(); }
  Current(const Current&) = delete;
  Current& operator=(const Current&) = delete;
};

// Render targets for one picture size.
struct Targets {
  int width, height, samples, factor;  // factor: supersampling along each side
  gl::Target geometry, occlusion, blurred, light, finished;
  std::optional<gl::Target> multisampled;

  Targets(int w, int h, int samples_wanted, int multisamples, int scale)
      : width(w),
        height(h),
        samples(samples_wanted),
        factor(scale),
        geometry(half(w * scale), half(h * scale), GL_RGBA32F, gl::Target::Depth::kBuffer, 0),
        occlusion(half(w * scale), half(h * scale), GL_RG32F, gl::Target::Depth::kNone, 0),
        blurred(half(w * scale), half(h * scale), GL_RG32F, gl::Target::Depth::kNone, 0),
        light(w * scale, h * scale, GL_RGBA16F,
              multisamples > 1 ? gl::Target::Depth::kNone : gl::Target::Depth::kBuffer, 0),
        finished(w, h, GL_RGBA8, gl::Target::Depth::kNone, 0) {
    if (multisamples > 1)
      multisampled.emplace(w * scale, h * scale, GL_RGBA16F, gl::Target::Depth::kBuffer, multisamples);
  }
  const gl::Target& surface() const { return multisampled ? *multisampled : light; }
  static int half(int n) { return (n + 1) / 2; }
};

}  // namespace

struct Rasterizer::Impl {
  struct Programs {
    gl::Program shadow{"shadow", shaders::body_vertex(), shaders::depth_fragment()};
    gl::Program body_geometry{"body geometry", shaders::body_vertex(), shaders::geometry_fragment()};
    gl::Program ground_geometry{"ground geometry", shaders::ground_vertex(), shaders::geometry_fragment()};
    gl::Program occlusion{"occlusion", shaders::screen_vertex(), shaders::occlusion_fragment()};
    gl::Program blur{"blur", shaders::screen_vertex(), shaders::blur_fragment()};
    gl::Program sky{"sky", shaders::screen_vertex(), shaders::sky_fragment()};
    gl::Program body{"body", shaders::body_vertex(), shaders::surface_fragment()};
    gl::Program ground{"ground", shaders::ground_vertex(), shaders::surface_fragment()};
    gl::Program edges{"edges", shaders::body_vertex(), shaders::edge_fragment()};
    gl::Program finish{"finish", shaders::screen_vertex(), shaders::finish_fragment()};
  };

  Context context;
  std::optional<Programs> programs;
  std::optional<gl::Target> shadow_map;
  std::optional<Targets> targets;
  DrawCache cache;
  GLuint empty_array = 0;  // core profile wants one bound even without attributes
  int most_samples = 1;

  // One picture's state.
  const View* view = nullptr;
  FieldScale scale;
  Camera camera;
  Sun sun;
  std::vector<Placed> bodies;

  Impl() {
    const Current current(context);
    programs.emplace();
    shadow_map.emplace(kShadowTexels, kShadowTexels, 0, gl::Target::Depth::kTexture, 0);
    glGenVertexArrays(1, &empty_array);
    glGetIntegerv(GL_MAX_SAMPLES, &most_samples);
    glBindSampler(kShadowDepthUnit, make_sampler(false));
    glBindSampler(kShadowCompareUnit, make_sampler(true));
    gl::check("set-up");
  }
  ~Impl() {
    const Current current(context);
    cache.clear();
    targets.reset();
    shadow_map.reset();
    programs.reset();
  }

  void prepare(const Frame& frame, const View& v);
  void prepare_targets();
  void draw_body(const gl::Program& program, const Placed& body, bool original, bool crack) const;
  void draw_ground(const gl::Program& program) const;
  void draw_screen() const;
  void pass_shadow() const;
  void pass_occlusion() const;
  void set_surface(const gl::Program& program) const;
  void pass_surface() const;
  void pass_translucent() const;
  void pass_edges() const;
  Image pass_finish() const;
};

void Rasterizer::Impl::prepare(const Frame& frame, const View& v) {
  view = &v;
  scale = frame.scale.value_or(FieldScale{});
  camera = make_camera(v);
  const std::vector<const DrawBuffer*> buffers = cache.update(frame);
  bodies.clear();
  std::vector<std::array<Vec3, 8>> casters;
  for (std::size_t i = 0; i < frame.bodies.size(); ++i) {
    if (frame.bodies[i].mesh->triangle_count() == 0) continue;
    bodies.push_back(place(frame.bodies[i], *buffers[i], v.target));
    casters.push_back(bodies.back().corners);
  }
  sun = make_sun(v.light, casters.data(), casters.size(), kShadowReach * camera.distance, kShadowTexels);
  prepare_targets();
}

void Rasterizer::Impl::prepare_targets() {
  const int wanted = view->samples;
  if (targets && targets->width == view->width && targets->height == view->height && targets->samples == wanted) return;
  targets.reset();
  // More samples than the driver has: the rest comes from drawing at twice the size, which gives four times as many.
  const bool multisampling = wanted <= most_samples;
  const int factor = wanted > 1 && !multisampling ? 2 : 1;
  const int multisamples = multisampling ? wanted : std::min(most_samples, std::max(wanted / 4, 1));
  targets.emplace(view->width, view->height, wanted, multisamples, factor);
}

void Rasterizer::Impl::draw_body(const gl::Program& program, const Placed& body, bool original, bool crack) const {
  program.set("u_rotation", body.body->rotation);
  program.set("u_translation", body.translation);
  const SurfaceField* field = body.body->field.get();
  program.set("u_range", scale.low, scale.high);
  if (original) {
    program.set("u_colour", to_vec(body.body->colour));
    program.set("u_field", field != nullptr);
    body.buffer->draw_original();
  }
  if (crack) {
    program.set("u_colour", to_vec(body.body->crack_colour));
    program.set("u_field", field && field->on_cracks);
    program.set("u_opacity", 1.0);
    body.buffer->draw_crack();
  }
}

void Rasterizer::Impl::draw_ground(const gl::Program& program) const {
  program.set("u_ground_height", view->ground_height - view->target.y);
  program.set("u_ground_radius", 1.05 * kGroundReach * camera.distance);
  program.set("u_ground_sectors", kGroundSectors);
  glBindVertexArray(empty_array);
  glEnable(GL_CULL_FACE);  // seen from below, the ground does not hide the bodies
  glDrawArrays(GL_TRIANGLES, 0, 3 * kGroundSectors);
  glDisable(GL_CULL_FACE);
}

void Rasterizer::Impl::draw_screen() const {
  glBindVertexArray(empty_array);
  glDisable(GL_DEPTH_TEST);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
}

void Rasterizer::Impl::pass_shadow() const {
  shadow_map->bind();
  glClear(GL_DEPTH_BUFFER_BIT);
  glEnable(GL_DEPTH_CLAMP);  // a caster outside the map's depth still casts
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.1f, 1.0f);
  const gl::Program& program = programs->shadow;
  program.use();
  program.set("u_view_projection", sun.clip);
  for (const Placed& body : bodies) draw_body(program, body, !body.translucent(), true);
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_DEPTH_CLAMP);
}

void Rasterizer::Impl::pass_occlusion() const {
  const Real aspect = static_cast<Real>(view->width) / view->height;
  targets->geometry.bind();
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  for (const gl::Program* program : {&programs->body_geometry, &programs->ground_geometry}) {
    program->use();
    program->set("u_view_projection", camera.view_projection);
    program->set("u_eye", camera.eye);
    program->set("u_view_axes", camera.axes);
  }
  programs->body_geometry.use();
  for (const Placed& body : bodies) draw_body(programs->body_geometry, body, !body.translucent(), true);
  programs->ground_geometry.use();
  if (view->ground) draw_ground(programs->ground_geometry);

  targets->occlusion.bind();
  programs->occlusion.use();
  programs->occlusion.set("u_geometry", kInputUnit);
  programs->occlusion.set("u_tangent", aspect * camera.tan_half, camera.tan_half);
  programs->occlusion.set("u_radius", kOcclusionRadius * 2 * camera.tan_half * camera.distance);
  gl::bind_texture(kInputUnit, targets->geometry.colour());
  draw_screen();

  targets->blurred.bind();
  programs->blur.use();
  programs->blur.set("u_occlusion", kInputUnit);
  gl::bind_texture(kInputUnit, targets->occlusion.colour());
  draw_screen();
}

void Rasterizer::Impl::set_surface(const gl::Program& program) const {
  program.use();
  program.set("u_view_projection", camera.view_projection);
  program.set("u_eye", camera.eye);
  program.set("u_view_axes", camera.axes);
  program.set("u_sun", sun.direction);
  program.set("u_sun_clip", sun.clip);
  program.set("u_sun_axes", sun.axes);
  program.set("u_sun_width", sun.width);
  program.set("u_sun_depth", sun.depth);
  program.set("u_sun_tangent", kSunTangent);
  program.set("u_shadow_texel", 1.0 / kShadowTexels);
  program.set("u_sky", to_vec(view->sky_colour));
  program.set("u_bounce", view->ground ? to_vec(view->ground_colour) : 0.5 * to_vec(view->sky_colour));
  program.set("u_opacity", 1.0);
  program.set("u_shadow_depth", kShadowDepthUnit);
  program.set("u_shadow", kShadowCompareUnit);
  program.set("u_occlusion", kOcclusionUnit);
  program.set("u_size", targets->surface().width(), targets->surface().height());
}

void Rasterizer::Impl::pass_surface() const {
  gl::bind_texture(kShadowDepthUnit, shadow_map->depth());
  gl::bind_texture(kShadowCompareUnit, shadow_map->depth());
  gl::bind_texture(kOcclusionUnit, targets->blurred.colour());
  targets->surface().bind();
  glClear(GL_DEPTH_BUFFER_BIT);
  programs->sky.use();
  programs->sky.set("u_sky", to_vec(view->sky_colour));
  programs->sky.set("u_view_axes", camera.axes);
  programs->sky.set("u_tangent", camera.tan_half * view->width / view->height, camera.tan_half);
  draw_screen();

  set_surface(programs->body);
  programs->body.set("u_gloss", 1.0);
  programs->body.set("u_fade", 0.0);
  for (const Placed& body : bodies) draw_body(programs->body, body, !body.translucent(), true);
  if (view->ground) {
    set_surface(programs->ground);
    programs->ground.set("u_colour", to_vec(view->ground_colour));
    programs->ground.set("u_gloss", 0.0);
    programs->ground.set("u_fade", kGroundReach * camera.distance);
    draw_ground(programs->ground);
  }
}

// Far bodies first, and of each the far side first. Exact for convex bodies that do not reach into each other.
void Rasterizer::Impl::pass_translucent() const {
  std::vector<const Placed*> order;
  for (const Placed& body : bodies)
    if (body.translucent()) order.push_back(&body);
  if (order.empty()) return;
  std::stable_sort(order.begin(), order.end(), [&](const Placed* a, const Placed* b) {
    return distance2(a->centre(), camera.eye) > distance2(b->centre(), camera.eye);
  });
  programs->body.use();
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  glEnable(GL_CULL_FACE);
  for (const Placed* body : order) {
    programs->body.set("u_opacity", static_cast<Real>(body->body->opacity));
    for (const GLenum side : {GL_FRONT, GL_BACK}) {
      glCullFace(side);
      draw_body(programs->body, *body, true, false);
    }
  }
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

// Triangles once more as lines, a little nearer to the eye than their faces.
void Rasterizer::Impl::pass_edges() const {
  const gl::Program& program = programs->edges;
  program.use();
  program.set("u_view_projection", camera.view_projection);
  program.set("u_colour", kEdgeColour);
  glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  glEnable(GL_POLYGON_OFFSET_LINE);
  glPolygonOffset(-1.0f, -2.0f);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  for (const Placed& body : bodies) {
    program.set("u_rotation", body.body->rotation);
    program.set("u_translation", body.translation);
    program.set("u_opacity", body.translucent() ? kFaintEdge : kEdge);
    body.buffer->draw_original();
    program.set("u_opacity", kEdge);
    body.buffer->draw_crack();
  }
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glDisable(GL_POLYGON_OFFSET_LINE);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

Image Rasterizer::Impl::pass_finish() const {
  if (targets->multisampled) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, targets->multisampled->framebuffer());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, targets->light.framebuffer());
    const GLint w = targets->light.width(), h = targets->light.height();
    glBlitFramebuffer(0, 0, w, h, 0, 0, w, h, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  }
  targets->finished.bind();
  programs->finish.use();
  programs->finish.set("u_light", kInputUnit);
  programs->finish.set("u_factor", targets->factor);
  gl::bind_texture(kInputUnit, targets->light.colour());
  draw_screen();

  const auto width = static_cast<std::size_t>(view->width), height = static_cast<std::size_t>(view->height);
  Image image{view->width, view->height, std::vector<std::uint8_t>(3 * width * height)};
  std::vector<std::uint8_t> rows(image.rgb.size());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, view->width, view->height, GL_RGB, GL_UNSIGNED_BYTE, rows.data());
  for (std::size_t y = 0; y < height; ++y)  // OpenGL's first row is the bottom
    std::copy_n(rows.data() + 3 * width * (height - 1 - y), 3 * width, image.rgb.data() + 3 * width * y);
  gl::check("render");
  return image;
}

Rasterizer::Rasterizer() : impl_(std::make_unique<Impl>()) {}
Rasterizer::~Rasterizer() = default;

void Rasterizer::forget_meshes() {
  const Current current(impl_->context);
  impl_->cache.clear();
}

Image Rasterizer::render(const Frame& frame, const View& view) {
  check_view(view);
  for (const FrameBody& body : frame.bodies) check_body(frame, body);
  Impl& r = *impl_;
  const Current current(r.context);
  r.prepare(frame, view);
  glEnable(GL_DEPTH_TEST);
  r.pass_shadow();
  r.pass_occlusion();
  r.pass_surface();
  r.pass_translucent();
  if (view.wireframe) r.pass_edges();
  Image image = r.pass_finish();
  if (frame.scale) draw_legend(*frame.scale, image);
  return image;
}

}  // namespace sherd
