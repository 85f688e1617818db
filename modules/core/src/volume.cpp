#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/volume.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace isolux {

ValueRange value_range(const Volume& volume) {
  // Columns of their own, which a vector takes at once.
  constexpr std::size_t kColumns = 32;
  const auto values = volume.values.values();
  std::array<float, kColumns> low{};
  std::array<float, kColumns> high{};
  low.fill(values.front());
  high.fill(values.front());
  std::size_t i = 0;
  for (; i + kColumns <= values.size(); i += kColumns) {
    for (std::size_t c = 0; c < kColumns; ++c) {
      const float value = values[i + c];
      low[c] = value < low[c] ? value : low[c];
      high[c] = value > high[c] ? value : high[c];
    }
  }
  for (; i < values.size(); ++i) {
    low[0] = std::min(low[0], values[i]);
    high[0] = std::max(high[0], values[i]);
  }
  return {*std::min_element(low.begin(), low.end()), *std::max_element(high.begin(), high.end())};
}

void require_usable(const Volume& volume) {
  const Index3 size = volume.lattice().size;
  if (size.x < 2 || size.y < 2 || size.z < 2) {
    throw InvalidInput(
        fmt::format("{}: {}x{}x{} grid points; every axis needs at least 2", volume.name, size.x, size.y, size.z));
  }
  const auto values = volume.values.values();
  const auto bad = std::find_if(values.begin(), values.end(), [](float v) { return !std::isfinite(v); });
  if (bad == values.end()) return;
  const auto count = std::count_if(bad, values.end(), [](float v) { return !std::isfinite(v); });
  const auto at = std::size_t(bad - values.begin());
  const auto nx = std::size_t(size.x);
  const auto ny = std::size_t(size.y);
  throw InvalidInput(fmt::format("{}: {} of {} voxels are not finite numbers, the first ({}) at {},{},{}", volume.name,
                                 count, values.size(), *bad, at % nx, at / nx % ny, at / (nx * ny)));
}

}  // namespace isolux
