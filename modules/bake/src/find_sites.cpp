#include <fmt/format.h>
#include <isolux/bake/find_sites.h>
#include <isolux/core/error.h>
#include <isolux/core/parallel.h>
#include <isolux/core/stopwatch.h>

#include <algorithm>
#include <vector>

#include "bake_parts.h"
#include "resampling_choice.h"

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

FoundSites find_sites(const Volume& volume, OuterSide outer, const BakeSettings& settings, const Stages& stages,
                      const Run& run) {
  require_lightable(volume, settings);
  const auto sampler = stages.samplers.create(settings.sampler.name, settings.sampler.settings);
  const Lattice texels = texel_lattice(volume.lattice(), settings);
  const Stopwatch watch;
  SiteRequest request = site_request(settings, texels, outer);
  request.per_texel = sites_a_texel(volume.lattice(), texels, settings);
  FoundSites found;
  BakeResult& result = found.begun;
  found.sites = sampler->sample(volume, request, run);
  result.sites = found.sites.size();
  if (result.sites == 0)
    throw InvalidInput(fmt::format("{}: no site has a normal and an isovalue in the range", volume.name));
  if (settings.sampler.name == "texels") {
    const std::uint64_t left_out = texels.count() - found.sites.size();
    const std::uint64_t outside = settings.isovalues ? texels_outside(volume, texels, *settings.isovalues, run) : 0;
    result.skipped["sites_outside_iso_range"] = outside;
    result.skipped["sites_flat"] = left_out - std::min(left_out, outside);
  }
  result.seconds["sites"] = watch.seconds();
  return found;
}

FoundSites turned_round(FoundSites found) {
  for (Vec3f& normal : found.sites.normals) normal = -normal;
  found.begun.seconds.clear();
  return found;
}

}  // namespace isolux
