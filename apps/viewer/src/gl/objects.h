#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <initializer_list>
#include <string>

namespace isolux::viewer {

/// A linked program of vertex and fragment shaders; one of each stage has main(). Like all here: made, used and
/// destroyed with the same context current.
class ShaderProgram {
 public:
  using Sources = std::initializer_list<std::string>;

  /// `captured` is the output of the vertex shaders that goes to a buffer (transform feedback), if any.
  /// \throw GlError with the first line of the driver's log
  ShaderProgram(Sources vertex_sources, Sources fragment_sources, const char* captured = nullptr);
  ShaderProgram(const ShaderProgram&) = delete;
  ShaderProgram& operator=(const ShaderProgram&) = delete;
  ~ShaderProgram() { glDeleteProgram(name_); }

  void use() const { glUseProgram(name_); }
  [[nodiscard]] GLint uniform(const char* uniform_name) const { return glGetUniformLocation(name_, uniform_name); }

 private:
  GLuint name_;
};

/// A vertex array object.
class VertexArray {
 public:
  VertexArray() { glGenVertexArrays(1, &name_); }
  VertexArray(const VertexArray&) = delete;
  VertexArray& operator=(const VertexArray&) = delete;
  ~VertexArray() { glDeleteVertexArrays(1, &name_); }

  void bind() const { glBindVertexArray(name_); }

 private:
  GLuint name_ = 0;
};

/// A buffer object. It grows by need and is kept when less is filled in.
class Buffer {
 public:
  explicit Buffer(GLenum target) : target_(target) { glGenBuffers(1, &name_); }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
  ~Buffer() { glDeleteBuffers(1, &name_); }

  void bind() const { glBindBuffer(target_, name_); }
  /// Binds it and makes room, the content left open. \throw GlError if OpenGL has no memory for it
  void reserve(std::size_t bytes);
  /// Binds it and replaces its content. \throw as reserve()
  void fill(const void* data, std::size_t bytes);
  [[nodiscard]] GLuint name() const { return name_; }

 private:
  GLenum target_;
  GLuint name_ = 0;
  std::size_t capacity_ = 0;
};

}  // namespace isolux::viewer
