#pragma once

#include <isolux/core/field.h>
#include <isolux/core/parallel.h>
#include <isolux/resample/resampler.h>

#include <span>
#include <vector>

#include "samples.h"
#include "shepard.h"

namespace isolux {

/// Walks a grid texel by texel: `search(texel point, found)` puts a texel's neighbours into `found`, nearest first, and
/// `light(index, point, found, texel)` writes the texel's values from them; texels that find none stay unlit.
template <class Search, class LightTexel>
ResampledGrid resample_texels(const Volume& volume, const SampleSet& samples, const Lattice& texels,
                              const ShepardSpace& space, const Search& search, const LightTexel& light,
                              const Run& run) {
  require_texels(texels);
  const TrilinearField field(volume);
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
      const Point point = space.point(index, isovalue);
      search(point, found);
      if (found.empty()) continue;
      light(index, point, std::span<const Neighbour>(found), &result.grid.values[t * std::size_t(samples.channels)]);
      result.lit[t] = 1;
    }
  });
  return result;
}

/// Fills a grid by Shepard's weights.
template <class Search>
ResampledGrid shepard_resample(const Volume& volume, const SampleSet& samples, const Lattice& texels,
                               const ShepardOptions& options, const ShepardSpace& space, const Search& search,
                               const Run& run) {
  const ShepardBlend blend(samples, options);
  const auto light = [&](const Vec3f& /*index*/, const Point& /*point*/, std::span<const Neighbour> found,
                         float* texel) { blend(found, texel); };
  return resample_texels(volume, samples, texels, space, search, light, run);
}

}  // namespace isolux
