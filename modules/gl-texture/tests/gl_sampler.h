#pragma once

#include <epoxy/gl.h>
#include <isolux/gl_texture.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace isolux::test {

/// What a fragment shader reads from `texture` at places in the volume's box (0 to 1), gain applied.
class GlSampler {
 public:
  GlSampler() : program_(link()) {
    glGenVertexArrays(1, &vertex_array_);
    glGenFramebuffers(1, &framebuffer_);
    glGenTextures(2, textures_);
  }
  GlSampler(const GlSampler&) = delete;
  GlSampler& operator=(const GlSampler&) = delete;
  ~GlSampler() {
    glDeleteTextures(2, textures_);
    glDeleteFramebuffers(1, &framebuffer_);
    glDeleteVertexArrays(1, &vertex_array_);
    glDeleteProgram(program_);
  }

  [[nodiscard]] std::vector<Vec3f> read(const Texture3D& texture, const std::vector<Vec3f>& places) const {
    const auto count = GLsizei(places.size());
    float_image(textures_[0], GL_RGB32F, GL_RGB, count, places.data());
    float_image(textures_[1], GL_RGBA32F, GL_RGBA, count, nullptr);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, textures_[1], 0);
    glViewport(0, 0, count, 1);
    glUseProgram(program_);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D, textures_[0]);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_3D, texture.name());
    glUniform1i(glGetUniformLocation(program_, "light"), 0);
    glUniform1i(glGetUniformLocation(program_, "places"), 1);
    const Vec3f scale(texture.scale());
    const Vec3f offset(texture.offset());
    glUniform3fv(glGetUniformLocation(program_, "scale"), 1, &scale.x);
    glUniform3fv(glGetUniformLocation(program_, "offset"), 1, &offset.x);
    glUniform1f(glGetUniformLocation(program_, "gain"), float(texture.gain()));
    glBindVertexArray(vertex_array_);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    std::vector<Vec3f> result(places.size());
    glReadPixels(0, 0, count, 1, GL_RGB, GL_FLOAT, result.data());
    if (glGetError() != GL_NO_ERROR) throw std::runtime_error("sampling failed");
    return result;
  }

 private:
  static void float_image(GLuint name, GLint format, GLenum channels, GLsizei width, const void* pixels) {
    glBindTexture(GL_TEXTURE_2D, name);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, format, width, 1, 0, channels, GL_FLOAT, pixels);
  }

  static GLuint link() {
    const GLuint program = glCreateProgram();
    const char* vertex =
        "#version 330 core\n"
        "void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }\n";
    const char* fragment =
        "#version 330 core\n"
        "uniform sampler3D light; uniform sampler2D places; uniform vec3 scale, offset; uniform float gain;\n"
        "out vec4 colour;\n"
        "void main() {\n"
        "  vec3 place = texelFetch(places, ivec2(gl_FragCoord.x, 0), 0).xyz;\n"
        "  colour = vec4(gain * texture(light, scale * place + offset).rgb, 1.0);\n"
        "}\n";
    for (const auto& [kind, text] : {std::pair{GL_VERTEX_SHADER, vertex}, std::pair{GL_FRAGMENT_SHADER, fragment}}) {
      const GLuint shader = glCreateShader(GLenum(kind));
      glShaderSource(shader, 1, &text, nullptr);
      glCompileShader(shader);
      glAttachShader(program, shader);
      glDeleteShader(shader);
    }
    glLinkProgram(program);
    GLint linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked == 0) throw std::runtime_error("the sampling shader does not link");
    return program;
  }

  GLuint program_;
  GLuint vertex_array_ = 0;
  GLuint framebuffer_ = 0;
  GLuint textures_[2]{};
};

}  // namespace isolux::test
