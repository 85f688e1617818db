#pragma once

#include <isolux/core/lattice.h>
#include <isolux/core/vec.h>

#include <cstddef>
#include <glm/common.hpp>

#include "grid_index.h"

namespace isolux {

/// Where sites at texels sit, to the bit: in the volume's index space, within its box.
class TexelPositions {
 public:
  TexelPositions(const Lattice& volume, const Lattice& texels)
      : size_(texels.size), to_volume_(index_to_index(texels, volume)), last_(volume.size - 1) {}

  [[nodiscard]] Vec3f of(std::size_t texel) const {
    return glm::clamp(Vec3f(to_volume_.world(Vec3(index_of(size_, texel)))), Vec3f(0.0f), last_);
  }

 private:
  Index3 size_;
  IndexToWorld to_volume_;
  Vec3f last_;
};

}  // namespace isolux
