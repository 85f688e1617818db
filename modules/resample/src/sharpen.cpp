#include "sharpen.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace isolux {
namespace {

/// A twelfth would make cubic light exact at the middle of cells; what is left of the noise asks for less
/// (docs/measured/resampling.md, "Sharpening for reading").
constexpr float kSharpening = 0.045f;

/// The light's bend along an axis, second differences, at the middle one of five texels; less the largest that a
/// neighbour has the other way: where light jumps from one texel to the next two such bends stand side by side, and
/// sharper they would be fringes.
float bend(const float* at, std::ptrdiff_t step) {
  const auto second_difference = [&](std::ptrdiff_t i) {
    return at[(i - 1) * step] - 2.0f * at[i * step] + at[(i + 1) * step];
  };
  const float here = second_difference(0);
  const float sign = std::copysign(1.0f, here);
  const float against = std::max({0.0f, -sign * second_difference(-1), -sign * second_difference(1)});
  return sign * std::max(0.0f, std::fabs(here) - against);
}

}  // namespace

void sharpen(IlluminationGrid& light, const IlluminationGrid& before, const Run& run) {
  const std::vector<float> blunt = light.values;
  const Index3 size = light.lattice.size;
  const auto channels = std::ptrdiff_t(light.channels);
  const std::array<std::ptrdiff_t, 3> step{channels, channels * size.x, channels * size.x * size.y};
  parallel_blocks(std::size_t(size.z), 1, run, "", [&](const Block& block) {
    const int z = int(block.begin);
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const Index3 texel(x, y, z);
        const std::size_t first = light.lattice.offset(x, y, z) * std::size_t(channels);
        for (std::size_t at = first; at < first + std::size_t(channels); ++at) {
          if (std::isnan(blunt[at]) || blunt[at] == before.values[at]) continue;
          float sum = 0.0f;
          for (int a = 0; a < 3; ++a)
            if (texel[a] >= 2 && texel[a] + 2 < size[a]) sum += bend(&blunt[at], step[std::size_t(a)]);
          light.values[at] = std::max(0.0f, blunt[at] - kSharpening * sum);
        }
      }
    }
  });
}

}  // namespace isolux
