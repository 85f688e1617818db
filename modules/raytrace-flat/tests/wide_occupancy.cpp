// Which cells a bucket's occupancy holds, against their definition.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "physics_support.h"
#include "wide/occupancy.h"
#include "wide_targets.h"

namespace isolux::test {
namespace {

/// The largest of the cell's corners, values signed so that the inner side is the higher one.
float largest_of(const Volume& volume, const Index3& cell, float sign) {
  float most = -std::numeric_limits<float>::infinity();
  for (int q = 0; q < 8; ++q)
    most = std::max(most, sign * volume.values(cell.x + (q & 1), cell.y + (q >> 1 & 1), cell.z + (q >> 2)));
  return most;
}

/// As many thresholds as codes take, one of them the very largest value of a cell: that one reaches it.
std::vector<float> thresholds_of(const Volume& volume, float sign) {
  std::vector<float> thresholds{largest_of(volume, {1, 2, 0}, sign)};
  while (thresholds.size() < wide::CellCodes::kMaxThresholds)
    thresholds.push_back(sign > 0.0f ? 0.55f + 0.03f * float(thresholds.size())
                                     : -0.45f + 0.03f * float(thresholds.size()));
  std::sort(thresholds.begin(), thresholds.end());
  return thresholds;
}

int bit_of(const Index3& cell) { return cell.z % 2 * 16 + cell.y % 4 * 4 + cell.x % 4; }

/// Whether a ray would have to look into the cell.
bool is_held(const wide::OccupancyView& view, const Index3& cell) {
  const std::size_t row = std::size_t(cell.z / 4) * std::size_t(view.bricks.y) + std::size_t(cell.y / 4);
  const std::uint32_t* words = view.words + 2 * (row * std::size_t(view.bricks.x) + std::size_t(cell.x / 4));
  if (words[0] == words[1] && (words[0] & wide::kUpperByte) == wide::kEmptyBrick) return false;
  return (words[cell.z % 4 / 2] >> bit_of(cell) & 1u) != 0;
}

void expect_cells(const Volume& volume, float sign, float threshold, const wide::OccupancyView& view) {
  const Index3 cells = volume.lattice().size - 1;
  for (int k = 0; k < 4 * view.bricks.z; ++k) {
    for (int j = 0; j < 4 * view.bricks.y; ++j) {
      for (int i = 0; i < 4 * view.bricks.x; ++i) {
        const bool exists = i < cells.x && j < cells.y && k < cells.z;
        const bool expected = exists && largest_of(volume, {i, j, k}, sign) >= threshold;
        // One bit may be set in addition, lest a half read as an empty brick.
        if (!expected && bit_of({i, j, k}) == 24) continue;
        ASSERT_EQ(is_held(view, {i, j, k}), expected) << i << " " << j << " " << k << " at " << threshold;
      }
    }
  }
}

void expect_cells_of_all_levels(const Index3& size, OuterSide outer) {
  const Volume volume = noise(size, 5);
  const float sign = outer == OuterSide::kLower ? 1.0f : -1.0f;
  const std::vector<float> thresholds = thresholds_of(volume, sign);
  wide::CellCodes codes({volume.values.values().data(), size, outer});
  codes.build(std::vector<float>{-2.0f}, isolux::Run{});  // codes are made anew, not added to
  codes.build(thresholds, isolux::Run{});
  wide::Occupancy occupancy(codes);
  for (std::size_t level = 0; level < thresholds.size(); ++level) {
    occupancy.build(codes, int(level), isolux::Run{});
    expect_cells(volume, sign, thresholds[level], occupancy.view());
  }
}

class CellCodes : public testing::TestWithParam<std::int64_t> {
 protected:
  CellCodes() { choose_target(GetParam()); }
  ~CellCodes() override { choose_target(0); }
};

TEST_P(CellCodes, SayOfEachCellWhichThresholdsItsLargestValueReaches) {
  for (const OuterSide outer : {OuterSide::kLower, OuterSide::kHigher}) {
    expect_cells_of_all_levels({23, 9, 12}, outer);  // bricks that stick out of the volume
    expect_cells_of_all_levels({70, 6, 17}, outer);
    expect_cells_of_all_levels({33, 5, 4}, outer);  // cells fill vectors
    expect_cells_of_all_levels({3, 4, 2}, outer);   // fewer than a brick
  }
}

INSTANTIATE_TEST_SUITE_P(AllTargets, CellCodes, testing::ValuesIn(wide_targets()), wide_target_name);

}  // namespace
}  // namespace isolux::test
