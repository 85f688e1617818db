#include <isolux/core/parallel.h>
#include <isolux/sample_sites/site_sampler.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "site_maker.h"

namespace isolux {
namespace {

constexpr std::size_t kSitesABlock = 4096;

}  // namespace

Sites make_sites(const Volume& volume, std::vector<Vec3f> positions, const SiteRequest& request, const Run& run) {
  const SiteMaker maker(volume, request);
  Sites sites;
  sites.isovalues.resize(positions.size());
  sites.normals.resize(positions.size());
  std::vector<std::uint8_t> kept(positions.size(), 0);
  parallel_blocks(positions.size(), kSitesABlock, run, {}, [&](const Block& block) {
    const auto some = std::span(positions).subspan(block.begin, block.end - block.begin);
    maker.make(some, [&](std::size_t number, const Site& site) {
      const std::size_t i = block.begin + number;
      positions[i] = site.position;
      sites.isovalues[i] = site.isovalue;
      sites.normals[i] = site.normal;
      kept[i] = 1;
    });
  });

  std::size_t count = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (kept[i] == 0) continue;
    positions[count] = positions[i];
    sites.isovalues[count] = sites.isovalues[i];
    sites.normals[count] = sites.normals[i];
    ++count;
  }
  positions.resize(count);
  sites.positions = std::move(positions);
  sites.isovalues.resize(count);
  sites.normals.resize(count);
  return sites;
}

}  // namespace isolux
