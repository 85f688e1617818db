#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <type_traits>
#include <variant>

#include "wide_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "wide_classify.cpp"
#include <hwy/foreach_target.h>
// After it, as Highway wants.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace isolux::mc {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;

/// The inside bits of one vector of values.
template <class Vector>
std::uint64_t inside_bits(const Floats d, const Vector value, const Vector isovalue, OuterSide outer) {
  const auto inside = outer == OuterSide::kLower ? hn::Ge(value, isovalue) : hn::Le(value, isovalue);
  alignas(8) std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, inside, bytes);
  if (hn::Lanes(d) <= 8) return bytes[0];
  std::uint64_t bits = 0;
  for (std::size_t b = 0; b < hn::Lanes(d) / 8; ++b) bits |= std::uint64_t(bytes[b]) << (8 * b);
  return bits;
}

/// The inside bits of up to 64 values.
std::uint64_t classify_word(const MarchState& march, const float* values, int count) {
  const Floats d;
  const int lanes = int(hn::Lanes(d));
  const auto isovalue = hn::Set(d, march.isovalue);
  std::uint64_t word = 0;
  int i = 0;
  for (; i + lanes <= count; i += lanes) word |= inside_bits(d, hn::LoadU(d, values + i), isovalue, march.outer) << i;
  for (; i < count; ++i) {
    const bool inside = march.outer == OuterSide::kLower ? values[i] >= march.isovalue : values[i] <= march.isovalue;
    word |= std::uint64_t(inside) << i;
  }
  return word;
}

/// On whole numbers, `value >= isovalue` is `value >= threshold`, and `value <= isovalue` the opposite of another one.
template <class Narrow>
struct Threshold {
  static constexpr int kNone = int(std::numeric_limits<Narrow>::max()) + 1;
  int lowest;  ///< up to kNone
  bool inside_below;

  Threshold(float isovalue, OuterSide outer) : inside_below(outer == OuterSide::kHigher) {
    constexpr float kLeast = std::numeric_limits<Narrow>::min();
    float first = inside_below ? std::floor(isovalue) + 1.0f : std::ceil(isovalue);
    // Nothing is inside of what is no number.
    if (std::isnan(isovalue)) first = inside_below ? kLeast : float(kNone);
    lowest = int(std::clamp(first, kLeast, float(kNone)));
  }
};

/// The inside bits of 64 values.
template <class Narrow>
std::uint64_t classify_whole_word(const Narrow* values, const Threshold<Narrow>& threshold) {
  const hn::CappedTag<Narrow, 64 / sizeof(Narrow)> d;
  std::uint64_t word = 0;
  if (threshold.lowest < Threshold<Narrow>::kNone) {
    const auto lowest = hn::Set(d, Narrow(threshold.lowest));
    for (std::size_t i = 0; i < 64; i += hn::Lanes(d)) {
      const auto value = hn::LoadU(d, values + i);
      std::uint64_t bits = 0;
      hn::StoreMaskBits(d, hn::Eq(hn::Max(value, lowest), value), reinterpret_cast<std::uint8_t*>(&bits));
      word |= bits << i;
    }
  }
  return threshold.inside_below ? ~word : word;
}

/// The inside bits of `count` values or, of more, of 64. The next row's are read with them; the volume's last ones are
/// copied, as there is nothing behind them.
template <class Narrow>
std::uint64_t classify_word(const MarchState& march, const Narrow* values, int count,
                            const Threshold<Narrow>& threshold) {
  if (count >= 64) return classify_whole_word(values, threshold);
  const std::uint64_t own = (std::uint64_t(1) << count) - 1;
  const std::span<const Narrow> all = march.all_values<Narrow>();
  if (all.data() + all.size() - values >= 64) return classify_whole_word(values, threshold) & own;
  Narrow last[64] = {};
  std::copy_n(values, count, last);
  return classify_whole_word(last, threshold) & own;
}

template <class Narrow>
void classify_narrow_row(MarchState& march, int j, int k) {
  const Threshold<Narrow> threshold(march.isovalue, march.outer);
  const Narrow* values = march.row_values<Narrow>(j, k);
  for (int word = 0; word < march.words; ++word)
    march.row_bits(j, k)[word] = classify_word(march, values + 64 * word, march.nx - 64 * word, threshold);
}

void classify_float_row(MarchState& march, int j, int k) {
  const float* values = march.row_values<float>(j, k);
  std::uint64_t* bits = march.row_bits(j, k);
  for (int word = 0; word < march.words; ++word)
    bits[word] = classify_word(march, values + 64 * word, std::min(64, march.nx - 64 * word));
}

void classify_row_wide(MarchState& march, int j, int k) {
  std::visit(
      [&]<class Value>(std::span<const Value> /*values*/) {
        if constexpr (std::is_same_v<Value, float>)
          classify_float_row(march, j, k);
        else
          classify_narrow_row<Value>(march, j, k);
      },
      march.voxels);
}

/// Sets the word's bits in each row: `uniform`, and bits_of(j, k) of the bricks that are read.
void classify_brick_words(MarchState& march, const BrickRows& rows, int word, std::uint64_t uniform,
                          const auto& bits_of) {
  for (int k = rows.first_plane; k < rows.last_plane; ++k)
    for (int j = rows.first_row; j < rows.last_row; ++j) march.row_bits(j, k)[word] = uniform | bits_of(j, k);
}

template <class Narrow>
void classify_narrow_bricks(MarchState& march, const BrickRows& rows, int word, unsigned active,
                            std::uint64_t uniform) {
  const int count = std::min(64, march.nx - 64 * word);
  const Threshold<Narrow> threshold(march.isovalue, march.outer);
  std::uint64_t read = 0;
  for (unsigned left = active; left != 0; left &= left - 1)
    read |= std::uint64_t(0xffff) << (16 * std::countr_zero(left));
  classify_brick_words(march, rows, word, uniform, [&](int j, int k) {
    return classify_word(march, march.row_values<Narrow>(j, k) + 64 * word, count, threshold) & read;
  });
}

void classify_float_bricks(MarchState& march, const BrickRows& rows, int word, unsigned active, std::uint64_t uniform) {
  const int count = std::min(64, march.nx - 64 * word);
  classify_brick_words(march, rows, word, uniform, [&](int j, int k) {
    const float* values = march.row_values<float>(j, k) + 64 * word;
    std::uint64_t bits = 0;
    for (unsigned left = active; left != 0; left &= left - 1) {
      const int first = 16 * std::countr_zero(left);
      bits |= classify_word(march, values + first, std::min(16, count - first)) << first;
    }
    return bits;
  });
}

void classify_bricks_wide(MarchState& march, const BrickRows& rows, int word, unsigned active, std::uint64_t uniform) {
  std::visit(
      [&]<class Value>(std::span<const Value> /*values*/) {
        if constexpr (std::is_same_v<Value, float>)
          classify_float_bricks(march, rows, word, active, uniform);
        else
          classify_narrow_bricks<Value>(march, rows, word, active, uniform);
      },
      march.voxels);
}

void find_float_range(const Lattice& lattice, const float* values, const Index3& first, const Index3& last, float& low,
                      float& high) {
  const Floats d;
  const int lanes = int(hn::Lanes(d));
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  auto lowest = hn::Set(d, kInfinity);
  auto highest = hn::Set(d, -kInfinity);
  auto odd = hn::MaskFromVec(hn::Zero(d));
  low = kInfinity;
  high = -kInfinity;
  const int count = last.x - first.x + 1;
  bool odd_tail = false;
  for (int k = first.z; k <= last.z; ++k) {
    for (int j = first.y; j <= last.y; ++j) {
      const float* row = values + lattice.offset(first.x, j, k);
      int i = 0;
      for (; i + lanes <= count; i += lanes) {
        const auto value = hn::LoadU(d, row + i);
        lowest = hn::Min(lowest, value);
        highest = hn::Max(highest, value);
        odd = hn::Or(odd, hn::Ne(value, value));
      }
      for (; i < count; ++i) {
        low = std::min(low, row[i]);
        high = std::max(high, row[i]);
        odd_tail |= row[i] != row[i];  // NOLINT(misc-redundant-expression): true of NaN alone
      }
    }
  }
  low = std::min(low, hn::GetLane(hn::MinOfLanes(d, lowest)));
  high = std::max(high, hn::GetLane(hn::MaxOfLanes(d, highest)));
  if (odd_tail || !hn::AllFalse(d, odd)) {
    low = -kInfinity;
    high = kInfinity;
  }
}

template <class Narrow>
void find_narrow_range(const Lattice& lattice, const Narrow* values, const Index3& first, const Index3& last,
                       float& low, float& high) {
  const hn::CappedTag<Narrow, 16> d;
  const int lanes = int(hn::Lanes(d));
  auto lowest = hn::Set(d, std::numeric_limits<Narrow>::max());
  auto highest = hn::Set(d, std::numeric_limits<Narrow>::min());
  Narrow least = std::numeric_limits<Narrow>::max();
  Narrow most = std::numeric_limits<Narrow>::min();
  const int count = last.x - first.x + 1;
  for (int k = first.z; k <= last.z; ++k) {
    for (int j = first.y; j <= last.y; ++j) {
      const Narrow* row = values + lattice.offset(first.x, j, k);
      int i = 0;
      for (; i + lanes <= count; i += lanes) {
        const auto value = hn::LoadU(d, row + i);
        lowest = hn::Min(lowest, value);
        highest = hn::Max(highest, value);
      }
      for (; i < count; ++i) {
        least = std::min(least, row[i]);
        most = std::max(most, row[i]);
      }
    }
  }
  HWY_ALIGN Narrow lows[16];
  HWY_ALIGN Narrow highs[16];
  hn::Store(lowest, d, lows);
  hn::Store(highest, d, highs);
  low = float(std::min(least, *std::min_element(lows, lows + lanes)));
  high = float(std::max(most, *std::max_element(highs, highs + lanes)));
}

void find_range_wide(const VolumeView& volume, const Index3& first, const Index3& last, float& low, float& high) {
  std::visit(
      [&]<class Value>(std::span<const Value> values) {
        if constexpr (std::is_same_v<Value, float>)
          find_float_range(volume.lattice(), values.data(), first, last, low, high);
        else
          find_narrow_range(volume.lattice(), values.data(), first, last, low, high);
      },
      volume.voxels());
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace isolux::mc
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isolux::mc {

HWY_EXPORT(classify_row_wide);
HWY_EXPORT(classify_bricks_wide);
HWY_EXPORT(find_range_wide);

void classify_row(MarchState& march, int j, int k) { HWY_DYNAMIC_DISPATCH(classify_row_wide)(march, j, k); }

void classify_bricks(MarchState& march, const BrickRows& rows, int word, unsigned active, std::uint64_t uniform) {
  HWY_DYNAMIC_DISPATCH(classify_bricks_wide)(march, rows, word, active, uniform);
}

void find_range(const VolumeView& volume, const Index3& first, const Index3& last, float& low, float& high) {
  HWY_DYNAMIC_DISPATCH(find_range_wide)(volume, first, last, low, high);
}

}  // namespace isolux::mc
#endif
