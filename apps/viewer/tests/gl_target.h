// What the renderer's tests draw into.
#pragma once

#include <epoxy/gl.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace isolux::viewer {

inline constexpr int kSize = 200;

/// A framebuffer of 8-bit colours and float depth, to draw into from now on; without samples one that can be read.
class Target {
 public:
  explicit Target(int samples = 0) {
    glGenFramebuffers(1, &framebuffer_);
    glGenRenderbuffers(2, buffers_);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    const std::array<std::pair<GLenum, GLenum>, 2> parts{
        {{GL_RGBA8, GL_COLOR_ATTACHMENT0}, {GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT}}};
    for (std::size_t i = 0; i < 2; ++i) {
      glBindRenderbuffer(GL_RENDERBUFFER, buffers_[i]);
      glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, parts[i].first, kSize, kSize);
      glFramebufferRenderbuffer(GL_FRAMEBUFFER, parts[i].second, GL_RENDERBUFFER, buffers_[i]);
    }
    glViewport(0, 0, kSize, kSize);
    glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  }
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;
  ~Target() {
    glDeleteRenderbuffers(2, buffers_);
    glDeleteFramebuffers(1, &framebuffer_);
  }

  void resolve(const Target& into) const {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, into.framebuffer_);
    glBlitFramebuffer(0, 0, kSize, kSize, 0, 0, kSize, kSize, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, into.framebuffer_);
  }
  void read() {
    glReadPixels(0, 0, kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, colours.data());
    glReadPixels(0, 0, kSize, kSize, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
  }

  std::vector<std::array<std::uint8_t, 4>> colours{std::size_t(kSize) * kSize};
  std::vector<float> depths = std::vector<float>(std::size_t(kSize) * kSize);

 private:
  GLuint framebuffer_ = 0;
  GLuint buffers_[2]{};
};

}  // namespace isolux::viewer
