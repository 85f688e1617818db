#pragma once

#include <isolux/core/run.h>
#include <isolux/core/volume.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace isolux {

enum class SlopeTerms { kNone, kByIsovalue };

/// The eight texels around a cell of texels, by their numbers among those used.
struct FitCorners {
  std::array<std::uint32_t, 8> texel;
  std::array<float, 8> isovalue;
  std::array<float, 8> inverse_breadth;

  /// The reading's weights of the texels' values, and of their slopes, at a place in the cell (0 to 1).
  void weights(const std::array<float, 3>& place, float at_isovalue, std::array<float, 8>& value,
               std::array<float, 8>& slope) const {
    const std::array<float, 4> xy = {(1.0f - place[0]) * (1.0f - place[1]), place[0] * (1.0f - place[1]),
                                     (1.0f - place[0]) * place[1], place[0] * place[1]};
    for (unsigned q = 0; q < 4; ++q) {
      value[q] = xy[q] * (1.0f - place[2]);
      value[q + 4] = xy[q] * place[2];
    }
    for (unsigned q = 0; q < 8; ++q) slope[q] = value[q] * (at_isovalue - isovalue[q]) * inverse_breadth[q];
  }
};

/// The texels that a fit has anything to say of: the corners of the cells that hold samples. They are numbered in the
/// order of memory, so that a known range of isovalues costs what its own texels cost.
class FitTexels {
 public:
  /// `starts` are the numbers of each cell's first sample, and the end; x fastest.
  FitTexels(const Volume& volume, const Lattice& texels, std::span<const std::uint32_t> starts, SlopeTerms slopes,
            const Run& run);

  [[nodiscard]] std::size_t size() const { return offsets_.size(); }
  /// Where the used texels lie in the whole grid.
  [[nodiscard]] std::span<const std::size_t> offsets() const { return offsets_; }
  /// One over the isovalue span that counts as one in a texel's slope: half the range of f over the texel's support. 0
  /// without slopes.
  [[nodiscard]] std::span<const float> inverse_breadths() const { return inverse_breadths_; }
  [[nodiscard]] const Lattice& lattice() const { return texels_; }
  [[nodiscard]] FitCorners corners(int i, int j, int k) const;
  [[nodiscard]] Index3 cells() const { return cells_of(texels_); }

  /// Cells between texel centres; one where an axis has a single texel.
  [[nodiscard]] static Index3 cells_of(const Lattice& texels);

 private:
  void number(std::span<const std::uint32_t> starts);
  void measure(const Volume& volume, const Run& run);

  Lattice texels_;
  SlopeTerms slope_terms_;
  std::vector<std::uint32_t> number_;  ///< of every texel of the grid
  std::vector<std::size_t> offsets_;
  std::vector<float> isovalues_;  ///< f at the texel centres
  std::vector<float> inverse_breadths_;
};

}  // namespace isolux
