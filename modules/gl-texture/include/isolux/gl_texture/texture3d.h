#pragma once

#include <isolux/core/vec.h>

namespace isolux {

/// An OpenGL 3D texture, linear, clamped to its edge. Owns the name; moves, does not copy. Made, used and destroyed
/// with the same context current.
class Texture3D {
 public:
  Texture3D() = default;
  Texture3D(unsigned int name, Index3 size, int channels, Vec3 scale, Vec3 offset);
  Texture3D(Texture3D&& other) noexcept;
  Texture3D& operator=(Texture3D&& other) noexcept;
  ~Texture3D();

  [[nodiscard]] unsigned int name() const { return name_; }
  [[nodiscard]] Index3 size() const { return size_; }
  [[nodiscard]] int channels() const { return channels_; }
  /// Texture coordinate = scale * place + offset, where place is 0 at the volume's first grid point and 1 at its last.
  /// Identity for texels at cell centres; the half-texel correction for texels at the voxels.
  [[nodiscard]] Vec3 scale() const { return scale_; }
  [[nodiscard]] Vec3 offset() const { return offset_; }

 private:
  unsigned int name_ = 0;
  Index3 size_{0};
  int channels_ = 0;
  Vec3 scale_{1.0};
  Vec3 offset_{0.0};
};

}  // namespace isolux
