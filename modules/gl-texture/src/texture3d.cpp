#include <epoxy/gl.h>
#include <isolux/gl_texture/texture3d.h>

#include <utility>

namespace isolux {

Texture3D::Texture3D(unsigned int name, Index3 size, int channels, const TextureMapping& mapping, double gain,
                     std::size_t bytes)
    : name_(name), size_(size), channels_(channels), mapping_(mapping), gain_(gain), bytes_(bytes) {}

Texture3D::Texture3D(Texture3D&& other) noexcept
    : name_(std::exchange(other.name_, 0)),
      size_(other.size_),
      channels_(other.channels_),
      mapping_(other.mapping_),
      gain_(other.gain_),
      bytes_(other.bytes_) {}

Texture3D& Texture3D::operator=(Texture3D&& other) noexcept {
  std::swap(name_, other.name_);
  size_ = other.size_;
  channels_ = other.channels_;
  mapping_ = other.mapping_;
  gain_ = other.gain_;
  bytes_ = other.bytes_;
  return *this;
}

Texture3D::~Texture3D() {
  if (name_ != 0) glDeleteTextures(1, &name_);
}

}  // namespace isolux
