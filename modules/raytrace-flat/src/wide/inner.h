#pragma once

#include <isolux/core/run.h>

#include <cstdint>
#include <span>
#include <vector>

#include "wide/rays.h"

namespace isolux::wide {

/// For every cube of 2^3 cells, how many of a rising list of ceilings its smallest value exceeds (for the outer side of
/// higher values all signs are turned). One byte a cube, x fastest, rows padded to 32 cubes; cubes that stick out of
/// the volume are left out.
class InnerCodes {
 public:
  /// \pre at most 255 ceilings. Cost: one pass over the volume.
  InnerCodes(const FieldView& field, std::span<const float> ceilings, const Run& run);

  [[nodiscard]] Index3 cubes() const { return cubes_; }
  [[nodiscard]] std::span<const std::uint8_t> codes() const { return codes_; }

 private:
  Index3 cubes_{0};  ///< on x with the padding
  std::vector<std::uint8_t> codes_;
};

/// Where no ray of some isovalues gets without having met its level set.
class InnerCubes {
 public:
  explicit InnerCubes(const InnerCodes& codes);

  /// For isovalues up to the ceiling `index`. Cost: one compare a byte.
  void build(const InnerCodes& codes, int index, const Run& run);
  /// \pre built. Without bits where there are too few such cubes to be worth a look.
  [[nodiscard]] InnerView view() const { return {is_worth_it_ ? bits_.data() : nullptr, cubes_}; }

 private:
  Index3 cubes_{0};
  std::vector<std::uint32_t> bits_;
  bool is_worth_it_ = false;
};

}  // namespace isolux::wide
