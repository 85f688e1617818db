#include <isolux/core/error.h>
#include <isolux/resample/resampler.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace isolux {

IlluminationGrid unlit_grid(const Lattice& texels, int channels) {
  IlluminationGrid grid(texels, channels);
  grid.values.assign(grid.values.size(), std::numeric_limits<float>::quiet_NaN());
  return grid;
}

ResampledGrid told_by_bytes(IlluminationGrid marked) {
  require_complete(marked);
  ResampledGrid told{.grid = std::move(marked), .lit = {}};
  const auto channels = std::size_t(told.grid.channels);
  told.lit.resize(told.grid.lattice.count(), 1);
  for (std::size_t v = 0; v < told.grid.values.size(); ++v) {
    if (!std::isnan(told.grid.values[v])) continue;
    told.grid.values[v] = 0.0f;
    told.lit[v / channels] = 0;
  }
  return told;
}

void Resampler::add_part(const Volume& /*volume*/, const SampleSet& /*samples*/, IlluminationGrid& /*texels*/,
                         const Run& /*run*/) const {
  throw InvalidInput("this resampler takes all samples at once");
}

}  // namespace isolux
