#include "model/histogram.h"

#include <algorithm>
#include <variant>

namespace isolux::viewer {

Histogram make_histogram(const VolumeView& volume) {
  Histogram result;
  result.range = value_range(volume);
  const double low = result.range.low;
  const double width = double(result.range.high) - low;
  const double steps_a_unit = width > 0.0 ? Histogram::kSteps / width : 0.0;
  const int first = width > 0.0 ? 0 : Histogram::kSteps / 2;  // the one value of a flat volume, as the slider has it
  std::visit(
      [&](const auto& values) {
        for (const auto v : values) {
          const int step = std::min(first + int((double(v) - low) * steps_a_unit), Histogram::kSteps - 1);
          ++result.counts[std::size_t(step)];
        }
      },
      volume.voxels());
  return result;
}

double otsu_threshold(const Histogram& histogram) {
  double count = 0.0;
  double sum = 0.0;
  for (int i = 0; i < Histogram::kSteps; ++i) {
    count += double(histogram.counts[std::size_t(i)]);
    sum += i * double(histogram.counts[std::size_t(i)]);
  }
  double below = 0.0;
  double below_sum = 0.0;
  double best = 0.0;
  double best_step = 0.0;
  for (int i = 0; i + 1 < Histogram::kSteps; ++i) {
    below += double(histogram.counts[std::size_t(i)]);
    below_sum += i * double(histogram.counts[std::size_t(i)]);
    const double above = count - below;
    if (below == 0.0 || above == 0.0) continue;
    const double apart = below_sum / below - (sum - below_sum) / above;
    const double between = below * above * apart * apart;
    if (between > best) {
      best = between;
      best_step = i + 1.0;
    }
  }
  const double low = histogram.range.low;
  return low + best_step / Histogram::kSteps * (double(histogram.range.high) - low);
}

}  // namespace isolux::viewer
