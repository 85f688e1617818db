#pragma once

#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>
#include <isolux/resample/resampler.h>

#include <memory>
#include <span>

namespace isolux {

/// Scattered samples as a straight line over the isovalue at each texel (LightDetail::slopes), the samples weighted as
/// trilinear reading weights the texel: what light between reflections is read from where sites stay and their light
/// changes. Sites are sorted once; a call reads each of them once, some 20 ns a site. Constants are kept to
/// rounding, light that is linear in the isovalue where samples are many. A texel's samples are added in one order: the
/// same for any number of threads.
class TexelMeans {
 public:
  TexelMeans(const Volume& volume, const Sites& sites, const Lattice& texels, const Run& run);
  ~TexelMeans();
  TexelMeans(TexelMeans&&) noexcept;
  TexelMeans& operator=(TexelMeans&&) noexcept;

  /// `channels` values a site, channel fastest. Texels with no site between their neighbours are not lit. \throw
  /// InvalidInput unless they are as many as the sites at construction, of 1 or 3 channels
  [[nodiscard]] ResampledGrid of(std::span<const float> radiance, int channels, const Run& run) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace isolux
