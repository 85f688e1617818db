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

  /// `ahead` is where the word lies in the highest plane that its edges' gradients read: what other edges have not yet
  /// brought near. Asked for here it is there when the batch is computed.
  HWY_INLINE void add(std::uint64_t crossed, int j, int word, const float* ahead) {
    const std::uint32_t first = std::uint32_t(64 * word) | std::uint32_t(j) << 16;
    std::uint32_t* place = edges.data() + count;
    count += std::popcount(crossed);
    const auto put = [&] {
      const int bit = std::countr_zero(crossed);
      hwy::Prefetch(ahead + bit);
      *place++ = first + std::uint32_t(bit);
      crossed &= crossed - 1;
    };
    // Most words have few crossed edges: these are written whether they are there or not, as a loop's end cannot be
    // foretold.
    for (int n = 0; n < kUsual; ++n) put();
    while (crossed != 0) put();
  }

 private:
  static constexpr int kUsual = 3;
};

/// The values that the vertices of some edges along kAxis are made from, copied one edge after the other: four that lie
/// side by side cost one load, where a gather takes some five operations a value (Zen 3). Beyond the box the last value
/// serves again.
template <int kAxis>
class EdgeValues {
 public:
  static constexpr int kCapacity = 64;
  template <int kValues>
  using Values = std::array<float, std::size_t(kValues) * kCapacity>;

  Values<4> low;                                  ///< from one before the edge's lower end along x
  Values<kAxis == 0 ? 0 : 4> high;                ///< and its upper end
  Values<kAxis == 0 ? 0 : 1> before, beyond;      ///< one step further along the edge's own axis
  Values<kAxis == 0 ? 2 : 1> low_down, low_up;    ///< a step along y for edges along x and z, along z for others
  Values<kAxis == 0 ? 2 : 1> high_down, high_up;  ///< from the upper end; for edges along x a step along z

  HWY_INLINE void copy(const MarchState& march, int k, const std::uint32_t* edges, int count) {
    const std::size_t row = std::size_t(march.nx);
    const std::size_t plane = row * std::size_t(march.ny);
    const float* first = march.row_values(0, k);
    // Of edges inside the box all neighbours are there: unsigned, a coordinate of 0 is too large as well.
    const auto inner_x = std::uint32_t(std::max(0, march.nx - 3));
    const auto inner_y = k > 0 && k + 2 < march.nz ? std::uint32_t(std::max(0, march.ny - 3)) : 0U;
    for (int e = 0; e < count; ++e) {
      const std::uint32_t i = edges[e] & 0xffff;
      const std::uint32_t j = edges[e] >> 16;
      if (i - 1 < inner_x && j - 1 < inner_y) [[likely]]
        copy_edge(e, first + j * row + i, kAxis == 1 ? row : plane, kAxis == 1 ? plane : row);
      else
        copy_border_edge(march, int(i), int(j), k, e);
    }
  }

 private:
  /// `along` is the step on the edge's own axis, or along z for an edge along x, and `across` the step on the third.
  HWY_INLINE void copy_edge(int e, const float* at, std::size_t along, std::size_t across) {
    std::memcpy(&low[4 * e], at - 1, 4 * sizeof(float));
    if constexpr (kAxis == 0) {
      std::memcpy(&low_down[2 * e], at - across, 2 * sizeof(float));
      std::memcpy(&low_up[2 * e], at + across, 2 * sizeof(float));
      std::memcpy(&high_down[2 * e], at - along, 2 * sizeof(float));
      std::memcpy(&high_up[2 * e], at + along, 2 * sizeof(float));
    } else {
      low_down[e] = *(at - across);
      low_up[e] = at[across];
      before[e] = *(at - along);
      at += along;
      std::memcpy(&high[4 * e], at - 1, 4 * sizeof(float));
      high_down[e] = *(at - across);
      high_up[e] = at[across];
      beyond[e] = at[along];
    }
  }
  HWY_NOINLINE void copy_border_edge(const MarchState& march, int i, int j, int k, int e) {
    constexpr int kNear = 4;  // one before the lower end to two beyond it
    float box[kNear][kNear][kNear];
    for (int z = 0; z < kNear; ++z) {
      for (int y = 0; y < kNear; ++y) {
        const float* row =
            march.row_values(std::clamp(j + y - 1, 0, march.ny - 1), std::clamp(k + z - 1, 0, march.nz - 1));
        for (int x = 0; x < kNear; ++x) box[z][y][x] = row[std::clamp(i + x - 1, 0, march.nx - 1)];
      }
    }
    constexpr std::size_t kRow = kNear;
    constexpr std::size_t kPlane = std::size_t(kNear) * kNear;
    copy_edge(e, &box[1][1][1], kAxis == 1 ? kRow : kPlane, kAxis == 1 ? kPlane : kRow);
  }
};

}  // namespace isolux::mc
