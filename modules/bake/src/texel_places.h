#pragma once

#include <isolux/core/lattice.h>
#include <isolux/core/vec.h>

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "texel_positions.h"

namespace isolux {

/// Which texels sites sit at: a bit a texel in place of the sites' positions, for as long as these are not wanted.
class TexelPlaces {
 public:
  /// None unless the positions (index space of `volume`) are those of texels, to the bit, in the texels' order. Cost:
  /// some nanoseconds a texel.
  [[nodiscard]] static std::optional<TexelPlaces> of(const Lattice& volume, const Lattice& texels,
                                                     std::span<const Vec3f> positions);

  /// Up to `count` positions of the sites at texel `first` and behind it; `first` becomes the texel to go on at.
  [[nodiscard]] std::vector<Vec3f> next(std::size_t& first, std::size_t count) const;

 private:
  TexelPlaces(const Lattice& volume, const Lattice& texels);

  TexelPositions positions_;
  std::vector<bool> has_site_;
};

}  // namespace isolux
