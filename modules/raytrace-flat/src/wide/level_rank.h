#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace isolux::wide {

/// How many of a rising list of levels lie below a value: a table over equal bins of values says how many lie in lower
/// bins, so that hardly ever more than one level has to be compared.
class LevelRank {
 public:
  explicit LevelRank(std::span<const float> levels) : levels_(levels.begin(), levels.end()), below_(kBins + 1, 0) {
    if (levels_.empty()) return;
    low_ = levels_.front();
    high_ = levels_.back();
    const float extent = high_ - low_;
    scale_ = extent > 0.0f ? float(kBins) / extent : 0.0f;
    for (const float level : levels_) ++below_[bin(level) + 1];
    for (std::size_t b = 1; b < below_.size(); ++b) below_[b] = std::uint16_t(below_[b] + below_[b - 1]);
  }

  /// Levels that are at most `value`.
  [[nodiscard]] std::size_t reached(float value) const {
    // Where levels are of a narrow range most values lie beyond it.
    if (!(value >= low_)) return 0;
    if (value >= high_) return levels_.size();
    std::size_t n = below_[bin(value)];
    while (n < levels_.size() && levels_[n] <= value) ++n;
    return n;
  }
  /// Levels that are less than `value`.
  [[nodiscard]] std::size_t exceeded(float value) const {
    if (!(value > low_)) return 0;
    if (value > high_) return levels_.size();
    std::size_t n = below_[bin(value)];
    while (n < levels_.size() && levels_[n] < value) ++n;
    return n;
  }

 private:
  static constexpr std::size_t kBins = 4096;

  /// Never falls where the value rises, whatever rounding does: levels of lower bins are lower.
  [[nodiscard]] std::size_t bin(float value) const {
    const float x = (value - low_) * scale_;
    if (!(x > 0.0f)) return 0;
    return x < float(kBins - 1) ? std::size_t(x) : kBins - 1;
  }

  std::vector<float> levels_;
  std::vector<std::uint16_t> below_;  ///< of a bin: levels in lower bins
  float low_ = 0.0f;
  float high_ = 0.0f;
  float scale_ = 0.0f;
};

}  // namespace isolux::wide
