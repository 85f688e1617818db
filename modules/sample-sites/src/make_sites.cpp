#include <isolux/core/parallel.h>
#include <isolux/sample_sites/site_sampler.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace isolux {
namespace {

constexpr std::size_t kSitesABlock = 4096;

}  // namespace

Sites make_sites(const Volume& volume, std::vector<Vec3f> positions, const SiteRequest& request, const Run& run) {
  const TrilinearField field(volume);
  const Vec3f last(volume.lattice().size - 1);
  Sites sites;
  sites.isovalues.resize(positions.size());
  sites.normals.resize(positions.size());
  std::vector<std::uint8_t> kept(positions.size(), 0);
  parallel_blocks(positions.size(), kSitesABlock, run, {}, [&](const Block& block) {
    for (std::size_t i = block.begin; i < block.end; ++i) {
      Vec3f& p = positions[i];
      if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z))) continue;
      for (int a = 0; a < 3; ++a) p[a] = std::clamp(p[a], 0.0f, last[a]);
      const Vec3 index(p);
      const auto isovalue = float(field.value(index));
      if (request.isovalues && !(isovalue >= request.isovalues->low && isovalue <= request.isovalues->high)) continue;
      const Vec3 normal = field.normal(index, request.outer, request.gradient);
      if (normal == Vec3(0.0) || field.is_flat_around(index)) continue;
      sites.isovalues[i] = isovalue;
      sites.normals[i] = Vec3f(normal);
      kept[i] = 1;
    }
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
