#pragma once

#include <isolux/core/lattice.h>
#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace isolux {

/// Where a site lies between the texel centres around it.
struct CellPlace {
  std::size_t cell;              ///< x fastest
  std::array<float, 3> in_cell;  ///< 0 at the lower texel centres, 1 at the upper ones
};

template <class Real>
using PerCorner = std::array<Real, 8>;

/// The trilinear weights of a cell's corners.
inline PerCorner<float> corner_weights(const std::array<float, 3>& place) {
  const std::array<float, 4> xy = {(1.0f - place[0]) * (1.0f - place[1]), place[0] * (1.0f - place[1]),
                                   (1.0f - place[0]) * place[1], place[0] * place[1]};
  PerCorner<float> w{};
  for (unsigned q = 0; q < 4; ++q) {
    w[q] = xy[q] * (1.0f - place[2]);
    w[q + 4] = xy[q] * place[2];
  }
  return w;
}

/// The cells between texel centres. Beyond the outermost centres places are clamped, as reading is.
class TexelCells {
 public:
  TexelCells(const Lattice& volume, const Lattice& texels);

  /// One where an axis has a single texel.
  [[nodiscard]] const Index3& size() const { return size_; }
  [[nodiscard]] CellPlace place(const Vec3f& position) const {
    const Vec3 at = volume_to_texels_.world(Vec3(position));
    CellPlace place{};
    for (int a = 2; a >= 0; --a) {
      const double x = std::clamp(at[a], 0.0, last_[a]);
      const int low = std::min(int(x), size_[a] - 1);
      place.in_cell[std::size_t(a)] = float(x - low);
      place.cell = place.cell * std::size_t(size_[a]) + std::size_t(low);
    }
    return place;
  }

 private:
  IndexToWorld volume_to_texels_;
  Vec3 last_;  ///< texel of each axis
  Index3 size_;
};

/// Sites by their cells, those of a cell in their own order.
struct CellOrder {
  std::vector<std::uint32_t> starts;  ///< where each cell's begin, and the end
  std::vector<std::uint32_t> sites;
};
[[nodiscard]] CellOrder sort_by_cells(const TexelCells& cells, const Sites& sites, const Run& run);

}  // namespace isolux
