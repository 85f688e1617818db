#pragma once

#include <isolux/bake/bake.h>

#include "held_out.h"

namespace isolux {

/// What light is wrong by because reflections are read from texels, which the noise of its rays does not tell: more
/// rays do not help. Some sites, of a small grid all, are lit by paths besides.
class ReadingError {
 public:
  /// \pre settings.trace.bounces != 0 \throw Cancelled
  ReadingError(const Volume& volume, const Scene& scene, const Sites& sites, const BakeSettings& settings,
               const Run& run);

  /// rms error of e at the sites that their variances leave unexplained, at least what may hide in the noise of the
  /// paths.
  [[nodiscard]] double of(const SampleSet& samples) const;
  [[nodiscard]] const HeldOut& held_out() const { return held_out_; }

 private:
  HeldOut held_out_;
};

/// Whether less noise can make up for what reading is wrong by (rms) where an error is to be `target_rmse` in all.
[[nodiscard]] bool reading_allows(double target_rmse, double reading_error);

/// The squared standard error that rays are to reach so that an error is `target_rmse` in all; that of the target where
/// reading does not allow it.
[[nodiscard]] double squared_noise_for(double target_rmse, double reading_error);

}  // namespace isolux
