#pragma once

#include <isolux/core/vec.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace isolux {

/// The texels of a light that the level sets of a known range of isovalues touch, in bricks: what a graphics card holds
/// as an atlas and a page table. A brick covers kCells^3 cells between texel centres and holds their (kCells + 1)^3
/// texels, so that hardware filters within it; neighbours repeat the texels between them.
struct LightBricks {
  static constexpr int kCells = 4;
  static constexpr int kTexels = kCells + 1;
  static constexpr std::uint32_t kAbsent = 0xFFFFFFFFu;

  Index3 pages{0};                   ///< bricks an axis over the whole light; page p begins at texel p * kCells
  std::vector<std::uint32_t> slots;  ///< of each page, x fastest: its brick's number, or kAbsent
  int channels = 1;
  /// Brick after brick, each channel fastest, then x, y, z; clamped beyond the light's edge.
  std::vector<float> values;
  std::vector<float> slopes;                        ///< the same, or empty
  std::array<std::vector<float>, 3> normal_slopes;  ///< likewise

  [[nodiscard]] std::size_t page_of(const Index3& page) const {
    return (std::size_t(page.z) * std::size_t(pages.y) + std::size_t(page.y)) * std::size_t(pages.x) +
           std::size_t(page.x);
  }
  /// Numbers of one brick's values.
  [[nodiscard]] std::size_t brick_size() const {
    return std::size_t(kTexels) * kTexels * kTexels * std::size_t(channels);
  }
  /// Bricks there are.
  [[nodiscard]] std::size_t count() const { return values.size() / brick_size(); }
  /// Numbers stored, the page table included.
  [[nodiscard]] std::size_t stored() const {
    return slots.size() + values.size() + slopes.size() + 3 * normal_slopes[0].size();
  }
};

}  // namespace isolux
