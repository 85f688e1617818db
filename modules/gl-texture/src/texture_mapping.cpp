#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/gl_texture/texture_mapping.h>

#include <cmath>

namespace isolux {

TextureMapping texture_mapping(const Lattice& texels, const Lattice& volume) {
  const IndexToWorld to_texel = index_to_index(volume, texels);
  TextureMapping result;
  for (int a = 0; a < 3; ++a) {
    if (volume.size[a] < 2 || texels.size[a] < 1) {
      throw InvalidInput(
          fmt::format("light of {}x{}x{} texels on a volume of {}x{}x{} grid points: a texture needs at least 1 texel "
                      "and 2 grid points on each axis",
                      texels.size.x, texels.size.y, texels.size.z, volume.size.x, volume.size.y, volume.size.z));
    }
    for (int b = 0; b < 3; ++b) {
      const double drift = std::fabs(to_texel.axes[b][a]) * (volume.size[b] - 1);
      if (a == b ? !(drift > 0.0) : !(drift <= 1e-3)) {
        throw InvalidInput("light whose axes are not parallel to the volume's: only light over the same box is drawn");
      }
    }
    const double texel_count = texels.size[a];
    result.scale[a] = to_texel.axes[a][a] * (volume.size[a] - 1) / texel_count;
    result.offset[a] = (to_texel.origin[a] + 0.5) / texel_count;
  }
  return result;
}

}  // namespace isolux
