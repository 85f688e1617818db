#include <isolux/core/quantile.h>
#include <isolux/core/random.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace isolux {

float quantile(std::span<const float> values, double part) {
  constexpr std::size_t kMost = 65536;
  if (values.empty()) return 0.0f;
  std::vector<float> some(std::min(values.size(), kMost));
  for (std::size_t i = 0; i < some.size(); ++i) {
    // One of each share by chance: at even steps a grid's values might all be of one of its columns.
    const std::size_t begin = i * values.size() / some.size();
    const std::size_t share = (i + 1) * values.size() / some.size() - begin;
    some[i] = values[begin + std::size_t(mix_bits(i) % share)];
  }
  const auto at = some.begin() + std::ptrdiff_t(std::clamp(part, 0.0, 1.0) * double(some.size() - 1));
  std::nth_element(some.begin(), at, some.end());
  return *at;
}

}  // namespace isolux
