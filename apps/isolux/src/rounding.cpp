#include "rounding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <variant>

namespace isolux {
namespace {

/// Of a smooth field, steps of a surface that is read from fewer are seen in its normals.
constexpr double kFew = 4096.0;

struct Floats {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  double count = 0.0;  ///< that there are between the two, at the spacing of the largest
};

/// Nothing where no value was rounded, or none is finite.
std::optional<Floats> rounded_range(const StoredVolume& volume) {
  const auto* grid = std::get_if<Grid<float>>(&volume.values);
  if (grid == nullptr || !volume.rounded) return std::nullopt;
  Floats range;
  for (const float value : grid->values()) {
    if (!std::isfinite(value)) continue;
    range.low = std::min(range.low, double(value));
    range.high = std::max(range.high, double(value));
  }
  if (range.low > range.high) return std::nullopt;
  const auto largest = float(std::max(std::fabs(range.low), std::fabs(range.high)));
  const double step = double(largest) - double(std::nextafter(largest, 0.0f));
  range.count = step > 0.0 ? 1.0 + (range.high - range.low) / step : 1.0;
  return range;
}

}  // namespace

bool rounded_to_few(const StoredVolume& volume) {
  const auto range = rounded_range(volume);
  return range && range->count < kFew;
}

void warn_of_few_values(const StoredVolume& volume, double subtracted, const Session& session) {
  const auto range = rounded_range(volume);
  if (!range || range->count >= kFew) return;
  session.warn(
      fmt::format("{}: its values were rounded to float32, which has only about {:.0f} from {:.9g} to {:.9g}: "
                  "surfaces get steps; --subtract {:.9g} takes so much off first (isovalues too are then less by it)",
                  volume.name, range->count, range->low, range->high, subtracted + 0.5 * (range->low + range->high)));
}

}  // namespace isolux
