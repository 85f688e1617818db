#pragma once

#include "scalars.h"

#include <isolux/core/lattice.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace isolux::detail {

/// Indices of grid points, or of cells, from `first` to `last` on each axis.
struct VtkExtent {
  std::array<std::int64_t, 3> first{};
  std::array<std::int64_t, 3> last{};

  [[nodiscard]] std::array<std::int64_t, 3> sizes() const {
    return {last[0] - first[0] + 1, last[1] - first[1] + 1, last[2] - first[2] + 1};
  }
  [[nodiscard]] bool holds(const VtkExtent& part) const;
  [[nodiscard]] bool operator==(const VtkExtent&) const = default;
};

/// The numbers of an attribute's text. \throw InvalidInput naming file and attribute if there are others or more or
/// fewer
void parse_numbers(const std::string& path, std::string_view attribute, std::string_view text,
                   std::span<double> numbers);

/// First and last index on each axis, whole numbers of 32 bits. \throw as parse_numbers
[[nodiscard]] VtkExtent parse_extent(const std::string& path, std::string_view attribute, std::string_view text);

/// The cells between points. Along an axis of one point there is one layer of them, as VTK counts.
[[nodiscard]] VtkExtent cells_of(VtkExtent points);

/// Where voxels lie: points, counted from the origin, or the centres of cells between them. The direction is by rows,
/// the axes of the grid are its columns. \pre the sizes are checked
[[nodiscard]] Lattice lattice_of(const VtkExtent& points, const VtkExtent& voxels, const std::array<double, 3>& origin,
                                 const std::array<double, 3>& spacing, const std::array<double, 9>& direction);

/// \throw IoError naming `path` if pieces have fewer values than the whole
void require_covered(const std::string& path, std::uint64_t in_pieces, std::uint64_t in_whole);

/// Puts pieces into their places of a whole. \pre the sizes of both are checked, and `count` is the whole's
class VtkPieces {
 public:
  VtkPieces(const VtkExtent& whole, std::uint64_t count) : whole_(whole), is_there_(count, false) {}

  /// Where pieces overlap the last one stays. \pre the piece lies in the whole, and all hold values of one type
  void put(const VtkExtent& piece, const DecodedValues& values);
  /// \throw IoError naming `path` if there is no value for a point
  [[nodiscard]] DecodedValues take(const std::string& path);

 private:
  VtkExtent whole_;
  std::vector<bool> is_there_;
  DecodedValues values_;
};

}  // namespace isolux::detail
