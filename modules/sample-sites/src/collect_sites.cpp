#include "collect_sites.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <cmath>

namespace isolux {
namespace {

constexpr std::uint64_t kLargestRound = std::uint64_t(1) << 22;  // bounds the memory that rejected candidates take

}  // namespace

Sites room_for_sites(std::size_t count) {
  Sites sites;
  sites.positions.reserve(count);
  sites.isovalues.reserve(count);
  sites.normals.reserve(count);
  return sites;
}

void append_sites(Sites& all, const Sites& more, std::size_t count) {
  const auto n = std::ptrdiff_t(std::min(more.size(), count));
  all.positions.insert(all.positions.end(), more.positions.begin(), more.positions.begin() + n);
  all.isovalues.insert(all.isovalues.end(), more.isovalues.begin(), more.isovalues.begin() + n);
  all.normals.insert(all.normals.end(), more.normals.begin(), more.normals.begin() + n);
}

std::size_t wanted_sites(const SiteRequest& request, const ActiveCells& cells) {
  if (request.count > 0) return request.count;
  return std::size_t(std::ceil(request.per_texel * double(request.texels.count()) * cells.fraction()));
}

Sites sites_of_range(const Volume& volume, const SiteRequest& request, const ActiveCells& cells, std::uint64_t first,
                     std::uint64_t last, const UnitSequence& sequence, const Run& run) {
  std::vector<Vec3f> positions(last - first);
  parallel_blocks(positions.size(), 4096, run, {}, [&](const Block& block) {
    for (std::size_t i = block.begin; i < block.end; ++i) positions[i] = cells.place(sequence(first + i));
  });
  return make_sites(volume, std::move(positions), request, run);
}

Sites collect_sites(const Volume& volume, const SiteRequest& request, const ActiveCells& cells, std::size_t count,
                    const UnitSequence& sequence, const Run& run) {
  if (cells.empty() || count == 0) return {};
  Sites sites = room_for_sites(count);
  const std::uint64_t budget = count * kCandidatesPerSite;
  std::uint64_t tried = 0;
  while (sites.size() < count && tried < budget) {
    // The share accepted so far says how many candidates the missing sites will take.
    const double accepted = (double(sites.size()) + 1.0) / (double(tried) + 1.0);
    const auto hoped = std::uint64_t(double(count - sites.size()) / accepted * 1.02) + 64;
    const std::uint64_t round = std::min({hoped, budget - tried, std::max<std::uint64_t>(count, kLargestRound)});
    append_sites(sites, sites_of_range(volume, request, cells, tried, tried + round, sequence, run),
                 count - sites.size());
    tried += round;
    if (run.progress) run.progress("sites", double(sites.size()) / double(count));
  }
  return sites;
}

}  // namespace isolux
