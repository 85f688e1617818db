#pragma once

#include <isolux/core/lattice.h>
#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>

#include <cstddef>
#include <vector>

namespace isolux {

/// Light by sample and channel.
struct DenoisedLight {
  std::vector<float> rest;        ///< all of it, or what is not lamps' where that is told apart
  std::vector<float> noisy_rest;  ///< what that was; empty where it is the samples' radiance
  std::vector<float> lamps;       ///< empty where it is not told apart
};

/// The samples' light with their rays' noise taken out where the samples around say that it is noise. Linear functions
/// of place, isovalue, normal and the volume's own openness are fitted to the nearest texels of like normals, for
/// windows of several widths (Moon, Carr & Yoon, "Adaptive rendering based on weighted local regression", TOG 2014).
/// Each one's mean squared error is estimated from what it leaves (Stein, "Estimation of the mean of a multivariate
/// normal distribution", 1981), the noise being the part of that which neighbours do not share; the better share more
/// in the result, and the samples themselves are one of the choices, their noise counted as far as reading leaves it.
/// Samples of two sides of an edge are not fitted together: shadow edges and thin walls stay. Lamps' light told apart
/// (SampleSet::lamps) and the rest are denoised each on its own: where a lamp's light is known, it stays what it is,
/// edges included, and does not part the windows of the rest. The same bits for any number of threads. Cost: one to two
/// microseconds of a thread a texel whose neighbours are noisy, a tenth of that where they are not; 8 bytes and four
/// more a texel of the lattice, and 110 for each lit texel of `texels_a_step`, in whole layers, and of the 32 layers
/// around. \throw InvalidInput for samples that are not at the centres of `texels`; Cancelled
[[nodiscard]] DenoisedLight denoised_light(const Volume& volume, const SampleSet& samples, const Lattice& texels,
                                           const Run& run, std::size_t texels_a_step = std::size_t(1) << 18);

}  // namespace isolux
