#pragma once

#include <isolux/core/run.h>
#include <isolux/core/volume.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fit_cell.h"

namespace isolux {

/// The texels that a fit has anything to say of: the corners of the cells that hold samples. They are numbered in the
/// order of memory, so that a known range of isovalues costs what its own texels cost.
class FitTexels {
 public:
  /// `starts` are the numbers of each cell's first sample, and the end; x fastest.
  FitTexels(const Volume& volume, const Lattice& texels, std::span<const std::uint32_t> starts, const FitTerms& terms,
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
  FitTerms terms_;
  std::vector<std::uint32_t> number_;  ///< of every texel of the grid
  std::vector<std::size_t> offsets_;
  std::vector<float> isovalues_;  ///< f at the texel centres
  std::vector<float> inverse_breadths_;
  std::vector<Vec3f> normals_;  ///< of the level sets through the texel centres, towards lower values; or none
};

}  // namespace isolux
