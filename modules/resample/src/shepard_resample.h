#pragma once

#include <isolux/core/field.h>
#include <isolux/core/parallel.h>
#include <isolux/resample/resampler.h>

#include "shepard.h"

namespace isolux {

/// Fills a grid texel by texel: `search(texel point, found)` puts a texel's neighbours into `found`, nearest first.
template <class Search>
ResampledGrid shepard_resample(const Volume& volume, const SampleSet& samples, const Lattice& texels,
                               const ShepardOptions& options, const ShepardSpace& space, const Search& search,
                               const Run& run) {
  const TrilinearField field(volume);
  const ShepardBlend blend(samples, options);
  const IndexToWorld to_volume = index_to_index(texels, volume.lattice());
  const auto nx = std::size_t(texels.size.x);
  const auto ny = std::size_t(texels.size.y);
  ResampledGrid result{.grid = IlluminationGrid(texels, samples.channels),
                       .lit = std::vector<std::uint8_t>(texels.count(), 0)};
  parallel_blocks(texels.count(), 512, run, "resample", [&](const Block& block) {
    std::vector<Neighbour> found;
    for (std::size_t t = block.begin; t < block.end; ++t) {
      const std::size_t j = t / nx % ny;
      const std::size_t k = t / (nx * ny);
      const Vec3f index(to_volume.world({double(t % nx), double(j), double(k)}));
      const float isovalue = space.uses_isovalues() ? float(field.value(Vec3(index))) : 0.0f;
      search(space.point(index, isovalue), found);
      if (found.empty()) continue;
      blend(found, &result.grid.values[t * std::size_t(samples.channels)]);
      result.lit[t] = 1;
    }
  });
  return result;
}

}  // namespace isolux
