// Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "wide/code_cells.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cstring>
#include <glm/common.hpp>
#include <iterator>
#include <span>

#include "wide/occupancy.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::ScalableTag<float>;
using Floats = hn::Vec<FloatTag>;
inline constexpr FloatTag kF{};
constexpr int kPoints = kBrick + 1;  ///< of a brick along an axis
/// Bytes of a brick's codes.
constexpr std::size_t kBytes = 32;

/// Rows of grid points that bricks of one row touch, by z, then y.
using PointRows = const float* [kPoints][kPoints];

/// The larger of each value and the next; of the outer side of higher values, of their negatives.
template <OuterSide kOuter>
HWY_INLINE Floats larger_of_two(const float* row) {
  const Floats here = hn::LoadU(kF, row);
  const Floats next = hn::LoadU(kF, row + 1);
  return kOuter == OuterSide::kLower ? hn::Max(here, next) : hn::Neg(hn::Min(here, next));
}

/// How many of the thresholds each lane reaches, a byte a lane.
HWY_INLINE void rank_lanes(Floats values, std::span<const float> thresholds, std::uint8_t* out) {
  const hn::RebindToSigned<FloatTag> ints;
  const hn::Rebind<std::uint8_t, FloatTag> bytes;
  auto count = hn::Zero(ints);
  for (const float threshold : thresholds)  // a mask's lanes are -1
    count = hn::Sub(count, hn::VecFromMask(ints, hn::RebindMask(ints, hn::Ge(values, hn::Set(kF, threshold)))));
  hn::StoreU(hn::DemoteTo(bytes, count), bytes, out);
}

/// Cells along x that are coded at once: whole bricks.
constexpr std::size_t kAtOnce = std::max<std::size_t>(hn::MaxLanes(kF), kBrick);
/// Ranks of cells, by z, then y; those that are no cells are 0.
using Ranks = std::uint8_t[kBrick][kBrick][kAtOnce];

/// Ranks of a vector of cells from `x` on. \pre that many values and one more can be read of each row
template <OuterSide kOuter>
HWY_INLINE void rank_vector(const PointRows& rows, std::size_t x, const Index3& used, std::span<const float> thresholds,
                            Ranks& ranks) {
  Floats before[kBrick];  // the largest of four values each, a layer of grid points below
  for (int z = 0; z < kPoints; ++z) {
    Floats last = larger_of_two<kOuter>(rows[z][0] + x);
    for (int y = 0; y < kBrick; ++y) {
      const Floats next = larger_of_two<kOuter>(rows[z][y + 1] + x);
      const Floats of_four = hn::Max(last, next);
      if (z > 0 && z <= used.z && y < used.y) rank_lanes(hn::Max(before[y], of_four), thresholds, ranks[z - 1][y] + x);
      before[y] = of_four;
      last = next;
    }
  }
}

/// Codes of up to kAtOnce cells along x in all rows of their bricks. \pre as rank_vector, of all vectors
template <OuterSide kOuter>
HWY_INLINE void code_some(const PointRows& rows, const Index3& used, std::span<const float> thresholds,
                          std::uint8_t* out) {
  HWY_ALIGN Ranks ranks = {};
  const auto cells = std::size_t(used.x);
  for (std::size_t x = 0; x < kAtOnce; x += hn::Lanes(kF)) rank_vector<kOuter>(rows, x, used, thresholds, ranks);
  if (cells < kAtOnce) {
    for (auto& layer : ranks)
      for (auto& row : layer) std::fill(row + cells, std::end(row), std::uint8_t(0));
  }
  for (std::size_t x = 0; x < cells; x += kBrick) {
    for (int z = 0; z < kBrick / 2; ++z) {
      for (int y = 0; y < kBrick; ++y) {
        std::uint32_t lower = 0;
        std::uint32_t upper = 0;
        std::memcpy(&lower, &ranks[z][y][x], kBrick);
        std::memcpy(&upper, &ranks[z + 2][y][x], kBrick);
        lower |= upper << 4;  // ranks are below 16, so nothing is carried
        std::memcpy(out + x / kBrick * kBytes + std::size_t(z * 16 + y * kBrick), &lower, kBrick);
      }
    }
  }
}

template <OuterSide kOuter>
void code_row(const FieldView& field, const Index3& first, std::span<const float> thresholds, std::uint8_t* out) {
  const auto points = std::size_t(field.size.x);
  const Index3 last = field.size - 1;
  Index3 used = glm::min(last - first, Index3(kBrick));
  PointRows rows;
  for (int z = 0; z < kPoints; ++z) {
    for (int y = 0; y < kPoints; ++y) {  // beyond the box anything may be read
      const Index3 at = glm::min(first + Index3(0, y, z), last);
      rows[z][y] = field.values + (std::size_t(at.z) * std::size_t(field.size.y) + std::size_t(at.y)) * points;
    }
  }
  used.x = int(kAtOnce);
  std::size_t x = 0;
  for (; x + kAtOnce < points; x += kAtOnce) {
    // The next row of bricks is asked for: so many rows of points are more than the hardware foresees.
    for (const auto& layer : rows)
      for (int y = 1; y < kPoints; ++y) hwy::Prefetch(layer[y] + kBrick * points);
    code_some<kOuter>(rows, used, thresholds, out + x / kBrick * kBytes);
    for (auto& layer : rows)
      for (const float*& row : layer) row += kAtOnce;
  }
  used.x = int(points - 1 - x);
  if (used.x == 0) return;
  HWY_ALIGN float rest[kPoints][kPoints][2 * kAtOnce] = {};  // a vector may read beyond what is there
  for (int z = 0; z < kPoints; ++z) {
    for (int y = 0; y < kPoints; ++y) {
      std::copy_n(rows[z][y], points - x, rest[z][y]);
      rows[z][y] = rest[z][y];
    }
  }
  code_some<kOuter>(rows, used, thresholds, out + x / kBrick * kBytes);
}

void code_bricks(const FieldView& field, const Index3& first, std::span<const float> thresholds, std::uint8_t* out) {
  const bool is_lower = field.outer == OuterSide::kLower;
  (is_lower ? code_row<OuterSide::kLower> : code_row<OuterSide::kHigher>)(field, first, thresholds, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isolux::wide {

HWY_EXPORT(code_bricks);

void code_brick_row(const FieldView& field, const Index3& first, std::span<const float> thresholds,
                    std::uint8_t* codes) {
  HWY_DYNAMIC_DISPATCH(code_bricks)(field, first, thresholds, codes);
}

}  // namespace isolux::wide
#endif
