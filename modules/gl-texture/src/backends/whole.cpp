#include <epoxy/gl.h>
#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/gl_texture/texture_uploader.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "unpack_state.h"

namespace isolux {
namespace {

/// What GL calls a texel and the largest value that it holds.
struct GlTexel {
  GLint internal_format;
  double largest;
};

GlTexel gl_texel(TexelFormat format, int channels) {
  const bool rgb = channels == 3;
  switch (format) {
    case TexelFormat::kUnorm8:
      return {rgb ? GL_RGB8 : GL_R8, 1.0};
    case TexelFormat::kFloat16:
      return {rgb ? GL_RGB16F : GL_R16F, 65504.0};
    case TexelFormat::kFloat32:
      break;
  }
  return {rgb ? GL_RGB32F : GL_R32F, double(std::numeric_limits<float>::max())};
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

void require_valid(const IlluminationGrid& light) {
  const Index3 n = light.lattice.size;
  const bool shaped = light.values.size() == light.lattice.count() * std::size_t(light.channels);
  if ((light.channels != 1 && light.channels != 3) || !shaped) {
    throw InvalidInput(fmt::format("light of {}x{}x{} texels, {} channels and {} values: it needs 1 or 3 channels", n.x,
                                   n.y, n.z, light.channels, light.values.size()));
  }
}

/// Both what GL promises for any format and what it says of this one.
void require_accepted(Index3 n, GLint internal_format, GLenum channels) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &limit);
  if (std::max({n.x, n.y, n.z}) > limit) {
    throw InvalidInput(
        fmt::format("light of {}x{}x{} texels: this OpenGL driver allows at most {} on an axis; bake "
                    "with fewer texels",
                    n.x, n.y, n.z, limit));
  }
  glTexImage3D(GL_PROXY_TEXTURE_3D, 0, internal_format, n.x, n.y, n.z, 0, channels, GL_FLOAT, nullptr);
  GLint width = 0;
  glGetTexLevelParameteriv(GL_PROXY_TEXTURE_3D, 0, GL_TEXTURE_WIDTH, &width);
  if (width != n.x) {
    throw GlError(
        fmt::format("light of {}x{}x{} texels: OpenGL says that it cannot hold a 3D texture of this size and "
                    "format; bake with fewer texels or choose a smaller format",
                    n.x, n.y, n.z));
  }
}

void fill_bound_texture(const IlluminationGrid& light, const GlTexel& texel, double gain) {
  const Index3 n = light.lattice.size;
  const GLenum channels = light.channels == 3 ? GL_RGB : GL_RED;
  const float* values = light.values.data();
  std::vector<float> scaled;
  if (gain != 1.0) {
    scaled.resize(light.values.size());
    std::transform(light.values.begin(), light.values.end(), scaled.begin(),
                   [gain](float e) { return float(double(e) / gain); });
    values = scaled.data();
  }
  for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    glTexParameteri(GL_TEXTURE_3D, axis, GL_CLAMP_TO_EDGE);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTexParameteri(GL_TEXTURE_3D, filter, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAX_LEVEL, 0);
  if (light.channels == 1) {
    for (const GLenum channel : {GL_TEXTURE_SWIZZLE_G, GL_TEXTURE_SWIZZLE_B})
      glTexParameteri(GL_TEXTURE_3D, channel, GL_RED);
  }
  const UnpackState tightly_packed;
  glTexImage3D(GL_TEXTURE_3D, 0, texel.internal_format, n.x, n.y, n.z, 0, channels, GL_FLOAT, values);
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return;
  throw GlError(fmt::format("light of {}x{}x{} texels: OpenGL refused the 3D texture ({})", n.x, n.y, n.z,
                            error == GL_OUT_OF_MEMORY ? "out of memory" : fmt::format("error 0x{:04x}", error)));
}

/// The whole light in one texture.
class Whole final : public TextureUploader {
 public:
  struct Options {
    TexelFormat format = TexelFormat::kFloat16;

    void describe(OptionVisitor& option) {
      option("format", format,
             {{"unorm8", TexelFormat::kUnorm8}, {"float16", TexelFormat::kFloat16}, {"float32", TexelFormat::kFloat32}},
             {.help = "how a texel is stored: 1, 2 or 4 bytes a channel"});
    }
  };

  explicit Whole(const Options& options) : options_(options) {}

  [[nodiscard]] Texture3D upload(const IlluminationGrid& light, const Lattice& volume) const override {
    require_valid(light);
    const TextureMapping mapping = texture_mapping(light.lattice, volume);
    const GlTexel texel = gl_texel(options_.format, light.channels);
    while (glGetError() != GL_NO_ERROR) {
      // An error that somebody else left behind is not the upload's.
    }
    require_accepted(light.lattice.size, texel.internal_format, light.channels == 3 ? GL_RGB : GL_RED);
    const double brightest = double(*std::max_element(light.values.begin(), light.values.end()));
    const double gain = brightest > texel.largest ? brightest / texel.largest : 1.0;
    NewTexture texture;
    fill_bound_texture(light, texel, gain);
    return Texture3D(texture.release(), light.lattice.size, light.channels, mapping, gain);
  }

 private:
  Options options_;
};

}  // namespace

namespace backends {
void whole(Registry<TextureUploader>& registry) {
  registry.add<Whole>("whole", "the whole light in one texture; refused beyond the driver's largest size");
}
}  // namespace backends

}  // namespace isolux
