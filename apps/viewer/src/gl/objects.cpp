#include "gl/objects.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <vector>

namespace isolux::viewer {
namespace {

GLuint compile(GLenum kind, const char* source) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  return shader;
}

std::string first_line(const std::vector<char>& log) {
  const std::string text(log.data());
  return text.substr(0, text.find('\n'));
}

}  // namespace

ShaderProgram::ShaderProgram(Sources vertex_sources, Sources fragment_sources, const char* captured)
    : name_(glCreateProgram()) {
  std::vector<GLuint> shaders;
  for (const std::string& source : vertex_sources) shaders.push_back(compile(GL_VERTEX_SHADER, source.c_str()));
  for (const std::string& source : fragment_sources) shaders.push_back(compile(GL_FRAGMENT_SHADER, source.c_str()));
  for (const GLuint shader : shaders) glAttachShader(name_, shader);
  if (captured != nullptr) glTransformFeedbackVaryings(name_, 1, &captured, GL_INTERLEAVED_ATTRIBS);
  glLinkProgram(name_);
  GLint linked = 0;
  glGetProgramiv(name_, GL_LINK_STATUS, &linked);
  std::vector<char> log(4096, '\0');
  if (linked == 0) {
    for (const GLuint shader : shaders) {
      if (log[0] == '\0') glGetShaderInfoLog(shader, GLsizei(log.size()), nullptr, log.data());
    }
    if (log[0] == '\0') glGetProgramInfoLog(name_, GLsizei(log.size()), nullptr, log.data());
  }
  for (const GLuint shader : shaders) glDeleteShader(shader);
  if (linked != 0) return;
  glDeleteProgram(name_);
  throw GlError(fmt::format("OpenGL does not take a shader: {}", first_line(log)));
}

void Buffer::reserve(std::size_t bytes) {
  bind();
  if (bytes <= capacity_) return;
  while (glGetError() != GL_NO_ERROR) {
    // Errors of others are not this buffer's.
  }
  glBufferData(target_, GLsizeiptr(bytes), nullptr, GL_DYNAMIC_DRAW);
  if (glGetError() != GL_NO_ERROR) {
    capacity_ = 0;
    throw GlError(fmt::format("OpenGL has no room for a buffer of {} bytes", bytes));
  }
  capacity_ = bytes;
}

void Buffer::fill(const void* data, std::size_t bytes) {
  reserve(bytes);
  glBufferSubData(target_, 0, GLsizeiptr(bytes), data);
}

}  // namespace isolux::viewer
