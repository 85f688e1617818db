#include "isovalue_parts.h"

#include <isolux/core/field.h>
#include <isolux/core/random.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "grid_index.h"

namespace isolux {
namespace {

constexpr std::size_t kLooks = 32768;

/// Isovalues of texels here and there, sorted.
std::vector<float> some_isovalues(const Volume& volume, const Lattice& texels,
                                  const std::optional<ValueRange>& wanted) {
  const TrilinearField field(volume);
  const IndexToWorld to_volume = index_to_index(texels, volume.lattice());
  std::vector<float> values;
  for (std::size_t look = 0; look < kLooks; ++look) {
    const auto texel = std::size_t(mix_bits(look) % texels.count());
    const auto value = float(field.value(to_volume.world(Vec3(index_of(texels.size, texel)))));
    if (!wanted || (value >= wanted->low && value <= wanted->high)) values.push_back(value);
  }
  std::sort(values.begin(), values.end());
  return values;
}

}  // namespace

std::vector<ValueRange> isovalue_parts(const Volume& volume, const Lattice& texels,
                                       const std::optional<ValueRange>& wanted, std::size_t count) {
  constexpr float kAll = std::numeric_limits<float>::infinity();
  const ValueRange all = wanted.value_or(ValueRange{.low = -kAll, .high = kAll});
  std::vector<ValueRange> parts{all};
  const std::vector<float> values = some_isovalues(volume, texels, wanted);
  for (std::size_t part = 1; part < count && !values.empty(); ++part) {
    const float low = values[part * values.size() / count];
    if (!(low > parts.back().low && low > values.front())) continue;
    parts.back().high = std::nextafter(low, -kAll);
    parts.push_back({.low = low, .high = all.high});
  }
  return parts;
}

}  // namespace isolux
