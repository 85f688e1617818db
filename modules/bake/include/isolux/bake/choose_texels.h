#pragma once

#include <isolux/bake/bake.h>

namespace isolux {

/// A size of the illumination grid and what it is wrong by.
struct TexelChoice {
  Index3 texels{1};
  double error = 0.0;  ///< estimated rms of what is read between exact texels less what is there
  TraceCounters counters;
};

/// The fewest texels, of a quarter to two a cell and axis, whose interpolation is wrong by at most `target`; where none
/// are, those that are least wrong. Measured, not guessed: at a thousand random points of random level sets (of
/// settings.isovalues, where there are any) e is traced there and at the eight texels around; rays' noise is taken out
/// of the difference, and what near-field terms will explain where the bake's resampler has them (weights found at a
/// half of the points serve the other). Of settings the isovalues, the tracer and trace but for its rays count. A fit
/// can be less wrong. For scenes of both sides the one that wants more texels counts. Cost: half a million rays a size
/// and side tried. The same for any number of threads. \throw as bake()
[[nodiscard]] TexelChoice choose_texels(const Volume& volume, const Scene& scene, const BakeSettings& settings,
                                        double target, const Stages& stages, const Run& run);

/// So many texels a cell and axis: at least one on each. \throw InvalidInput unless ratio > 0 and no axis has
/// more than an int holds
[[nodiscard]] Index3 texels_by_ratio(const Lattice& volume, double ratio);

}  // namespace isolux
