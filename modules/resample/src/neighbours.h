#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace isolux {

/// A sample seen from a texel: its reach in the upper bits and its index in the lower ones, so that comparing numbers
/// orders by reach and, where reaches are equal, by index. (The bits of non-negative floats order as the floats do.)
class Neighbour {
 public:
  Neighbour() = default;
  Neighbour(float reach, std::uint32_t sample)
      : bits_(std::uint64_t(std::bit_cast<std::uint32_t>(reach)) << 32 | sample) {}
  [[nodiscard]] float reach() const { return std::bit_cast<float>(std::uint32_t(bits_ >> 32)); }
  [[nodiscard]] std::uint32_t sample() const { return std::uint32_t(bits_); }
  friend bool operator<(const Neighbour& a, const Neighbour& b) { return a.bits_ < b.bits_; }

 private:
  std::uint64_t bits_ = 0;
};

/// Which neighbours a texel wants: the `count` nearest of those within `reach`.
struct NeighbourLimits {
  std::size_t count = std::numeric_limits<std::size_t>::max();
  float reach = std::numeric_limits<float>::infinity();
};

/// Keeps the nearest of the neighbours offered, in any order, to a buffer of the caller's.
class NearestNeighbours {
 public:
  NearestNeighbours(const NeighbourLimits& limits, std::vector<Neighbour>& found)
      : limits_(limits), found_(found), worst_(limits.reach, std::numeric_limits<std::uint32_t>::max()) {
    found_.clear();
  }

  void offer(float reach, std::uint32_t sample) {
    if (!(reach <= worst_.reach())) return;
    const Neighbour candidate(reach, sample);
    if (worst_ < candidate) return;
    found_.push_back(candidate);
    // Twice the wanted number are let in before the farther half is thrown out: constant time for each on average.
    if (limits_.count < kMany && found_.size() >= 2 * limits_.count + 16) shrink();
  }

  /// A reach beyond which nothing is wanted, not always the least.
  [[nodiscard]] float bound() const { return worst_.reach(); }

  /// The least reach beyond which nothing is wanted any more.
  [[nodiscard]] float worst_reach() {
    if (found_.size() < limits_.count) return limits_.reach;
    shrink();
    return worst_.reach();
  }

  /// Sorts the buffer, nearest first.
  void finish() {
    if (found_.size() > limits_.count) shrink();
    std::sort(found_.begin(), found_.end());
  }

 private:
  static constexpr std::size_t kMany = std::size_t(1) << 40;

  void shrink() {
    const auto last = found_.begin() + std::ptrdiff_t(limits_.count) - 1;
    std::nth_element(found_.begin(), last, found_.end());
    worst_ = *last;
    found_.resize(limits_.count);
  }

  NeighbourLimits limits_;
  std::vector<Neighbour>& found_;
  Neighbour worst_;
};

}  // namespace isolux
