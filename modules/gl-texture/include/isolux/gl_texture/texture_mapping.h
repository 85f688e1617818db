#pragma once

#include <isolux/core/lattice.h>

namespace isolux {

/// Texture coordinate = scale * place + offset on each axis, where place is 0 at the volume's first grid point and 1 at
/// its last, and texel i of N has its centre at texture coordinate (i + 0.5)/N.
struct TextureMapping {
  Vec3 scale{1.0};
  Vec3 offset{0.0};
};

/// The mapping from the box of `volume` to a texture whose texel centres are `texels`, for any number of texels and any
/// position along the axes: the identity for texels at cell centres, the half-texel correction for texels at the
/// voxels. \throw InvalidInput if an axis of the texels is not parallel to the volume's same axis (beyond 1e-3 texel
/// over the box: file headers round), or if the volume has fewer than two grid points on an axis.
[[nodiscard]] TextureMapping texture_mapping(const Lattice& texels, const Lattice& volume);

}  // namespace isolux
