#include "missing_values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <variant>

namespace isolux {
namespace {

template <class T>
bool holds(double number) {
  return number >= double(std::numeric_limits<T>::lowest()) && number <= double(std::numeric_limits<T>::max()) &&
         std::floor(number) == number;
}

void to_float_values(StoredVolume& volume) {
  Volume floats = to_floats(std::move(volume));
  floats.stored_type = ScalarType::kFloat32;
  volume = keep_floats(std::move(floats));
}

}  // namespace

void mark_missing(StoredVolume& volume, double nodata, double subtracted, std::optional<float> replacement) {
  const bool stays = std::visit(
      [&]<class T>(Grid<T>& grid) {
        if constexpr (std::is_integral_v<T>) {
          if (!holds<T>(nodata)) return true;
          if (!replacement || !holds<T>(double(*replacement))) return false;
          std::replace(grid.values().begin(), grid.values().end(), T(nodata), T(*replacement));
          return true;
        } else {
          return false;
        }
      },
      volume.values);
  if (stays) return;
  const bool whole = volume.stored_type != ScalarType::kFloat32 && volume.stored_type != ScalarType::kFloat64;
  if (whole && (!replacement || std::floor(*replacement) != *replacement)) volume.stored_type = ScalarType::kFloat32;
  if (!std::holds_alternative<Grid<float>>(volume.values)) to_float_values(volume);
  // A file of floats has the nearest float of what its maker called missing.
  const auto exact = float(nodata - subtracted);
  const auto nearest = float(double(float(nodata)) - subtracted);
  for (float& voxel : std::get<Grid<float>>(volume.values).values())
    if (voxel == exact || voxel == nearest) voxel = std::numeric_limits<float>::quiet_NaN();
}

void replace_nonfinite(StoredVolume& volume, float replacement) {
  auto* floats = std::get_if<Grid<float>>(&volume.values);
  if (floats == nullptr) return;
  for (float& voxel : floats->values())
    if (!std::isfinite(voxel)) voxel = replacement;
}

}  // namespace isolux
