#pragma once

#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>

#include <cstddef>
#include <vector>

#include "lit_texels.h"
#include "near_field.h"
#include "wide/lattice_samples.h"

namespace isolux {

/// Writes what the volume says of texels: their looks, but for the light.
class TexelLooks {
 public:
  /// `texels` outlives it. \pre require_usable(volume)
  TexelLooks(const Volume& volume, const Sites& sites, const LitTexels& texels);

  /// Of those from `begin` to `end`: isovalues in mean grid spacings, normals, and the openness in front of them. \pre
  /// they are held
  void write(std::size_t begin, std::size_t end, const Run& run, wide::LatticeSamples& all) const;

 private:
  const Sites& sites_;
  const LitTexels& texels_;
  NearField near_field_;
  double outwards_;
  double isovalue_scale_;
};

/// The light of texels times `unit`, and its variance: of several samples at a texel the mean, as of independent ones.
class NoisyLight {
 public:
  /// All of these outlive it.
  NoisyLight(const std::vector<float>& radiance, const std::vector<float>& variance, const LitTexels& texels,
             std::size_t channels, float unit);

  /// Of those from `begin` to `end`. \pre they are held
  void write(std::size_t begin, std::size_t end, const Run& run, wide::LatticeSamples& all) const;

 private:
  std::vector<float> means_;      ///< of light, by texel, and
  std::vector<float> variances_;  ///< of its variance, where some have several samples
  const std::vector<float>& radiance_;
  const std::vector<float>& variance_;
  const LitTexels& texels_;
  std::size_t channels_;
  float unit_;
};

}  // namespace isolux
