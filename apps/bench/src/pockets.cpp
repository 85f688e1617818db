#include "pockets.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <unordered_set>
#include <vector>

namespace isolux::bench {

bool is_in_closed_pocket(const Volume& volume, const Vec3& index, float isovalue) {
  constexpr int kRefinement = 8;
  const TrilinearField field(volume);
  const Vec3 gradient = field.cell_gradient(index);
  if (gradient == Vec3(0.0)) return true;
  const Index3 size = (volume.lattice().size - 1) * kRefinement + 1;
  const Vec3 start = (index - 0.5 / kRefinement * glm::normalize(gradient)) * double(kRefinement);
  std::vector<Index3> waiting;
  std::unordered_set<std::uint64_t> seen;
  const auto visit = [&](const Index3& p) {
    const bool is_new =
        seen.insert((std::uint64_t(p.z) * std::uint64_t(size.y) + std::uint64_t(p.y)) * std::uint64_t(size.x) +
                    std::uint64_t(p.x))
            .second;
    if (is_new && field.value(Vec3(p) / double(kRefinement)) < double(isovalue)) waiting.push_back(p);
  };
  for (int q = 0; q < 8; ++q) {
    Index3 p{0};
    for (int a = 0; a < 3; ++a) p[a] = std::clamp(int(std::floor(start[a])) + (q >> a & 1), 0, size[a] - 1);
    visit(p);
  }
  while (!waiting.empty()) {
    const Index3 p = waiting.back();
    waiting.pop_back();
    for (int a = 0; a < 3; ++a) {
      if (p[a] == 0 || p[a] == size[a] - 1) return false;
      for (const int step : {-1, 1}) {
        Index3 next = p;
        next[a] += step;
        visit(next);
      }
    }
  }
  return true;
}

}  // namespace isolux::bench
