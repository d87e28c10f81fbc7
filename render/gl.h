// OpenGL, as this folder uses it; no other folder includes it.
#pragma once
#define GL_GLEXT_PROTOTYPES
#include <GL/osmesa.h>
//
#include <GL/glext.h>

#include <array>
#include <string>
#include <unordered_map>

#include "kernels/core/vec3.h"
#include "render/camera.h"

namespace sherd::gl {

// A linked vertex and fragment shader with its uniforms by name. A name the compiler removed is ignored.
class Program {
 public:
  Program(const char* name, const std::string& vertex, const std::string& fragment);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void use() const { glUseProgram(id_); }
  // The program must be in use.
  void set(const char* uniform, int value) const { glUniform1i(location(uniform), value); }
  void set(const char* uniform, Real value) const { glUniform1f(location(uniform), static_cast<float>(value)); }
  void set(const char* uniform, Real x, Real y) const {
    glUniform2f(location(uniform), static_cast<float>(x), static_cast<float>(y));
  }
  void set(const char* uniform, const Vec3& v) const {
    glUniform3f(location(uniform), static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
  }
  void set(const char* uniform, const Mat3& m) const;
  void set(const char* uniform, const Matrix4& m) const {
    glUniformMatrix4fv(location(uniform), 1, GL_FALSE, m.data());
  }

 private:
  GLint location(const char* uniform) const;

  GLuint id_ = 0;
  std::unordered_map<std::string, GLint> locations_;  // looked up by key only
};

// A framebuffer with its own colour and depth storage; either may be absent.
class Target {
 public:
  enum class Depth { kNone, kBuffer, kTexture };
  // colour_format 0: no colour. samples 0: textures; above: multisampled renderbuffers.
  Target(int width, int height, GLenum colour_format, Depth depth, int samples);
  ~Target();
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;

  void bind() const;
  GLuint framebuffer() const { return framebuffer_; }
  GLuint colour() const { return colour_; }  // texture, when samples == 0
  GLuint depth() const { return depth_; }    // texture, for Depth::kTexture
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  int width_, height_;
  bool colour_is_texture_ = false, depth_is_texture_ = false;
  GLuint framebuffer_ = 0, colour_ = 0, depth_ = 0;
};

void bind_texture(int unit, GLuint texture);
// Throws InternalError naming `where` when an earlier OpenGL call failed.
void check(const char* where);

}  // namespace sherd::gl
