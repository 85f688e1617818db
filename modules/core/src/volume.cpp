#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/volume.h>

#include <algorithm>
#include <cmath>

namespace isolux {

ValueRange value_range(const Volume& volume) {
  const auto values = volume.values.values();
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return {*low, *high};
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
