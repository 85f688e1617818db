#include "texel_upload.h"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "unpack_state.h"

namespace isolux {
namespace {

/// What GL calls a texel.
struct GlTexel {
  GLint internal_format;
  GLenum channels;
  GLenum type;
  GLint filter;
  std::size_t bytes;
};

GlTexel gl_texel(TexelFormat format, int channels) {
  const bool rgb = channels == 3;
  const auto texel = [&](GLint one, GLint three, std::size_t bytes) {
    return GlTexel{rgb ? three : one, GLenum(rgb ? GL_RGB : GL_RED), GL_FLOAT, GL_LINEAR, rgb ? 3 * bytes : bytes};
  };
  switch (format) {
    case TexelFormat::kUnorm8:
      return texel(GL_R8, GL_RGB8, 1);
    case TexelFormat::kFloat16:
      return texel(GL_R16F, GL_RGB16F, 2);
    case TexelFormat::kFloat32:
      break;
  }
  return texel(GL_R32F, GL_RGB32F, 4);
}

/// What texels are divided by before they are stored, so that the format has all its steps for them however bright or
/// dim they are. For floats a power of two: what 16 bits hold exactly stays exact.
double gain_of(std::span<const float> values, TexelFormat format) {
  constexpr double kLargestFloat16 = 65504.0;
  double brightest = 0.0;
  for (const float e : values) brightest = std::max(brightest, std::fabs(double(e)));
  if (brightest == 0.0 || format == TexelFormat::kFloat32) return 1.0;
  if (format == TexelFormat::kUnorm8) return brightest;
  // Shaders multiply by it, and do not keep floats that have fewer bits.
  return std::max(std::exp2(std::ceil(std::log2(brightest / kLargestFloat16))), 0x1p-126);
}

/// Binds a new 3D texture and puts the old binding back at the end; the texture goes too unless it was released.
class NewTexture {
 public:
  NewTexture() {
    glGetIntegerv(GL_TEXTURE_BINDING_3D, &previous_);
    glGenTextures(1, &name_);
    glBindTexture(GL_TEXTURE_3D, name_);
  }
  NewTexture(const NewTexture&) = delete;
  NewTexture& operator=(const NewTexture&) = delete;
  ~NewTexture() {
    glBindTexture(GL_TEXTURE_3D, GLuint(previous_));
    if (name_ != 0) glDeleteTextures(1, &name_);
  }
  [[nodiscard]] GLuint release() { return std::exchange(name_, 0); }

 private:
  GLuint name_ = 0;
  GLint previous_ = 0;
};

/// Both what GL promises for any format and what it says of this one.
void require_accepted(Index3 n, const GlTexel& texel) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &limit);
  if (std::max({n.x, n.y, n.z}) > limit) {
    throw InvalidInput(
        fmt::format("light of {}x{}x{} texels: this OpenGL driver allows at most {} on an axis; bake "
                    "with fewer texels",
                    n.x, n.y, n.z, limit));
  }
  glTexImage3D(GL_PROXY_TEXTURE_3D, 0, texel.internal_format, n.x, n.y, n.z, 0, texel.channels, texel.type, nullptr);
  GLint width = 0;
  glGetTexLevelParameteriv(GL_PROXY_TEXTURE_3D, 0, GL_TEXTURE_WIDTH, &width);
  if (width != n.x) {
    throw GlError(
        fmt::format("light of {}x{}x{} texels: OpenGL says that it cannot hold a 3D texture of this size and "
                    "format; bake with fewer texels or choose a smaller format",
                    n.x, n.y, n.z));
  }
}

GLuint upload(Index3 n, const GlTexel& texel, const void* values) {
  while (glGetError() != GL_NO_ERROR) {
    // An error that somebody else left behind is not the upload's.
  }
  require_accepted(n, texel);
  NewTexture texture;
  for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    glTexParameteri(GL_TEXTURE_3D, axis, GL_CLAMP_TO_EDGE);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTexParameteri(GL_TEXTURE_3D, filter, texel.filter);
  glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAX_LEVEL, 0);
  if (texel.channels == GL_RED) {
    for (const GLenum channel : {GL_TEXTURE_SWIZZLE_G, GL_TEXTURE_SWIZZLE_B})
      glTexParameteri(GL_TEXTURE_3D, channel, GL_RED);
  }
  const UnpackState tightly_packed;
  glTexImage3D(GL_TEXTURE_3D, 0, texel.internal_format, n.x, n.y, n.z, 0, texel.channels, texel.type, values);
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return texture.release();
  throw GlError(fmt::format("light of {}x{}x{} texels: OpenGL refused the 3D texture ({})", n.x, n.y, n.z,
                            error == GL_OUT_OF_MEMORY ? "out of memory" : fmt::format("error 0x{:04x}", error)));
}

std::size_t texels(Index3 n) { return std::size_t(n.x) * std::size_t(n.y) * std::size_t(n.z); }

}  // namespace

Texture3D upload_texels(Index3 size, int channels, std::span<const float> values, TexelFormat format,
                        const TextureMapping& mapping) {
  const double gain = gain_of(values, format);
  std::vector<float> scaled;
  if (gain != 1.0) {
    scaled.resize(values.size());
    std::transform(values.begin(), values.end(), scaled.begin(), [gain](float e) { return float(double(e) / gain); });
    values = scaled;
  }
  const GlTexel texel = gl_texel(format, channels);
  const GLuint name = upload(size, texel, values.data());
  return Texture3D(name, size, channels, mapping, gain, texels(size) * texel.bytes);
}

Texture3D upload_packed(Index3 size, std::span<const std::uint32_t> values) {
  const GlTexel texel{GL_RGB10_A2, GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV, GL_NEAREST, 4};
  const GLuint name = upload(size, texel, values.data());
  return Texture3D(name, size, 4, {}, 1.0, texels(size) * texel.bytes);
}

}  // namespace isolux
