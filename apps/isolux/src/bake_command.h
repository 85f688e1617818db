#pragma once

#include <isolux/bake/bake.h>

#include <optional>
#include <string>
#include <vector>

#include "bake_options.h"
#include "isovalue_option.h"
#include "volume_options.h"

namespace isolux {

/// The words of `isolux bake`.
struct BakeOptions {
  VolumeOptions volume;
  TraceOptions trace;
  std::string output;
  std::string iso_range;
  std::string texels;
  std::string lattice = "cells";
  std::string bounce_method;
  std::string sites = "all";
  double rmse = 0.0;
  double time = 0.0;
  std::string error_grid;
  double texels_a_cell = 0.0;
  std::size_t samples = 0;
  std::string sampler;
  std::string resampler;
  std::vector<std::string> set;
  bool compress = false;

  /// --texels auto
  [[nodiscard]] bool chooses_texels() const { return texels == "auto"; }
};

/// What the words ask for, every backend named. Without a volume, so that nothing is read in vain, an --iso-range in
/// standard deviations is no more than one. \throw UsageError for words that contradict each other
[[nodiscard]] BakeSettings bake_settings(const BakeOptions& options, const Stages& stages,
                                         const std::optional<ValueMoments>& moments = {});

}  // namespace isolux
