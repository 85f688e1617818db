#include "gl/picture.h"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace isolux::viewer {
namespace {

/// Pixels each way: bounds the memory that samples take.
constexpr int kTile = 2048;

/// The inverse of the sRGB curve (IEC 61966-2-1).
float linear(int code) {
  const double v = code / 255.0;
  return float(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
}

/// A framebuffer of 8-bit colours and, where it is drawn into, depth.
class Framebuffer {
 public:
  Framebuffer(int width, int height, int samples) {
    glGenFramebuffers(1, &name_);
    glGenRenderbuffers(2, buffers_.data());
    glBindFramebuffer(GL_FRAMEBUFFER, name_);
    attach(0, GL_RGBA8, GL_COLOR_ATTACHMENT0, width, height, samples);
    if (samples > 0) attach(1, GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT, width, height, samples);
  }
  Framebuffer(const Framebuffer&) = delete;
  Framebuffer& operator=(const Framebuffer&) = delete;
  ~Framebuffer() {
    glDeleteRenderbuffers(2, buffers_.data());
    glDeleteFramebuffers(1, &name_);
  }

  [[nodiscard]] bool complete() const { return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE; }
  void bind(GLenum target) const { glBindFramebuffer(target, name_); }

 private:
  void attach(std::size_t i, GLenum format, GLenum place, int width, int height, int samples) {
    glBindRenderbuffer(GL_RENDERBUFFER, buffers_[i]);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, buffers_[i]);
  }

  GLuint name_ = 0;
  std::array<GLuint, 2> buffers_{};
};

/// Binds again what is bound now.
class BoundFramebuffers {
 public:
  BoundFramebuffers() {
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &draw_);
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &read_);
  }
  BoundFramebuffers(const BoundFramebuffers&) = delete;
  BoundFramebuffers& operator=(const BoundFramebuffers&) = delete;
  ~BoundFramebuffers() {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, GLuint(draw_));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, GLuint(read_));
  }

 private:
  GLint draw_ = 0;
  GLint read_ = 0;
};

/// Reads the framebuffer's pixels into the picture, from `first` on.
void read_tile(const glm::ivec2& first, const glm::ivec2& size, Image& image) {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values{};
    for (int code = 0; code < 256; ++code) values[std::size_t(code)] = linear(code);
    return values;
  }();
  std::vector<std::array<std::uint8_t, 3>> codes(std::size_t(size.x) * std::size_t(size.y));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, size.x, size.y, GL_RGB, GL_UNSIGNED_BYTE, codes.data());
  for (int y = 0; y < size.y; ++y) {
    const auto* row = codes.data() + std::size_t(y) * std::size_t(size.x);
    // OpenGL's first row is the lowest.
    const int to = image.height - 1 - (first.y + y);
    for (int x = 0; x < size.x; ++x) image.at(first.x + x, to) = {table[row[x][0]], table[row[x][1]], table[row[x][2]]};
  }
}

}  // namespace

Image draw_picture(int width, int height, const std::function<void(const glm::ivec2& first)>& draw) {
  std::array<GLint, 2> most{};
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, most.data());
  if (width > most[0] || height > most[1]) {
    throw GlError(fmt::format("a picture of {}x{} pixels: this OpenGL driver draws at most {}x{}", width, height,
                              most[0], most[1]));
  }
  const BoundFramebuffers before;
  GLint samples = 0;
  glGetIntegerv(GL_MAX_SAMPLES, &samples);
  const glm::ivec2 tile(std::min(width, kTile), std::min(height, kTile));
  const Framebuffer resolved(tile.x, tile.y, 0);
  const Framebuffer sampled(tile.x, tile.y, std::clamp(samples, 1, 4));
  if (!sampled.complete())
    throw GlError(fmt::format("a picture of {}x{} pixels: OpenGL has no framebuffer for it", width, height));
  Image image(width, height);
  for (int y = 0; y < height; y += tile.y) {
    for (int x = 0; x < width; x += tile.x) {
      sampled.bind(GL_FRAMEBUFFER);
      draw({x, y});
      resolved.bind(GL_DRAW_FRAMEBUFFER);
      glBlitFramebuffer(0, 0, tile.x, tile.y, 0, 0, tile.x, tile.y, GL_COLOR_BUFFER_BIT, GL_NEAREST);
      resolved.bind(GL_READ_FRAMEBUFFER);
      read_tile({x, y}, {std::min(tile.x, width - x), std::min(tile.y, height - y)}, image);
    }
  }
  return image;
}

}  // namespace isolux::viewer
