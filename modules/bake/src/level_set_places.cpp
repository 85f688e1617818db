#include "level_set_places.h"

#include <isolux/core/random.h>

#include <glm/common.hpp>
#include <optional>
#include <utility>
#include <vector>

namespace isolux {
namespace {

/// Where a level set crosses one of the edges of the cell around a point, chosen at random; nothing if it crosses none.
std::optional<Vec3f> on_an_edge(const Volume& volume, const Vec3f& point, float isovalue, RandomStream& random) {
  constexpr int kEdges = 12;
  const Index3 cell = glm::min(Index3(point), volume.lattice().size - 2);
  const int first = int(random.uniform_double() * kEdges);
  for (int e = 0; e < kEdges; ++e) {
    const int edge = (first + e) % kEdges;
    const int axis = edge / 4;
    Index3 low = cell;
    low[(axis + 1) % 3] += edge & 1;
    low[(axis + 2) % 3] += edge >> 1 & 1;
    Index3 high = low;
    ++high[axis];
    const double before = double(volume.values(low.x, low.y, low.z)) - double(isovalue);
    const double after = double(volume.values(high.x, high.y, high.z)) - double(isovalue);
    if ((before < 0.0) == (after < 0.0)) continue;
    Vec3 crossing(low);
    crossing[axis] += before / (before - after);
    return Vec3f(crossing);
  }
  return std::nullopt;
}

}  // namespace

Sites level_set_places(const Volume& volume, SiteRequest request, std::size_t count, const Run& run) {
  Run own = run;
  own.seed = mix_bits(run.seed ^ 0x6a756467);
  own.progress = {};
  request.count = count;
  Sites sites = samplers().create("level_sets")->sample(volume, request, own);
  std::vector<Vec3f> positions = std::move(sites.positions);
  for (std::size_t i = 1; i < positions.size(); i += 2) {
    RandomStream random(own.seed, i, 1);
    positions[i] = on_an_edge(volume, positions[i], sites.isovalues[i], random).value_or(positions[i]);
  }
  request.isovalues = {};  // floats seldom lie on one level set exactly
  return make_sites(volume, std::move(positions), request, own);
}

}  // namespace isolux
