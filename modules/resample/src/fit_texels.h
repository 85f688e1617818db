#pragma once

#include <isolux/core/run.h>
#include <isolux/core/volume.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fit_cell.h"
#include "wide/fit_products.h"

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
  /// What isovalues are multiplied by here: a power of two that makes the volume's range about one, so that floats hold
  /// their differences whatever the volume's unit.
  [[nodiscard]] double scale() const { return scale_; }
  /// One over the isovalue span, scaled, that counts as one in a texel's slope: half the range of f over the texel's
  /// support. 0 without slopes.
  [[nodiscard]] std::span<const float> inverse_breadths() const { return inverse_breadths_; }
  [[nodiscard]] const FitTerms& terms() const { return terms_; }
  /// The cells of a row along x but for their samples.
  [[nodiscard]] wide::FitCells cells_along(int j, int k) const;
  [[nodiscard]] wide::FitCentres centres() const;
  /// The isovalue, scaled, from which those of a cell's samples count; cells as in cells_along().
  [[nodiscard]] float reference(const wide::FitCells& cells, std::size_t cell) const {
    return isovalues_[cells.texels[0][cell]];
  }
  /// Makes planes of numbers what samples' features want: slopes over the scaled isovalue, and the normals from which
  /// the numbers along them count moved into the values.
  void move(std::span<float> numbers, const Run& run) const;
  /// The transpose of move().
  void move_back(std::span<float> sums, const Run& run) const;
  [[nodiscard]] const Index3& cells() const { return cells_; }

 private:
  void number(std::span<const std::uint32_t> starts);
  void measure(const Volume& volume, const Run& run);

  Lattice texels_;
  Index3 cells_;
  FitTerms terms_;
  std::vector<std::uint32_t> number_;  ///< of every texel of the grid
  std::vector<std::size_t> offsets_;
  double scale_ = 1.0;
  std::vector<float> isovalues_;  ///< f at the texel centres, scaled
  std::vector<float> inverse_breadths_;
  std::array<std::vector<float>, 3> normals_;  ///< of the level sets through the texel centres, towards lower values;
                                               ///< or none
};

}  // namespace isolux
