#pragma once

#include <isolux/core/volume.h>

namespace isolux {

/// By how much f changes where a texel is read. `volume` outlives it.
class TexelBreadths {
 public:
  TexelBreadths(const Volume& volume, const Lattice& texels);

  /// Half the range of the voxels of the cells that the linear tent of a texel touches, from its centre in the volume's
  /// index space.
  [[nodiscard]] double at(const Vec3& centre) const;

 private:
  const Volume& volume_;
  Vec3 reach_;
};

}  // namespace isolux
