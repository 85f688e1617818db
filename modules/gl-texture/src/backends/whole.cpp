#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/gl_texture/texture_uploader.h>

#include "texel_upload.h"

namespace isolux {
namespace {

void require_valid(const IlluminationGrid& light) {
  const Index3 n = light.lattice.size;
  const bool shaped = light.values.size() == light.lattice.count() * std::size_t(light.channels);
  if ((light.channels != 1 && light.channels != 3) || !shaped) {
    throw InvalidInput(fmt::format("light of {}x{}x{} texels, {} channels and {} values: it needs 1 or 3 channels", n.x,
                                   n.y, n.z, light.channels, light.values.size()));
  }
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
    return upload_texels(light.lattice.size, light.channels, light.values, options_.format,
                         texture_mapping(light.lattice, volume));
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
