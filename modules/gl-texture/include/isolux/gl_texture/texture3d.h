#pragma once

#include <isolux/core/vec.h>
#include <isolux/gl_texture/texture_mapping.h>

#include <cstddef>

namespace isolux {

/// An OpenGL 3D texture, clamped to its edge. Owns the name; moves, does not copy. Made, used and destroyed
/// with the same context current.
class Texture3D {
 public:
  Texture3D() = default;
  /// Takes over the texture called `name`.
  Texture3D(unsigned int name, Index3 size, int channels, const TextureMapping& mapping, double gain = 1.0,
            std::size_t bytes = 0);
  Texture3D(Texture3D&& other) noexcept;
  Texture3D& operator=(Texture3D&& other) noexcept;
  Texture3D(const Texture3D&) = delete;
  Texture3D& operator=(const Texture3D&) = delete;
  ~Texture3D();

  /// 0 for none.
  [[nodiscard]] unsigned int name() const { return name_; }
  [[nodiscard]] Index3 size() const { return size_; }
  /// 1 or 3, of which a shader reads red, green and blue, grey three times; 4 of a page table.
  [[nodiscard]] int channels() const { return channels_; }
  /// Texture coordinate = scale * place + offset, see TextureMapping.
  [[nodiscard]] Vec3 scale() const { return mapping_.scale; }
  [[nodiscard]] Vec3 offset() const { return mapping_.offset; }
  /// e = gain * what the shader reads: texels are stored so that the format has its steps for light of any brightness.
  [[nodiscard]] double gain() const { return gain_; }
  /// What its texels take, drivers' padding aside.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  unsigned int name_ = 0;
  Index3 size_{0};
  int channels_ = 0;
  TextureMapping mapping_;
  double gain_ = 1.0;
  std::size_t bytes_ = 0;
};

}  // namespace isolux
