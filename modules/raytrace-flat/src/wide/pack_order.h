#pragma once

#include <array>
#include <cstdint>

namespace isolux::wide {

/// For each mask of up to eight lanes the order that brings its lanes to the front and keeps the others behind. Rows of
/// a mask of four lanes begin with an order of four.
using PackOrder = std::array<std::array<std::uint8_t, 8>, 256>;

constexpr PackOrder make_pack_order() {
  PackOrder table{};
  for (unsigned mask = 0; mask < 256; ++mask) {
    unsigned at = 0;
    for (unsigned lane = 0; lane < 8; ++lane)
      if ((mask >> lane & 1u) != 0) table[mask][at++] = std::uint8_t(lane);
    for (unsigned lane = 0; lane < 8; ++lane)
      if ((mask >> lane & 1u) == 0) table[mask][at++] = std::uint8_t(lane);
  }
  return table;
}

inline constexpr PackOrder kPackOrder = make_pack_order();

}  // namespace isolux::wide
