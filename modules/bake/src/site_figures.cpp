#include "site_figures.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/field.h>
#include <isolux/core/parallel.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace isolux {
namespace {

/// Texels whose own level set was not asked for.
std::uint64_t texels_outside(const Volume& volume, const Lattice& texels, const ValueRange& wanted, const Run& run) {
  const TrilinearField field(volume);
  const IndexToWorld to_volume = index_to_index(texels, volume.lattice());
  const std::size_t row = std::size_t(texels.size.x);
  const std::size_t rows = texels.count() / row;
  std::vector<std::uint64_t> outside(rows);
  parallel_blocks(rows, 1, run, "", [&](const Block& block) {
    const std::size_t y = block.index % std::size_t(texels.size.y);
    const std::size_t z = block.index / std::size_t(texels.size.y);
    for (std::size_t x = 0; x < row; ++x) {
      // The site's own position is rounded to float, as samplers do.
      const auto value = float(field.value(Vec3(Vec3f(to_volume.world({double(x), double(y), double(z)})))));
      outside[block.index] += std::uint64_t(value < wanted.low || value > wanted.high);
    }
  });
  std::uint64_t sum = 0;
  for (const std::uint64_t part : outside) sum += part;
  return sum;
}

}  // namespace

void count_sites(const Volume& volume, const Lattice& texels, const BakeSettings& settings, const Run& run,
                 BakeResult& result) {
  if (result.sites == 0)
    throw InvalidInput(fmt::format("{}: no site has a normal and an isovalue in the range", volume.name));
  if (settings.sampler.name != "texels") return;
  const std::uint64_t left_out = texels.count() - result.sites;
  const std::uint64_t outside = settings.isovalues ? texels_outside(volume, texels, *settings.isovalues, run) : 0;
  result.skipped["sites_outside_iso_range"] = outside;
  result.skipped["sites_flat"] = left_out - std::min(left_out, outside);
}

}  // namespace isolux
