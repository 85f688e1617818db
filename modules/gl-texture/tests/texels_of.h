#pragma once

#include <epoxy/gl.h>
#include <isolux/gl_texture/texture3d.h>

#include <vector>

namespace isolux::test {

/// All texels of a texture, channel fastest, gain applied.
inline std::vector<float> texels_of(const Texture3D& texture) {
  const Index3 n = texture.size();
  std::vector<float> texels(std::size_t(n.x) * std::size_t(n.y) * std::size_t(n.z) * std::size_t(texture.channels()));
  glBindTexture(GL_TEXTURE_3D, texture.name());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTexImage(GL_TEXTURE_3D, 0, texture.channels() == 3 ? GL_RGB : GL_RED, GL_FLOAT, texels.data());
  for (float& texel : texels) texel = float(double(texel) * texture.gain());
  return texels;
}

}  // namespace isolux::test
