#include "render/gl.h"

#include <algorithm>
#include <vector>

#include "kernels/core/error.h"

namespace sherd::gl {
namespace {

GLuint compile(const char* name, GLenum stage, const std::string& text) {
  const GLuint shader = glCreateShader(stage);
  const char* source = text.c_str();
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint ok = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  std::array<char, 2048> log{};
  if (!ok) glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  SHERD_CHECK(ok, "shader {}: {}", name, log.data());
  return shader;
}

GLuint make_texture(int width, int height, GLenum format) {
  const bool depth = format == GL_DEPTH_COMPONENT32F;
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format), width, height, 0, depth ? GL_DEPTH_COMPONENT : GL_RGBA,
               GL_FLOAT, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

GLuint make_renderbuffer(int width, int height, GLenum format, int samples) {
  GLuint buffer = 0;
  glGenRenderbuffers(1, &buffer);
  glBindRenderbuffer(GL_RENDERBUFFER, buffer);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
  return buffer;
}

}  // namespace

Program::Program(const char* name, const std::string& vertex, const std::string& fragment) {
  const GLuint stages[2] = {compile(name, GL_VERTEX_SHADER, vertex), compile(name, GL_FRAGMENT_SHADER, fragment)};
  id_ = glCreateProgram();
  for (const GLuint stage : stages) glAttachShader(id_, stage);
  glLinkProgram(id_);
  for (const GLuint stage : stages) glDeleteShader(stage);
  GLint ok = 0, count = 0;
  glGetProgramiv(id_, GL_LINK_STATUS, &ok);
  std::array<char, 2048> text{};
  if (!ok) glGetProgramInfoLog(id_, static_cast<GLsizei>(text.size()), nullptr, text.data());
  SHERD_CHECK(ok, "program {}: {}", name, text.data());
  glGetProgramiv(id_, GL_ACTIVE_UNIFORMS, &count);
  for (GLint i = 0; i < count; ++i) {
    GLint size = 0;
    GLenum type = 0;
    glGetActiveUniform(id_, static_cast<GLuint>(i), static_cast<GLsizei>(text.size()), nullptr, &size, &type,
                       text.data());
    locations_[text.data()] = glGetUniformLocation(id_, text.data());
  }
}

Program::~Program() {
  glDeleteProgram(id_);
}

GLint Program::location(const char* uniform) const {
  const auto found = locations_.find(uniform);
  return found == locations_.end() ? -1 : found->second;  // OpenGL ignores -1
}

void Program::set(const char* uniform, const Mat3& m) const {
  std::array<float, 9> rows{};
  for (int i = 0; i < 9; ++i) rows[static_cast<std::size_t>(i)] = static_cast<float>(m[i / 3][i % 3]);
  glUniformMatrix3fv(location(uniform), 1, GL_TRUE, rows.data());
}

Target::Target(int width, int height, GLenum colour_format, Depth depth, int samples) : width_(width), height_(height) {
  glGenFramebuffers(1, &framebuffer_);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  if (colour_format == 0) {
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
  } else if (samples == 0) {
    colour_is_texture_ = true;
    colour_ = make_texture(width, height, colour_format);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_, 0);
  } else {
    colour_ = make_renderbuffer(width, height, colour_format, samples);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_);
  }
  if (depth == Depth::kTexture) {
    depth_is_texture_ = true;
    depth_ = make_texture(width, height, GL_DEPTH_COMPONENT32F);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_, 0);
  } else if (depth == Depth::kBuffer) {
    depth_ = make_renderbuffer(width, height, GL_DEPTH_COMPONENT32F, samples);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
  }
  SHERD_CHECK(glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE,
              "no {}x{} render target with {} samples", width, height, samples);
}

Target::~Target() {
  const auto drop = [](bool texture, GLuint& name) {
    if (name != 0) texture ? glDeleteTextures(1, &name) : glDeleteRenderbuffers(1, &name);
  };
  drop(colour_is_texture_, colour_);
  drop(depth_is_texture_, depth_);
  glDeleteFramebuffers(1, &framebuffer_);
}

void Target::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, width_, height_);
}

void bind_texture(int unit, GLuint texture) {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, texture);
}

void check(const char* where) {
  const GLenum error = glGetError();
  SHERD_CHECK(error == GL_NO_ERROR, "OpenGL error {:#x} in {}", error, where);
}

}  // namespace sherd::gl
