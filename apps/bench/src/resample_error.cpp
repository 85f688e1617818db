#include "resample_error.h"

#include <isolux/core/stopwatch.h>

namespace isolux::bench {

ResamplingResult resampling_error(const Truth& truth, const Volume& volume, const SampleSet& samples,
                                  const Resampler& resampler, const SuiteContext& context) {
  const Lattice texels = cell_lattice(volume.lattice());
  const Stopwatch watch;
  const ResampledGrid result = resampler.resample(volume, samples, texels, context.run);
  ResamplingResult found{.error = {}, .seconds = watch.seconds()};
  std::vector<double> errors;
  for (int k = 0; k < texels.size.z; ++k) {
    for (int j = 0; j < texels.size.y; ++j) {
      for (int i = 0; i < texels.size.x; ++i) {
        const auto exact = truth.e(texels.frame.world(Vec3(i, j, k)));
        const std::size_t t = texels.offset(i, j, k);
        if (exact && result.lit[t] != 0) errors.push_back(double(result.grid.values[t]) - *exact);
      }
    }
  }
  found.texels = errors.size();
  found.error = rms_interval(errors, context.run.seed);
  return found;
}

std::vector<double> errors_at_sites(const Truth& truth, const Volume& volume, const SampleSet& samples) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Vec3 world = volume.lattice().frame.world(Vec3(samples.sites.positions[i]));
    errors.push_back(double(samples.radiance[i * std::size_t(samples.channels)]) - truth.e(world).value());
  }
  return errors;
}

}  // namespace isolux::bench
