#include "isovalue_parts.h"

#include <isolux/core/random.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "grid_index.h"

namespace isolux {
namespace {

constexpr std::size_t kLooks = 32768;
/// Voxels for each of a part's sites, which take .7 byte a voxel while they are lit; and the fewest sites that are
/// worth a part, as each takes passes over the volume.
constexpr std::size_t kVoxelsASite = 64;
constexpr std::size_t kFewestSites = std::size_t(1) << 16;
constexpr std::size_t kMostParts = 64;

/// Isovalues of the sites at texels here and there, sorted: as many as texels of kLooks have a site.
std::vector<float> some_isovalues(const Volume& volume, const SiteRequest& request, const Run& run) {
  const IndexToWorld to_volume = index_to_index(request.texels, volume.lattice());
  std::vector<Vec3f> positions;
  for (std::size_t look = 0; look < kLooks; ++look) {
    const auto texel = std::size_t(mix_bits(look) % request.texels.count());
    if (request.only != nullptr && !(*request.only)[texel]) continue;
    positions.emplace_back(to_volume.world(Vec3(index_of(request.texels.size, texel))));
  }
  std::vector<float> values = make_sites(volume, std::move(positions), request, run).isovalues;
  std::sort(values.begin(), values.end());
  return values;
}

}  // namespace

std::vector<ValueRange> isovalue_parts(const Volume& volume, const SiteRequest& request, std::size_t count,
                                       const Run& run) {
  constexpr float kAll = std::numeric_limits<float>::infinity();
  const ValueRange all = request.isovalues.value_or(ValueRange{.low = -kAll, .high = kAll});
  std::vector<ValueRange> parts{all};
  const std::size_t a_part = std::max(volume.lattice().count() / kVoxelsASite, kFewestSites);
  if (count == 1 || (count == 0 && request.texels.count() < a_part)) return parts;
  const std::vector<float> values = some_isovalues(volume, request, run);
  if (count == 0) {
    const double sites = double(request.texels.count()) * double(values.size()) / double(kLooks);
    count = std::clamp<std::size_t>(std::size_t(std::lround(sites / double(a_part))), 1, kMostParts);
  }
  // A part ends where the sites of the next isovalue would make it larger than its share: many have the same one in
  // volumes of whole numbers, and those cannot be parted. No part is less than half a share: nets of rays are spread
  // over sites by how densely these lie.
  const std::size_t share = (values.size() + count - 1) / count;
  const std::size_t half = (share + 1) / 2;
  std::size_t first = 0;  // of the part
  for (std::size_t begin = 0, end = 0; begin < values.size(); begin = end) {
    while (end < values.size() && values[end] == values[begin]) ++end;
    if (end - first <= share || begin - first < half || values.size() - begin < half) continue;
    parts.back().high = std::nextafter(values[begin], -kAll);
    parts.push_back({.low = values[begin], .high = all.high});
    first = begin;
  }
  return parts;
}

}  // namespace isolux
