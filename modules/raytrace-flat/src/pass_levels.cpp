#include "pass_levels.h"

#include <algorithm>
#include <array>
#include <glm/vector_relational.hpp>
#include <limits>
#include <utility>

namespace isolux {
namespace {

constexpr std::size_t kLevels = 65536;
constexpr std::uint16_t kHighest = kLevels - 1;
/// Of the range: what levels may be off by rounding is far less.
constexpr double kMargin = 1e-9;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Cells by level; the last one put at a level is the first to be taken.
class Buckets {
 public:
  Buckets() : heads_(kLevels, kNone) {}
  void put(std::uint32_t cell, std::uint16_t level) {
    std::uint32_t place = free_;
    if (place == kNone) {
      place = std::uint32_t(entries_.size());
      entries_.emplace_back();
    } else {
      free_ = entries_[place].next;
    }
    entries_[place] = {cell, heads_[level]};
    heads_[level] = place;
  }
  [[nodiscard]] bool has(std::uint16_t level) const { return heads_[level] != kNone; }
  std::uint32_t take(std::uint16_t level) {
    const std::uint32_t place = heads_[level];
    heads_[level] = entries_[place].next;
    entries_[place].next = free_;
    free_ = place;
    return entries_[place].cell;
  }

 private:
  struct Entry {
    std::uint32_t cell = 0;
    std::uint32_t next = kNone;
  };
  std::vector<std::uint32_t> heads_;
  std::vector<Entry> entries_;
  std::uint32_t free_ = kNone;
};

/// The level at which two opposite corners of a square are connected, between them and what else it has: bilinear.
double across(double one, double other, double beside, double beyond) {
  const double highest = std::max(one, other);
  const double lowest = std::min(beside, beyond);
  if (lowest <= highest) return highest;
  const double saddle = (one * other - beside * beyond) / (one + other - beside - beyond);
  return std::max(highest, std::min(saddle, lowest));
}

/// The values at a cell's corners; bits: 1 is x, 2 is y, 4 is z.
using Corners = std::array<double, 8>;

/// The level at which two corners that differ along `a` and `b`, if not along the third axis, too, are connected by
/// slices across that.
double through_slices(const Corners& corners, unsigned from, unsigned to, unsigned a, unsigned b) {
  constexpr int kSlices = 9;
  const unsigned third = 7u & ~(a | b);
  double least = std::numeric_limits<double>::infinity();
  for (int s = 0; s < kSlices; ++s) {
    const double z = double(s) / (kSlices - 1);
    const auto at = [&](unsigned corner) { return (1.0 - z) * corners[corner & ~third] + z * corners[corner | third]; };
    const double level = across(at(from), at(to), at(from ^ a), at(from ^ b));
    least = std::min(least, std::max({level, corners[from], corners[to]}));
  }
  return least;
}

/// The level at which two corners that are not on one edge are connected within the cell.
double within_cell(const Corners& corners, unsigned from, unsigned to) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b] : {std::pair{1u, 2u}, std::pair{1u, 4u}, std::pair{2u, 4u}})
    if (((from ^ to) & a) != 0 && ((from ^ to) & b) != 0)
      least = std::min(least, through_slices(corners, from, to, a, b));
  return least;
}

}  // namespace

class PassLevels::Flood {
 public:
  explicit Flood(PassLevels& to) : to_(to), size_(to.lattice_.size) {}

  void run(const Run& run) {
    for (int k = 0; k < size_.z; ++k)
      for (int j = 0; j < size_.y; ++j) {
        const bool inner_row = k > 0 && k < size_.z - 1 && j > 0 && j < size_.y - 1;
        for (int i = 0; i < size_.x; i += inner_row ? size_.x - 1 : 1) reach(point({i, j, k}), value({i, j, k}));
      }
    std::size_t taken = 0;
    for (std::size_t level = 0; level < kLevels; ++level) {
      while (buckets_.has(std::uint16_t(level))) {
        if (taken++ % 65536 == 0) throw_if_stopped(run);
        const std::uint32_t from = buckets_.take(std::uint16_t(level));
        if (to_.levels_[from] == level) go_on_from(from);
      }
    }
  }

 private:
  [[nodiscard]] std::size_t point(const Index3& at) const { return to_.lattice_.offset(at.x, at.y, at.z); }
  [[nodiscard]] double value(const Index3& at) const {
    return (to_.sign_ * double(to_.values_[point(at)]) - to_.low_) / to_.step_;
  }
  [[nodiscard]] bool holds(const Index3& at) const {
    return glm::all(glm::greaterThanEqual(at, Index3(0))) && glm::all(glm::lessThan(at, size_));
  }
  void reach(std::size_t point, double height) {
    const auto level = std::uint16_t(std::clamp(height, 0.0, double(kHighest)));
    if (level >= to_.levels_[point]) return;
    to_.levels_[point] = level;
    buckets_.put(std::uint32_t(point), level);
  }
  void go_on_from(std::size_t from) {
    const auto nx = std::size_t(size_.x);
    const auto ny = std::size_t(size_.y);
    const Index3 at(int(from % nx), int(from / nx % ny), int(from / (nx * ny)));
    const double height = to_.levels_[from];
    for (int a = 0; a < 3; ++a) {
      for (const int step : {-1, 1}) {
        Index3 next = at;
        next[a] += step;
        if (holds(next)) reach(point(next), std::max(height, value(next)));
      }
    }
    // Each cell that the point is a corner of.
    for (unsigned corner = 0; corner < 8; ++corner)
      go_on_within(at - Index3(corner & 1u, corner >> 1 & 1u, corner >> 2), corner, height);
  }
  void go_on_within(const Index3& cell, unsigned from, double height) {
    if (!holds(cell) || !holds(cell + 1)) return;
    Corners corners;
    bool is_read = false;
    for (const unsigned way : {3u, 5u, 6u, 7u}) {
      const unsigned to = from ^ way;
      const Index3 at = cell + Index3(to & 1u, to >> 1 & 1u, to >> 2);
      const std::size_t there = point(at);
      if (std::max(height, value(at)) >= double(to_.levels_[there])) continue;  // along edges already
      for (unsigned q = 0; q < 8 && !is_read; ++q) corners[q] = value(cell + Index3(q & 1u, q >> 1 & 1u, q >> 2));
      is_read = true;
      reach(there, std::max(height, within_cell(corners, from, to)));
    }
  }

  PassLevels& to_;
  Index3 size_;
  Buckets buckets_;
};

PassLevels::PassLevels(const Volume& volume, OuterSide outer, const Run& run)
    : lattice_(volume.lattice()), values_(volume.values.values()), sign_(outer == OuterSide::kLower ? 1.0 : -1.0) {
  const ValueRange range = value_range(volume);
  low_ = outer == OuterSide::kLower ? double(range.low) : -double(range.high);
  step_ = (double(range.high) - double(range.low)) / double(kHighest);
  if (!(step_ > 0.0)) return;
  levels_.assign(lattice_.count(), kHighest);
  Flood(*this).run(run);
}

bool PassLevels::lets_out(const Index3& cell, double level) const {
  for (unsigned q = 0; q < 8; ++q) {
    const std::size_t point = lattice_.offset(cell.x + int(q & 1u), cell.y + int(q >> 1 & 1u), cell.z + int(q >> 2));
    if ((sign_ * double(values_[point]) - low_) / step_ < level && double(levels_[point]) < level) return true;
  }
  return false;
}

bool PassLevels::is_closed(const Vec3f& index, float isovalue) const {
  if (levels_.empty()) return false;
  // What is not let out below the highest value has the highest level.
  const double level =
      std::min((sign_ * double(isovalue) - low_) / step_ + kMargin * double(kLevels), double(kHighest));
  Index3 first;
  Index3 last;
  for (int a = 0; a < 3; ++a) {
    if (!(index[a] > 0.0f && index[a] < float(lattice_.size[a] - 1))) return false;  // at the box's faces
    last[a] = int(index[a]);
    first[a] = float(last[a]) == index[a] ? last[a] - 1 : last[a];
  }
  for (int k = first.z; k <= last.z; ++k)
    for (int j = first.y; j <= last.y; ++j)
      for (int i = first.x; i <= last.x; ++i)
        if (lets_out({i, j, k}, level)) return false;
  return true;
}

}  // namespace isolux
