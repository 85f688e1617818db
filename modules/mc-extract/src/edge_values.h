#pragma once

#include <hwy/base.h>
#include <hwy/cache_control.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "march_state.h"

namespace isolux::mc {

/// Crossed grid edges of one axis wait here, i | j << 16, until there are enough to fill vectors.
struct EdgeBatch {
  static constexpr int kCapacity = 256;
  static constexpr int kLongestVector = 64;  ///< lanes: vectors are read whole
  std::array<std::uint32_t, kCapacity + 64 + kLongestVector> edges;
  int count = 0;
  float* positions;
  float* normals;

  EdgeBatch(float* first_position, float* first_normal) : positions(first_position), normals(first_normal) {}

  [[nodiscard]] bool full() const { return count >= kCapacity; }

  /// With `ahead`, where the word lies in the highest plane that its edges' gradients read, what no other edges have
  /// brought near is asked for here, so that it is there when the batch is computed.
  template <class Value = float>
  HWY_INLINE void add(std::uint64_t crossed, int j, int word, const Value* ahead = nullptr) {
    const std::uint32_t first = std::uint32_t(64 * word) | std::uint32_t(j) << 16;
    std::uint32_t* place = edges.data() + count;
    count += std::popcount(crossed);
    const auto put = [&](std::uint64_t left) {
      const int bit = std::countr_zero(left);
      if (ahead != nullptr) hwy::Prefetch(ahead + (bit & 63));
      *place++ = first + std::uint32_t(bit);
    };
    // Most words have few crossed edges: these are written whether they are there or not, as a loop's end cannot be
    // foretold.
    for (int n = 0; n < kUsual; ++n, crossed &= crossed - 1) put(crossed);
    for (; crossed != 0; crossed &= crossed - 1) put(crossed);
  }

 private:
  static constexpr int kUsual = 3;
};

/// The values that the vertices of some edges along kAxis are made from, copied one edge after the other: four that lie
/// side by side cost one load, where a gather takes some five operations a value (Zen 3). Beyond the box the last value
/// serves again.
template <int kAxis, class Value>
class EdgeValues {
 public:
  static constexpr int kCapacity = 64;
  template <int kValues>
  using Values = std::array<Value, std::size_t(kValues) * kCapacity>;

  Values<4> low;                                  ///< from one before the edge's lower end along x
  Values<kAxis == 0 ? 0 : 4> high;                ///< and its upper end
  Values<kAxis == 0 ? 0 : 1> before, beyond;      ///< one step further along the edge's own axis
  Values<kAxis == 0 ? 2 : 1> low_down, low_up;    ///< a step along y for edges along x and z, along z for others
  Values<kAxis == 0 ? 2 : 1> high_down, high_up;  ///< from the upper end; for edges along x a step along z

  HWY_INLINE void copy(const MarchState& march, int k, const std::uint32_t* edges, int count) {
    const std::size_t row = std::size_t(march.nx);
    const std::size_t plane = row * std::size_t(march.ny);
    const int upper = kAxis == 2 ? k + 1 : k;
    const Steps steps{row, plane, k > 0 ? plane : 0, upper + 1 < march.nz ? plane : 0};
    const Value* first = march.row_values<Value>(0, k);
    // Inside the box along x and y all neighbours are there: unsigned, a coordinate of 0 is too large as well.
    const auto inner_x = std::uint32_t(std::max(0, march.nx - 3));
    const auto inner_y = std::uint32_t(std::max(0, march.ny - 3));
    for (int e = 0; e < count; ++e) {
      const std::uint32_t i = edges[e] & 0xffff;
      const std::uint32_t j = edges[e] >> 16;
      if (i - 1 < inner_x && j - 1 < inner_y) [[likely]]
        copy_edge(e, first + j * row + i, steps);
      else
        copy_border_edge(march, int(i), int(j), k, e);
    }
  }

 private:
  /// From a grid point to its neighbours: along y, along z, and along z beyond the edge's ends, 0 at the box's faces.
  struct Steps {
    std::size_t row;
    std::size_t plane;
    std::size_t down;
    std::size_t up;
  };
  HWY_INLINE void copy_edge(int e, const Value* at, const Steps& steps) {
    std::memcpy(&low[4 * e], at - 1, 4 * sizeof(Value));
    if constexpr (kAxis == 0) {
      std::memcpy(&low_down[2 * e], at - steps.row, 2 * sizeof(Value));
      std::memcpy(&low_up[2 * e], at + steps.row, 2 * sizeof(Value));
      std::memcpy(&high_down[2 * e], at - steps.down, 2 * sizeof(Value));
      std::memcpy(&high_up[2 * e], at + steps.up, 2 * sizeof(Value));
    } else {
      const Value* end = at + (kAxis == 1 ? steps.row : steps.plane);
      std::memcpy(&high[4 * e], end - 1, 4 * sizeof(Value));
      const std::size_t across_down = kAxis == 1 ? steps.down : steps.row;
      const std::size_t across_up = kAxis == 1 ? steps.up : steps.row;
      low_down[e] = *(at - across_down);
      low_up[e] = at[across_up];
      high_down[e] = *(end - across_down);
      high_up[e] = end[across_up];
      before[e] = *(at - (kAxis == 1 ? steps.row : steps.down));
      beyond[e] = end[kAxis == 1 ? steps.row : steps.up];
    }
  }
  HWY_NOINLINE void copy_border_edge(const MarchState& march, int i, int j, int k, int e) {
    constexpr int kNear = 4;  // one before the lower end to two beyond it
    Value box[kNear][kNear][kNear];
    for (int z = 0; z < kNear; ++z) {
      for (int y = 0; y < kNear; ++y) {
        const Value* row =
            march.row_values<Value>(std::clamp(j + y - 1, 0, march.ny - 1), std::clamp(k + z - 1, 0, march.nz - 1));
        for (int x = 0; x < kNear; ++x) box[z][y][x] = row[std::clamp(i + x - 1, 0, march.nx - 1)];
      }
    }
    constexpr std::size_t kRow = kNear;
    constexpr std::size_t kPlane = std::size_t(kNear) * kNear;
    copy_edge(e, &box[1][1][1], {kRow, kPlane, kPlane, kPlane});
  }
};

}  // namespace isolux::mc
