#pragma once

#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>
#include <isolux/resample/resampler.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace isolux {

/// Scattered samples as the mean around each texel, weighted as trilinear reading weights the texel: what light between
/// reflections is read from where sites stay and their light changes. Sites are sorted once; a mean reads each of them
/// eight times. Constants are kept to rounding. A texel's samples are added in one order: the same for any number of
/// threads.
class TexelMeans {
 public:
  TexelMeans(const Volume& volume, const Sites& sites, const Lattice& texels, const Run& run);

  /// `channels` values a site, channel fastest. Texels with no site between their neighbours are not lit. \pre as many
  /// sites as at construction
  [[nodiscard]] ResampledGrid of(std::span<const float> radiance, int channels, const Run& run) const;

 private:
  struct Place {
    std::array<float, 3> in_cell;  ///< of texel centres, 0 to 1
    std::uint32_t site;
  };

  /// Adds the light of a cell's sites, of one of its corners (bit a: the upper one on axis a).
  void add_cell(std::size_t cell, unsigned corner, std::span<const float> radiance, std::size_t channels,
                std::array<double, 4>& sums) const;

  Lattice texels_;
  Index3 cells_;
  std::vector<std::uint32_t> starts_;  ///< of each cell's places, and the end
  std::vector<Place> places_;
};

}  // namespace isolux
